#include <limits>

#include "collision/facet.hpp"
#include "collision/manifold/patch_3.hpp"

namespace carom::detail {

namespace {

template <NearestRoutine3 nearest>
Manifold<3> collide(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a, double reach) {
    const Pair3 pair{a, b, b_in_a};
    const double limit = reach + core_radius(a) + core_radius(b);
    Nearest3 found = nearest(pair, {limit, true});
    if (found.distance > limit) return {};
    if (const auto patch = contact_patch(pair, found, reach)) return *patch;

    found = made_certain(pair, nearest(pair, {limit, false}));
    return found.distance > limit ? Manifold<3>{} : *contact_patch(pair, found, reach);
}

template <NearestRoutine3 nearest>
std::optional<Separation<3>> separate(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a) {
    const Pair3 pair{a, b, b_in_a};
    Nearest3 found = nearest(pair, {std::numeric_limits<double>::infinity(), false});
    if (found.distance > 0) found = made_certain(pair, found);
    return Separation<3>{found.normal, found.distance - core_radius(a) - core_radius(b)};
}

template <NearestRoutine3 nearest>
constexpr PairRoutines<3> by{collide<nearest>, separate<nearest>};
constexpr PairRoutines<3> ground{collide_terrain<3>, separate_from_terrain<3>};
constexpr PairRoutines<3> none{};  // two of plane and terrain
constexpr PairRoutines<3> flip{};  // looked up with the shapes exchanged

// clang-format off
constexpr PairRoutines<3> matrix[8][8] = {
// a \ b       ball             capsule              box                     hull                       cylinder            cone                plane           terrain
/* ball */     {by<point_point>, by<point_segment>,   by<point_box>,          by<point_polyhedron>,      by<point_revolved>, by<point_revolved>, by<core_plane>, ground},
/* capsule */  {flip,            by<segment_segment>, by<segment_polyhedron>, by<segment_polyhedron>,    by<core_revolved>,  by<core_revolved>,  by<core_plane>, ground},
/* box */      {flip,            flip,                by<box_box>,            by<polyhedron_polyhedron>, by<core_revolved>,  by<core_revolved>,  by<core_plane>, ground},
/* hull */     {flip,            flip,                flip,                   by<polyhedron_polyhedron>, by<core_revolved>,  by<core_revolved>,  by<core_plane>, ground},
/* cylinder */ {flip,            flip,                flip,                   flip,                      by<core_revolved>,  by<core_revolved>,  by<core_plane>, ground},
/* cone */     {flip,            flip,                flip,                   flip,                      flip,               by<core_revolved>,  by<core_plane>, ground},
/* plane */    {flip,            flip,                flip,                   flip,                      flip,               flip,               none,           none},
/* terrain */  {flip,            flip,                flip,                   flip,                      flip,               flip,               flip,           none},
};
// clang-format on

}  // namespace

template <>
const PairRoutines<3>& pair_routines<3>(ShapeKind a, ShapeKind b) {
    return matrix[static_cast<int>(a)][static_cast<int>(b)];
}

}  // namespace carom::detail
