#include "dynamics/contact.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace carom::detail {

template <int D>
ContactRecord<D> exchanged(ContactRecord<D> c) {
    std::swap(c.shape_a, c.shape_b);
    std::swap(c.body_a, c.body_b);
    std::swap(c.roundness_a, c.roundness_b);
    c.normal = -c.normal;
    for (ContactRecordPoint<D>& p : c.points) std::swap(p.arm_a, p.arm_b);
    c.friction_impulse = -c.friction_impulse;
    c.spin_impulse = -c.spin_impulse;
    c.twist_impulse = -c.twist_impulse;
    c.total_friction = -c.total_friction;
    c.surface_velocity = -c.surface_velocity;
    return c;
}

template <int D>
void carry_impulses(const ContactRecord<D>& old, ContactRecord<D>& now, double near, bool on_b) {
    bool taken[Manifold<D>::capacity] = {}, found[Manifold<D>::capacity] = {};
    const auto take = [&](int i, int k) {
        now.points[i].impulse = old.points[k].impulse;
        found[i] = taken[k] = true;
    };
    const auto arm = [&](const ContactRecordPoint<D>& p) { return on_b ? p.arm_b : p.arm_a; };
    for (int i = 0; i < now.count; ++i) {
        for (int k = 0; k < old.count && !found[i]; ++k) {
            if (!taken[k] && old.points[k].feature == now.points[i].feature) take(i, k);
        }
    }
    for (int i = 0; i < now.count; ++i) {
        float nearest = static_cast<float>(near * near);
        int best = -1;
        for (int k = 0; k < old.count && !found[i]; ++k) {
            const float d = length_squared(arm(old.points[k]) - arm(now.points[i]));
            if (taken[k] || d > nearest) continue;
            nearest = d;
            best = k;
        }
        if (best >= 0) take(i, best);
    }
    const bool goes_on = std::find(std::begin(found), std::end(found), true) != std::end(found);
    now.friction_impulse = goes_on ? old.friction_impulse : Vec<D, float>{};
    now.spin_impulse = goes_on ? old.spin_impulse : Angular<D, float>{};
    now.twist_impulse = goes_on ? old.twist_impulse : 0;
}

template ContactRecord<2> exchanged(ContactRecord<2>);
template ContactRecord<3> exchanged(ContactRecord<3>);
template void carry_impulses(const ContactRecord<2>&, ContactRecord<2>&, double, bool);
template void carry_impulses(const ContactRecord<3>&, ContactRecord<3>&, double, bool);

}  // namespace carom::detail
