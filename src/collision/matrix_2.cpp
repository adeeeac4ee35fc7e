#include "collision/facet.hpp"
#include "collision/manifold/pairs_2.hpp"

namespace carom::detail {

namespace {

using Routines = PairRoutines<2>;

constexpr Routines outlines{collide_outlines, separate_outlines};
constexpr Routines half_plane{collide_with_plane, separate_from_plane};
constexpr Routines none{nullptr, nullptr};

constexpr Routines ground{collide_terrain<2>, separate_from_terrain<2>};

// Row: kind of a, column: kind of b. What is below the diagonal is found by exchanging the two; the cylinder
// and the cone live in space only.
constexpr Routines matrix[8][8] = {
    // ball    capsule   box       hull      cylinder cone  plane     terrain
    {outlines, outlines, outlines, outlines, none, none, half_plane, ground},  // ball
    {none, outlines, outlines, outlines, none, none, half_plane, ground},      // capsule
    {none, none, outlines, outlines, none, none, half_plane, ground},          // box
    {none, none, none, outlines, none, none, half_plane, ground},              // hull
    {none, none, none, none, none, none, none, none},                          // cylinder
    {none, none, none, none, none, none, none, none},                          // cone
    {none, none, none, none, none, none, none, none},                          // plane
    {none, none, none, none, none, none, none, none},                          // terrain
};

}  // namespace

template <>
const PairRoutines<2>& pair_routines<2>(ShapeKind a, ShapeKind b) {
    return matrix[int(a)][int(b)];
}

}  // namespace carom::detail
