#include <algorithm>
#include <cmath>

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

/// Points of the last step and of this one are the same when they belong to the same features; where two
/// features meet the name may change from step to step, and then the nearest point that is left counts, if it
/// is within this share of the smaller body's radius.
constexpr double near_share = 0.1;

/// Gives the points the impulses that they had in the last step. False when none was there before.
template <int D>
bool carry_impulses(const ContactRecord<D>& old, ContactRecord<D>& now, double near) {
    bool taken[Manifold<D>::capacity] = {}, found[Manifold<D>::capacity] = {};
    const auto take = [&](int i, int k) {
        now.points[i].impulse = old.points[k].impulse;
        found[i] = taken[k] = true;
    };
    for (int i = 0; i < now.count; ++i) {
        for (int k = 0; k < old.count && !found[i]; ++k) {
            if (!taken[k] && old.points[k].feature == now.points[i].feature) take(i, k);
        }
    }
    for (int i = 0; i < now.count; ++i) {
        float nearest = static_cast<float>(near * near);
        int best = -1;
        for (int k = 0; k < old.count && !found[i]; ++k) {
            const float d = length_squared(old.points[k].arm_a - now.points[i].arm_a);
            if (taken[k] || d > nearest) continue;
            nearest = d;
            best = k;
        }
        if (best >= 0) take(i, best);
    }
    return std::find(std::begin(found), std::end(found), true) != std::end(found);
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

}  // namespace

/// Contact points of two bodies that are placed so; the gaps are those in these places.
template <int D>
void WorldState<D>::touch(ContactRecord<D>& c, const BodyState<D>& a, const BodyState<D>& b,
                          double reach) const {
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const Manifold<D> m = collide_shapes<D>(shapes[c.shape_a].shape, shapes[c.shape_b].shape,
                                            relative(frame(a, ma), frame(b, mb)), reach);
    c.count = m.count;
    c.normal = narrow<float>(rotate(a.rotation, m.normal));
    c.roundness_a = static_cast<float>(roundness<D>(shapes[c.shape_a].shape, m.normal));
    c.roundness_b = static_cast<float>(
        roundness<D>(shapes[c.shape_b].shape, unrotate(b.rotation, rotate(a.rotation, m.normal))));
    const Vec<D> between = a.position - b.position;
    for (int i = 0; i < m.count; ++i) {
        const Vec<D> arm = rotate(a.rotation, m.points[i].position - ma.center);
        c.points[i] = {narrow<float>(arm),
                       narrow<float>(arm + between),
                       static_cast<float>(m.points[i].separation),
                       0,
                       0,
                       m.points[i].feature};
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
        const auto gap = separate_shapes<D>(shapes[c.shape_a].shape, shapes[c.shape_b].shape,
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
    if (!carry_impulses(old, c, near_share * std::min(ma.radius, mb.radius))) {
        c.friction_impulse = {};
        c.spin_impulse = {};
        c.twist_impulse = 0;
    }
    c.total_friction = {};
}

template <int D>
void WorldState<D>::collide(double dt) {
    for (ContactRecord<D>& c : contacts) {
        if (infos[c.body_a].disabled || infos[c.body_b].disabled) {
            c.count = 0;
        } else if (is_moving(c.body_a) || is_moving(c.body_b)) {
            update_contact(c, dt);
        }
    }
}

template void WorldState<2>::collide(double);
template void WorldState<3>::collide(double);

}  // namespace carom::detail
