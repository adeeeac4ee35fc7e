#include <limits>

#include "collision/facet.hpp"
#include "collision/manifold/patch_3.hpp"

namespace carom::detail {

namespace {

template <NearestRoutine3 nearest>
Manifold<3> collide(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a, double reach,
                    const Vec3& axis) {
    const Pair3 pair{a, b, b_in_a};
    const double radii = core_radius(a) + core_radius(b), limit = reach + radii;
    Nearest3 found = nearest(pair, {limit, true, axis});
    if (found.distance > limit) return apart_along(found.normal, found.distance - radii);
    if (const auto patch = contact_patch(pair, found, reach)) return *patch;

    found = made_certain(pair, nearest(pair, {limit, false, axis}));
    if (found.distance > limit) return apart_along(found.normal, found.distance - radii);
    return *contact_patch(pair, found, reach);
}

/// The same where it takes longer to find the axis than to try one, which two polyhedra do first themselves.
template <NearestRoutine3 nearest>
Manifold<3> collide_unless_apart(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a,
                                 double reach, const Vec3& axis) {
    const double gap = gap_along(a, b, b_in_a, axis);
    if (gap > reach) return apart_along(axis, gap);
    return collide<nearest>(a, b, b_in_a, reach, axis);
}

template <NearestRoutine3 nearest>
std::optional<Separation<3>> separate(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a) {
    const Pair3 pair{a, b, b_in_a};
    Nearest3 found = nearest(pair, {std::numeric_limits<double>::infinity(), false, {}});
    if (found.distance > 0) found = made_certain(pair, found);
    return Separation<3>{found.normal, found.distance - core_radius(a) - core_radius(b)};
}

/// The same for two polyhedra: closest points take less time than all pairs of edges. Between those that all
/// but touch rounding blurs the direction.
template <NearestRoutine3 nearest>
std::optional<Separation<3>> separate_polyhedra(const Shape<3>& a, const Shape<3>& b,
                                                const Transform<3>& b_in_a) {
    const CoreDistance<3> closest = core_distance<3>(a, b, b_in_a);
    if (closest.overlap || closest.distance < 1e-4 * (core_extent(a) + core_extent(b)))
        return separate<nearest>(a, b, b_in_a);
    return Separation<3>{closest.axis, closest.distance - core_radius(a) - core_radius(b)};
}

template <NearestRoutine3 nearest>
constexpr PairRoutines<3> by{collide<nearest>, separate<nearest>};
template <NearestRoutine3 nearest>
constexpr PairRoutines<3> slow{collide_unless_apart<nearest>, separate<nearest>};
constexpr PairRoutines<3> polyhedra{collide<polyhedron_polyhedron>,
                                    separate_polyhedra<polyhedron_polyhedron>};
constexpr PairRoutines<3> boxes{collide_unless_apart<box_box>, separate_polyhedra<box_box>};
constexpr PairRoutines<3> ground{collide_terrain<3>, separate_from_terrain<3>};
constexpr PairRoutines<3> none{};  // two of plane and terrain
constexpr PairRoutines<3> flip{};  // looked up with the shapes exchanged

// clang-format off
constexpr PairRoutines<3> matrix[8][8] = {
// a \ b       ball             capsule              box                       hull                              cylinder              cone                  plane           terrain
/* ball */     {by<point_point>, by<point_segment>,   by<point_box>,            by<point_polyhedron>,             by<point_revolved>,   by<point_revolved>,   by<core_plane>, ground},
/* capsule */  {flip,            by<segment_segment>, slow<segment_polyhedron>, slow<segment_polyhedron>,         slow<core_revolved>,  slow<core_revolved>,  by<core_plane>, ground},
/* box */      {flip,            flip,                boxes,                    polyhedra,                        slow<core_revolved>,  slow<core_revolved>,  by<core_plane>, ground},
/* hull */     {flip,            flip,                flip,                     polyhedra,                        slow<core_revolved>,  slow<core_revolved>,  by<core_plane>, ground},
/* cylinder */ {flip,            flip,                flip,                     flip,                             slow<core_revolved>,  slow<core_revolved>,  by<core_plane>, ground},
/* cone */     {flip,            flip,                flip,                     flip,                             flip,                 slow<core_revolved>,  by<core_plane>, ground},
/* plane */    {flip,            flip,                flip,                     flip,                             flip,                 flip,                 none,           none},
/* terrain */  {flip,            flip,                flip,                     flip,                             flip,                 flip,                 flip,           none},
};
// clang-format on

}  // namespace

template <>
const PairRoutines<3>& pair_routines<3>(ShapeKind a, ShapeKind b) {
    return matrix[static_cast<int>(a)][static_cast<int>(b)];
}

}  // namespace carom::detail
