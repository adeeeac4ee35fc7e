#include <algorithm>
#include <cmath>

#include "collision/manifold.hpp"
#include "world/state.hpp"

namespace carom::detail {

namespace {

/// Shapes nearer than this are given contact points before they touch, so that the solver can let them come
/// together without overlap.
constexpr double speculative_distance = 0.02;

/// How far the surfaces of two bodies may approach in a step, beside what gravity adds.
template <int D>
double approach(const BodyState<D>& a, const BodyMass<D>& ma, const BodyState<D>& b, const BodyMass<D>& mb,
                double dt) {
    const auto turning = [](const BodyState<D>& s, const BodyMass<D>& m) {
        return std::sqrt(angular_dot(s.angular_velocity, s.angular_velocity)) * m.radius;
    };
    return dt * (length(b.velocity - a.velocity) + turning(a, ma) + turning(b, mb));
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

}  // namespace

template <int D>
void WorldState<D>::update_contact(ContactRecord<D>& c, double dt) const {
    const BodyState<D>&sa = states[c.body_a], &sb = states[c.body_b];
    const BodyMass<D>&ma = masses[c.body_a], &mb = masses[c.body_b];
    const double reach =
        speculative_distance + approach(sa, ma, sb, mb, dt) + length(definition.gravity) * dt * dt;
    const Manifold<D> m = collide_shapes<D>(shapes[c.shape_a].shape, shapes[c.shape_b].shape,
                                            relative(frame_of(c.body_a), frame_of(c.body_b)), reach);
    const ContactRecord<D> old = c;
    c.count = m.count;
    c.normal = narrow<float>(rotate(sa.rotation, m.normal));
    const Vec<D> between = sa.position - sb.position;
    for (int i = 0; i < m.count; ++i) {
        const Vec<D> arm = rotate(sa.rotation, m.points[i].position - ma.center);
        c.points[i] = {narrow<float>(arm),
                       narrow<float>(arm + between),
                       static_cast<float>(m.points[i].separation),
                       0,
                       0,
                       m.points[i].feature};
    }
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
