#include "solver/reflect.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace carom::detail {

namespace {

/// More points than this are solved by sweeps.
constexpr std::size_t most_at_once = 64;

template <int D>
bool is_movable(const ImpactBody<D>& body) {
    double most = 0;
    for (int i = 0; i < D; ++i) most = std::max(most, body.weight.mass[i]);
    return most > 0;
}

/// What a unit impulse at the point changes the velocities of its two bodies by.
template <int D>
struct Kick {
    Vec<D> v_a, v_b;
    Angular<D> w_a, w_b;

    Kick(std::span<const ImpactBody<D>> bodies, const ImpactPoint<D>& p)
        : v_a(-each(bodies[p.a].weight.mass, p.normal)),
          v_b(each(bodies[p.b].weight.mass, p.normal)),
          w_a(-(bodies[p.a].weight.inertia * cross(p.arm_a, p.normal))),
          w_b(bodies[p.b].weight.inertia * cross(p.arm_b, p.normal)) {}

    /// What that makes of the speed of separation at another point.
    double at(const ImpactPoint<D>& from, const ImpactPoint<D>& p) const {
        double speed = 0;
        if (p.b == from.b) speed += dot(p.normal, v_b + cross(w_b, p.arm_b));
        if (p.b == from.a) speed += dot(p.normal, v_a + cross(w_a, p.arm_b));
        if (p.a == from.a) speed -= dot(p.normal, v_a + cross(w_a, p.arm_a));
        if (p.a == from.b) speed -= dot(p.normal, v_b + cross(w_b, p.arm_a));
        return speed;
    }
};

template <int D>
Vec<D> speed_between(std::span<const ImpactBody<D>> bodies, const ImpactPoint<D>& p) {
    return relative_velocity(bodies[p.a].motion, bodies[p.b].motion, p.arm_a, p.arm_b);
}

template <int D>
void give(std::span<ImpactBody<D>> bodies, const ImpactPoint<D>& p, const Vec<D>& impulse) {
    ImpactBody<D>&a = bodies[p.a], &b = bodies[p.b];
    push(a.motion, b.motion, a.weight, b.weight, p.arm_a, p.arm_b, impulse);
}

}  // namespace

template <int D>
void Reflection<D>::find_groups(std::span<const ImpactBody<D>> bodies,
                                std::span<const ImpactPoint<D>> points) {
    if (leader_.size() < bodies.size()) leader_.resize(bodies.size());
    for (const ImpactPoint<D>& p : points) leader_[p.a] = p.a, leader_[p.b] = p.b;
    const auto find = [&](std::uint32_t body) {
        while (leader_[body] != body) body = leader_[body] = leader_[leader_[body]];
        return body;
    };
    for (const ImpactPoint<D>& p : points) {
        if (!is_movable(bodies[p.a]) || !is_movable(bodies[p.b])) continue;
        const std::uint32_t a = find(p.a), b = find(p.b);
        leader_[std::max(a, b)] = std::min(a, b);
    }
    const auto group = [&](std::uint32_t point) {
        const ImpactPoint<D>& p = points[point];
        return find(is_movable(bodies[p.a]) ? p.a : p.b);
    };
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::ranges::sort(order_, {}, [&](std::uint32_t point) { return std::pair(group(point), point); });
}

template <int D>
void Reflection<D>::reflect(std::span<ImpactBody<D>> bodies, std::span<ImpactPoint<D>> points) {
    find_groups(bodies, points);
    const auto leader = [&](std::uint32_t point) {
        std::uint32_t body = is_movable(bodies[points[point].a]) ? points[point].a : points[point].b;
        while (leader_[body] != body) body = leader_[body];
        return body;
    };
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
        const std::uint32_t first = leader(order_[begin]);
        while (end < order_.size() && leader(order_[end]) == first) ++end;
        const auto group = std::span(order_).subspan(begin, end - begin);
        solve_normals(bodies, points, group);
        solve_friction(bodies, points, group);
    }
}

/// Many points: sweeps over them, to and fro. What these leave is a small part, and no energy: λ is made
/// longer or shorter until λ · Jv* = 0.
template <int D>
void Reflection<D>::sweep_normals(std::span<ImpactBody<D>> bodies, std::span<const ImpactPoint<D>> points,
                                  std::span<const std::uint32_t> group) {
    constexpr int sweeps = 16;
    const std::size_t n = group.size();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = sweep % 2 == 0 ? k : n - 1 - k;
            const ImpactPoint<D>& p = points[group[i]];
            const ImpactBody<D>&a = bodies[p.a], &b = bodies[p.b];
            const double weight = compliance(p.normal, p.arm_a, p.arm_b, a.weight, b.weight);
            if (weight == 0) continue;
            const double speed = dot(p.normal, speed_between<D>(bodies, p));
            const double next = std::max(0.0, push_[i] - speed / weight);
            give(bodies, p, (next - push_[i]) * p.normal);
            push_[i] = next;
        }
    }
}

template <int D>
void Reflection<D>::solve_normals(std::span<ImpactBody<D>> bodies, std::span<ImpactPoint<D>> points,
                                  std::span<const std::uint32_t> group) {
    const std::size_t n = group.size();
    speed_.resize(n);
    push_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i)
        speed_[i] = dot(points[group[i]].normal, speed_between<D>(bodies, points[group[i]]));
    if (n <= most_at_once) {
        matrix_.assign(n * n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            const Kick<D> kick(bodies, points[group[i]]);
            for (std::size_t j = 0; j < n; ++j)
                matrix_[i * n + j] = kick.at(points[group[i]], points[group[j]]);
        }
        solve_complementarity(matrix_, speed_, push_);
        for (std::size_t i = 0; i < n; ++i)
            give(bodies, points[group[i]], push_[i] * points[group[i]].normal);
    } else {
        sweep_normals(bodies, points, group);
    }

    // Now the bodies have v*. With Aλ = J (v* − v): λᵀb, λᵀAλ, and (eλ)ᵀA(eλ) from what eλ does beside.
    double taken = 0, squared = 0;
    for (std::size_t i = 0; i < n; ++i) {
        taken -= push_[i] * speed_[i];
        squared +=
            push_[i] * (dot(points[group[i]].normal, speed_between<D>(bodies, points[group[i]])) - speed_[i]);
    }
    if (!(squared > 0)) return;
    const double scale = taken / squared;
    for (std::size_t i = 0; i < n; ++i) {
        const ImpactPoint<D>& p = points[group[i]];
        give(bodies, p, push_[i] * (scale - 1) * p.normal);
        push_[i] *= scale;
        speed_[i] = dot(p.normal, speed_between<D>(bodies, p));
    }
    squared *= scale * scale;
    double returned = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const ImpactPoint<D>& p = points[group[i]];
        give(bodies, p, p.restitution * push_[i] * p.normal);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const ImpactPoint<D>& p = points[group[i]];
        returned += p.restitution * push_[i] * (dot(p.normal, speed_between<D>(bodies, p)) - speed_[i]);
    }
    const double share = returned > squared ? std::sqrt(squared / returned) : 1;
    for (std::size_t i = 0; i < n; ++i) {
        ImpactPoint<D>& p = points[group[i]];
        if (share < 1) give(bodies, p, (share - 1) * p.restitution * push_[i] * p.normal);
        p.impulse = (1 + share * p.restitution) * push_[i];
    }
}

/// The stiffest that slip is at a point: the largest change of slip that a unit impulse along a tangent
/// makes.
template <int D>
double stiffness(std::span<const ImpactBody<D>> bodies, const ImpactPoint<D>& p) {
    const ImpactBody<D>&a = bodies[p.a], &b = bodies[p.b];
    double sum = 0;
    for (const Vec<D>& t : p.tangents) sum += compliance(t, p.arm_a, p.arm_b, a.weight, b.weight);
    if constexpr (D == 3) {  // the larger eigenvalue of the 2×2 system
        const auto [t1, t2] = p.tangents;
        Motion<3, double> ma{}, mb{};
        push(ma, mb, a.weight, b.weight, p.arm_a, p.arm_b, t1);
        const Vec<3> made = relative_velocity(ma, mb, p.arm_a, p.arm_b);
        const double k11 = dot(t1, made), k12 = dot(t2, made), k22 = sum - k11;
        sum = 0.5 * (sum + std::sqrt((k11 - k22) * (k11 - k22) + 4 * k12 * k12));
    }
    return sum;
}

/// Each point in turn goes against the slip that is left, as far as its bound lets it, until nothing changes.
/// A step is no longer than the stiffest direction allows, so that none makes energy.
template <int D>
void Reflection<D>::solve_friction(std::span<ImpactBody<D>> bodies, std::span<ImpactPoint<D>> points,
                                   std::span<const std::uint32_t> group) {
    constexpr double precision = 1e-10;
    const int sweeps = group.size() <= most_at_once ? 100 : 8;
    push_.clear();
    for (const std::uint32_t i : group) {
        points[i].tangential = {};
        const bool rough = points[i].friction * points[i].impulse > 0;
        push_.push_back(rough ? stiffness<D>(bodies, points[i]) : 0);
    }
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double change = 0, largest = 0;
        for (std::size_t k = 0; k < group.size(); ++k) {
            ImpactPoint<D>& p = points[group[k]];
            if (!(push_[k] > 0)) continue;
            const double limit = p.friction * p.impulse;
            const Vec<D> slip = speed_between<D>(bodies, p);
            std::array<double, D - 1> next;
            double squared = 0;
            for (int j = 0; j < D - 1; ++j) {
                next[j] = p.tangential[j] - (dot(p.tangents[j], slip) + p.surface_speed[j]) / push_[k];
                squared += next[j] * next[j];
            }
            const double cut = squared > limit * limit ? limit / std::sqrt(squared) : 1;
            Vec<D> impulse{};
            for (int j = 0; j < D - 1; ++j) {
                next[j] *= cut;
                impulse += (next[j] - p.tangential[j]) * p.tangents[j];
            }
            p.tangential = next;
            give(bodies, p, impulse);
            change = std::max(change, dot(impulse, impulse));
            largest = std::max(largest, limit * limit);
        }
        if (!(change > precision * precision * largest)) break;
    }
}

template class Reflection<2>;
template class Reflection<3>;

}  // namespace carom::detail
