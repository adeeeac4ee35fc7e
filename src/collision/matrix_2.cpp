#include "collision/manifold/pairs_2.hpp"

namespace carom::detail {

namespace {

using Routines = PairRoutines<2>;

constexpr Routines ball{collide_ball, separate_outlines};
constexpr Routines polygons{collide_polygons, separate_outlines};
constexpr Routines half_plane{collide_with_plane, separate_from_plane};
constexpr Routines none{nullptr, nullptr};

// Row: kind of a, column: kind of b. What is below the diagonal is found by exchanging the two; the cylinder
// and the cone live in space only.
constexpr Routines matrix[7][7] = {
    // ball  capsule   box       hull      cylinder cone  plane
    {ball, ball, ball, ball, none, none, half_plane},              // ball
    {none, polygons, polygons, polygons, none, none, half_plane},  // capsule
    {none, none, polygons, polygons, none, none, half_plane},      // box
    {none, none, none, polygons, none, none, half_plane},          // hull
    {none, none, none, none, none, none, none},                    // cylinder
    {none, none, none, none, none, none, none},                    // cone
    {none, none, none, none, none, none, none},                    // plane
};

}  // namespace

template <>
const PairRoutines<2>& pair_routines<2>(ShapeKind a, ShapeKind b) {
    return matrix[int(a)][int(b)];
}

}  // namespace carom::detail
