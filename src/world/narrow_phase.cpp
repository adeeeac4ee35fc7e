#include <algorithm>
#include <cmath>

#include "collision/facet.hpp"
#include "collision/manifold.hpp"
#include "world/state.hpp"

namespace carom::detail {

namespace {

/// Shapes nearer than this are given contact points before they touch, so that the solver can let them come
/// together without overlap.
constexpr double speculative_distance = 0.02;

/// Speed of the body's outermost point about its centre of mass.
template <int D>
double turning_speed(const BodyState<D>& s, const BodyMass<D>& m) {
    return std::sqrt(angular_dot(s.angular_velocity, s.angular_velocity)) * m.radius;
}

/// Radius of the shape's curvature where it touches along `normal` (in its body's frame): a cylinder or cone
/// is round on its side and flat on its base.
template <int D>
double roundness(const Shape<D>& shape, const Vec<D>& normal) {
    if (shape.kind == ShapeKind::plane) return 0;
    if (shape.kind != ShapeKind::cylinder && shape.kind != ShapeKind::cone) return shape.radius;
    return std::fabs(dot(normal, shape.b)) < 0.5 ? shape.radius : 0;
}

/// Where a body will be after `time` seconds if only gravity acts on it.
template <int D>
BodyState<D> coasted(BodyState<D> s, const BodyMass<D>& m, const Vec<D>& gravity, double time) {
    s.position += time * s.velocity;
    if (m.inverse_mass > 0) s.position += (0.5 * time * time * m.gravity_scale) * gravity;
    turn<D>(s, s.angular_velocity * time);
    return s;
}

/// Manifold and gap of two shapes (see manifold.hpp), of which one may be a terrain: then of its facet.
template <int D>
Manifold<D> manifold_between(const Shape<D>& a, const Shape<D>& b, std::uint32_t facet,
                             const Transform<D>& b_in_a, double reach) {
    if (a.kind == ShapeKind::terrain) return collide_facet<D>(b, a.terrain->facet(facet), b_in_a, reach);
    if (b.kind != ShapeKind::terrain) return collide_shapes<D>(a, b, b_in_a, reach);
    const Manifold<D> seen = collide_facet<D>(a, b.terrain->facet(facet), inverse(b_in_a), reach);
    return moved(exchanged(seen), b_in_a);
}
template <int D>
std::optional<Separation<D>> gap_between(const Shape<D>& a, const Shape<D>& b, std::uint32_t facet,
                                         const Transform<D>& b_in_a) {
    if (a.kind == ShapeKind::terrain) return separate_facet<D>(b, a.terrain->facet(facet), b_in_a);
    if (b.kind != ShapeKind::terrain) return separate_shapes<D>(a, b, b_in_a);
    auto gap = separate_facet<D>(a, b.terrain->facet(facet), inverse(b_in_a));
    if (gap) gap->axis = -rotate(b_in_a.rotation, gap->axis);
    return gap;
}

}  // namespace

/// Contact points of two bodies that are placed so; the gaps are those in these places.
template <int D>
void WorldState<D>::touch(ContactRecord<D>& c, const BodyState<D>& a, const BodyState<D>& b,
                          double reach) const {
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const Shape<D>&shape_a = shapes[c.shape_a].shape, &shape_b = shapes[c.shape_b].shape;
    const Transform<D> b_in_a = relative(frame(a, ma), frame(b, mb));
    Manifold<D> m = manifold_between<D>(shape_a, shape_b, c.facet, b_in_a, reach);
    const bool on_fixed = types[c.body_a] == BodyType::fixed || types[c.body_b] == BodyType::fixed;
    if (on_fixed && m.count > 1) lay_on_fixed_face(m, c, b_in_a);
    c.normal = narrow<float>(rotate(a.rotation, m.normal));
    c.roundness_a = static_cast<float>(roundness<D>(shape_a, m.normal));
    c.roundness_b =
        static_cast<float>(roundness<D>(shape_b, unrotate(b.rotation, rotate(a.rotation, m.normal))));
    const Vec<D> between = a.position - b.position;
    c.count = 0;
    for (int i = 0; i < m.count; ++i) {
        const Vec<D> arm = rotate(a.rotation, m.points[i].position - ma.center);
        ContactRecordPoint<D>& p = c.points[c.count];
        p = {narrow<float>(arm),
             narrow<float>(arm + between),
             static_cast<float>(m.points[i].separation),
             0,
             0,
             m.points[i].feature};
        if (!on_fixed || !is_artefact_of_seam(c, a, b, p)) ++c.count;
    }
}

/// Bodies that are apart and may meet within the step are moved on to where they first come near
/// (conservative advancement, Mirtich 1996): the gap divided by a bound on its rate of closing is a time in
/// which they cannot meet. The points found there are given the gaps that they have now, so the solver stops
/// the bodies at the right place, along the right normal, however fast they are; and bodies that pass one
/// another do not touch.
template <int D>
void WorldState<D>::meet_ahead(ContactRecord<D>& c, double dt) const {
    const BodyState<D>&sa = states[c.body_a], &sb = states[c.body_b];
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const double turning = turning_speed(sa, ma) + turning_speed(sb, mb) + length(definition.gravity) * dt;
    const Vec<D> speed = sb.velocity - sa.velocity;
    constexpr double near = 0.5 * speculative_distance;
    constexpr int most_advances = 32;
    double elapsed = 0;
    BodyState<D> a = sa, b = sb;
    for (int i = 0; i < most_advances; ++i) {
        a = coasted(sa, ma, definition.gravity, elapsed);
        b = coasted(sb, mb, definition.gravity, elapsed);
        const auto gap = gap_between<D>(shapes[c.shape_a].shape, shapes[c.shape_b].shape, c.facet,
                                        relative(frame(a, ma), frame(b, mb)));
        if (!gap) return;
        const bool last = i + 1 == most_advances;
        if (gap->distance <= near || last) {
            touch(c, a, b, speculative_distance);
            break;
        }
        const double closing = turning - dot(rotate(a.rotation, gap->axis), speed);
        if (closing <= 0) return;
        elapsed += (gap->distance - 0.5 * near) / closing;
        if (elapsed > dt) return;
    }
    for (int i = 0; i < c.count; ++i) {
        ContactRecordPoint<D>& p = c.points[i];
        const Vec<D> arm_a = narrow<double>(p.arm_a), arm_b = narrow<double>(p.arm_b);
        const Vec<D> turned =
            elapsed * (cross(sb.angular_velocity, arm_b) - cross(sa.angular_velocity, arm_a));
        const Vec<D> way = (b.position - sb.position) - (a.position - sa.position) + turned;
        p.separation -= static_cast<float>(dot(narrow<double>(c.normal), way));
    }
}

template <int D>
void WorldState<D>::update_contact(ContactRecord<D>& c, double dt) const {
    const BodyState<D>&sa = states[c.body_a], &sb = states[c.body_b];
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const double way = dt * (length(sb.velocity - sa.velocity) + turning_speed(sa, ma) +
                             turning_speed(sb, mb) + length(definition.gravity) * dt);
    const ContactRecord<D> old = c;
    touch(c, sa, sb, definition.continuous ? speculative_distance : speculative_distance + way);
    if (c.count == 0 && definition.continuous && way > 0.5 * speculative_distance) meet_ahead(c, dt);
    pass_one_way(c, old.count > 0 || old.passing);
    drag_along(c);
    carry_impulses(old, c, near_share * std::min(ma.radius, mb.radius), ma.inverse_mass == 0);
    c.total_friction = {};
    c.merged = false;
}

template <int D>
void WorldState<D>::collide(double dt) {
    list_fixed_contacts();
    for (ContactRecord<D>& c : contacts) {
        if (infos[c.body_a].disabled || infos[c.body_b].disabled) {
            c.count = 0;
        } else if (is_moving(c.body_a) || is_moving(c.body_b)) {
            update_contact(c, dt);
        }
    }
    merge_patches();
}

template void WorldState<2>::collide(double);
template void WorldState<3>::collide(double);

}  // namespace carom::detail
