#include "solver/solver.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/flight.hpp"
#include "math/trig.hpp"
#include "solver/bounce.hpp"

namespace carom::detail {

namespace {

constexpr double contact_frequency = 30;      // Hz, and no more than an eighth of the sub-step rate
constexpr double contact_damping_ratio = 10;  // heavily overdamped: overlap is pushed apart without a bounce
constexpr float contact_push_speed = 3;       // m/s

Softness<float> softness(double hertz, double damping_ratio, double h) {
    const double omega = 2 * pi * hertz;
    const double a1 = 2 * damping_ratio + h * omega;
    const double a2 = h * omega * a1;
    const double a3 = 1 / (1 + a2);
    return {static_cast<float>(omega / a1), static_cast<float>(a2 * a3), static_cast<float>(a3)};
}

float inverse_or_zero(float k) { return k > 0 ? 1 / k : 0.0f; }
Symmetric3<float> inverse_or_zero(const Symmetric3<float>& k) {
    return determinant(k) > 0 ? inverse(k) : Symmetric3<float>{};
}

}  // namespace

template <int D>
void Solver<D>::run(const SolverInput<D>& input) {
    if (input.active.empty()) return;
    h_ = static_cast<float>(input.step / input.substeps);
    sub_ = {1 / h_, contact_push_speed};
    const double hertz = std::min(contact_frequency, 0.125 * input.substeps / input.step);
    soft_ = softness(hertz, contact_damping_ratio, input.step / input.substeps);
    soft_fixed_ = softness(2 * hertz, contact_damping_ratio, input.step / input.substeps);

    gather_bodies(input);
    prepare(input);
    begin_warm();
    look_ahead();
    find_impacts(input);
    for (int i = 0; i < input.substeps; ++i) {
        integrate_velocities();
        solve<true>();
        find_struck();
        settle_struck<true>();
        integrate_positions();
        solve<false>();
        settle_struck<false>();
        sum_struck();
        finish_substep();
    }
    bounce(input);
    store(input);
}

template <int D>
std::uint32_t Solver<D>::slot(const SolverInput<D>& input, std::uint32_t body) {
    if (!input.moving[body]) return 0;
    if (slot_of_[body] == 0) {
        slot_of_[body] = static_cast<std::uint32_t>(bodies_.size());
        bodies_.push_back(body);
    }
    return slot_of_[body];
}

template <int D>
void Solver<D>::gather_bodies(const SolverInput<D>& input) {
    slot_of_.assign(input.states.size(), 0);
    bodies_.assign(1, 0);
    pairs_.clear();
    for (const std::uint32_t i : input.active) {
        const ContactRecord<D>& c = input.contacts[i];
        const std::uint32_t a = slot(input, c.body_a);
        pairs_.push_back({a, slot(input, c.body_b)});
    }
    motions_.assign(bodies_.size(), {});
    weights_.assign(bodies_.size(), {});
    drives_.assign(bodies_.size(), {});
    for (std::size_t s = 1; s < bodies_.size(); ++s)
        load_body(input, bodies_[s], motions_[s], weights_[s], drives_[s]);
}

template <int D>
void Solver<D>::load_body(const SolverInput<D>& input, std::uint32_t body, Body& motion,
                          Weight<D, float>& weight, Drive& drive) const {
    const BodyState<D>& state = input.states[body];
    const BodyMass<D>& mass = input.masses[body];
    motion.v = narrow<float>(state.velocity);
    motion.w = narrow<float>(state.angular_velocity);
    drive.lost = narrow<float>(state.velocity - narrow<double>(motion.v));
    drive.lost_spin = narrow<float>(Angular<D>(state.angular_velocity - narrow<double>(motion.w)));
    if (mass.inverse_mass == 0) return;

    Vec<D> one{};
    for (int i = 0; i < D; ++i) one[i] = mass.inverse_mass;
    weight.mass = narrow<float>(free_components<D>(mass.locks, one));
    const Inertia<D> inertia = world_inverse_inertia<D>(mass, state.rotation);
    weight.inertia = narrow<float>(inertia);

    // The gyroscopic term: what the spin would do by itself through the step, spread evenly over it.
    const Angular<D> coasting = coasting_spin<D>(state, mass, input.step) - state.angular_velocity;
    drive.acceleration =
        narrow<float>(free_components<D>(mass.locks, input.loads[body].force * mass.inverse_mass));
    drive.spin_acceleration =
        narrow<float>(Angular<D>(inertia * input.loads[body].torque + coasting * (1 / input.step)));
    drive.damping = static_cast<float>(Decay(mass.linear_damping, h_).factor);
    drive.spin_damping = static_cast<float>(Decay(mass.angular_damping, h_).factor);
}

template <int D>
void Solver<D>::prepare(const SolverInput<D>& input) {
    rows_.resize(input.active.size());
    settled_.assign(rows_.size(), 0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const ContactRecord<D>& record = input.contacts[input.active[i]];
        prepare_contact(record, rows_[i], pairs_[i].a, pairs_[i].b);
        for (const NormalRow<D, float>& p : rows_[i].points) settled_[i] |= p.impulse > 0;
    }
}

template <int D>
void Solver<D>::prepare_contact(const ContactRecord<D>& record, Rows& rows, std::uint32_t a,
                                std::uint32_t b) const {
    const Weight<D, float>&wa = weights_[a], &wb = weights_[b];
    rows = {};
    rows.normal = record.normal;
    rows.tangents = tangents<D>(record.normal);
    rows.friction = record.friction;
    rows.rolling = record.rolling;
    rows.surface_velocity = record.surface_velocity;
    rows.roundness_a = record.roundness_a;
    rows.roundness_b = record.roundness_b;
    const bool one_is_heavy = wa.mass == Vec<D, float>{} || wb.mass == Vec<D, float>{};
    rows.soft = one_is_heavy ? soft_fixed_ : soft_;

    const float share = 1 / static_cast<float>(record.count);
    for (int i = 0; i < record.count; ++i) {
        const ContactRecordPoint<D>& from = record.points[i];
        NormalRow<D, float>& p = rows.points[i];
        p.arm_a = from.arm_a;
        p.arm_b = from.arm_b;
        p.separation = from.separation;
        p.impulse = from.impulse;
        p.mass = inverse_or_zero(compliance(rows.normal, p.arm_a, p.arm_b, wa, wb));
        rows.arm_a += share * p.arm_a;
        rows.arm_b += share * p.arm_b;
    }
    for (int i = 0; i < D - 1; ++i) rows.friction_impulse[i] = dot(record.friction_impulse, rows.tangents[i]);
    rows.rolling_impulse = record.spin_impulse;
    const Inertia<D, float> turning = wa.inertia + wb.inertia;
    if (record.rolling > 0) rows.rolling_mass = inverse_or_zero(turning);

    const float k11 = compliance(rows.tangents[0], rows.arm_a, rows.arm_b, wa, wb);
    if constexpr (D == 2) {
        rows.patch_mass[0] = inverse_or_zero(k11);
    } else {
        const float k22 = compliance(rows.tangents[1], rows.arm_a, rows.arm_b, wa, wb);
        const auto lever = [&](const Vec<3, float>& arm, int t) { return cross(arm, rows.tangents[t]); };
        const float k12 = dot(rows.tangents[0], each(wa.mass + wb.mass, rows.tangents[1])) +
                          dot(lever(rows.arm_a, 0), wa.inertia * lever(rows.arm_a, 1)) +
                          dot(lever(rows.arm_b, 0), wb.inertia * lever(rows.arm_b, 1));
        const float det = k11 * k22 - k12 * k12;
        const float k = inverse_or_zero(det);
        rows.patch_mass = {k22 * k, -k12 * k, k11 * k};
        rows.twist_mass = inverse_or_zero(dot(rows.normal, turning * rows.normal));
        rows.twist_impulse = record.twist_impulse;
        for (int i = 0; i < record.count; ++i)
            rows.points[i].lever = length(rows.points[i].arm_a - rows.arm_a);
    }
}

/// The impulses kept from the step before act as one change of velocity a body. Within the step the Jacobians
/// are constant, so what the constraints did in a sub-step is the difference of velocities, and warm starting
/// the next needs no pass over the constraints.
template <int D>
void Solver<D>::begin_warm() {
    kept_ = motions_;
    for (Body& m : motions_) m = {};
    Body still;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto [a, b] = pairs_[i];
        warm_start(rows_[i], motion(a, still), motion(b, still), weights_[a], weights_[b]);
    }
    for (std::size_t s = 1; s < drives_.size(); ++s) {
        Drive& d = drives_[s];
        d.warm = motions_[s].v;
        d.warm_spin = motions_[s].w;
        d.change = d.warm + h_ * d.acceleration;
        d.spin_change = d.warm_spin + h_ * d.spin_acceleration;
    }
    std::swap(motions_, kept_);
}

/// In a sub-step a gap s changes by h v + ½ h² a, with v the speed at its end and a = −Δv/h (see
/// finish_substep): with v alone, bodies in flight would seem to meet too early. The lead −½ h Δv is what the
/// steady change of the relative speed makes, and no more than what the outer forces alone would: none at
/// rest.
template <int D>
void Solver<D>::look_ahead() {
    constexpr float touching = 1e-5f;  // m: nearer things are not in flight
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Rows& rows = rows_[i];
        const auto open = [](const NormalRow<D, float>& p) { return p.mass == 0 || p.separation > touching; };
        if (!std::all_of(rows.points.begin(), rows.points.end(), open)) continue;
        const Drive &a = drives_[pairs_[i].a], &b = drives_[pairs_[i].b];
        const float outer = -0.5f * h_ * h_ * dot(rows.normal, b.acceleration - a.acceleration);
        const float steady = -0.5f * h_ * dot(rows.normal, b.change - a.change);
        rows.lead = std::max(0.0f, std::min(outer, steady));
    }
}

/// Adds a change that is small beside the velocity. What rounding cuts off is kept for the next time, so that
/// a steady force is not lost bit by bit (Kahan 1965).
template <class V>
V add_precisely(const V& start, const V& change, V& lost) {
    const V whole = change + lost;
    const V sum = start + whole;
    lost = whole - (sum - start);
    return sum;
}

/// The velocity after outer forces and the given change by constraints.
template <int D>
void Solver<D>::push_velocity(Body& m, Drive& d, const Vec<D, float>& by, const Angular<D, float>& spin_by) {
    m.v = add_precisely(d.start * d.damping, h_ * d.acceleration + by, d.lost);
    m.w = add_precisely(d.start_spin * d.spin_damping, Angular<D, float>(h_ * d.spin_acceleration + spin_by),
                        d.lost_spin);
}

template <int D>
void Solver<D>::integrate_velocities() {
    for (std::size_t s = 1; s < drives_.size(); ++s) {
        Drive& d = drives_[s];
        d.start = motions_[s].v;
        d.start_spin = motions_[s].w;
        d.lost_before = d.lost;
        d.lost_spin_before = d.lost_spin;
        push_velocity(motions_[s], d, d.warm, d.warm_spin);
    }
}

/// What stands still is a fresh body for every row, so that not even a non-finite impulse passes through it.
template <int D>
typename Solver<D>::Body& Solver<D>::motion(std::uint32_t slot, Body& still) {
    if (slot != 0) return motions_[slot];
    still = {};
    return still;
}

template <int D>
template <bool biased>
void Solver<D>::solve() {
    Body still;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto [a, b] = pairs_[i];
        Body &ma = motion(a, still), &mb = motion(b, still);
        solve_normals<biased>(rows_[i], ma, mb, weights_[a], weights_[b], sub_);
        if constexpr (!biased) solve_friction(rows_[i], ma, mb, weights_[a], weights_[b]);
    }
}

/// The contacts that carry an impulse for the first time.
template <int D>
void Solver<D>::find_struck() {
    struck_.clear();
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
        if (settled_[i]) continue;
        for (const NormalRow<D, float>& p : rows_[i].points) settled_[i] |= p.impulse > 0;
        if (settled_[i]) struck_.push_back(i);
    }
}

/// A contact that begins has no impulses to start from, and one pass over its rows leaves its points unequal:
/// a box that lands flat would tilt, and one put on a slope would slip before it holds. So the rows of these
/// contacts are solved, friction included, until their points agree.
template <int D>
template <bool biased>
void Solver<D>::settle_struck() {
    constexpr int sweeps = 8;
    Body still;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (const std::uint32_t i : struck_) {
            const auto [a, b] = pairs_[i];
            Body &ma = motion(a, still), &mb = motion(b, still);
            solve_normals<biased>(rows_[i], ma, mb, weights_[a], weights_[b], sub_);
            solve_friction(rows_[i], ma, mb, weights_[a], weights_[b]);
        }
    }
}

/// The many small changes of settling are each rounded to the size of the velocity. So the velocities of
/// these bodies are made anew, in one sum, from the impulses that came out.
template <int D>
void Solver<D>::sum_struck() {
    if (struck_.empty()) return;
    struck_bodies_.assign(motions_.size(), 0);
    for (const std::uint32_t i : struck_) struck_bodies_[pairs_[i].a] = struck_bodies_[pairs_[i].b] = 1;
    struck_bodies_[0] = 0;
    kept_.assign(motions_.size(), {});
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto [a, b] = pairs_[i];
        if (struck_bodies_[a] || struck_bodies_[b])
            warm_start(rows_[i], kept_[a], kept_[b], weights_[a], weights_[b]);
    }
    for (std::size_t s = 1; s < motions_.size(); ++s) {
        if (!struck_bodies_[s]) continue;
        Drive& d = drives_[s];
        d.lost = d.lost_before;
        d.lost_spin = d.lost_spin_before;
        push_velocity(motions_[s], d, kept_[s].v, kept_[s].w);
    }
}

template <int D>
void Solver<D>::integrate_positions() {
    for (std::size_t s = 1; s < motions_.size(); ++s) {
        Body& m = motions_[s];
        m.moved += h_ * m.v;
        m.turned = m.turned + h_ * m.w;
    }
}

/// The steady part of a change of velocity Δ: what this sub-step has in common with the one before. It is Δ
/// itself in free fall, sliding and rolling, and nothing in a blow or at rest.
template <class V, class Dot>
V steady_part(const V& now, const V& before, Dot&& dot) {
    const float squared = dot(now, now);
    if (squared == 0) return now;
    return now * std::clamp(dot(now, before) / squared, 0.0f, 1.0f);
}

/// x += h v(new) is first order. With the steady part Δ of the change of velocity, x += h v − ½ h Δ is the
/// trapezoidal rule: exact under constant acceleration, so flight, sliding and rolling near contacts are
/// second order, while a blow or a push against overlap still acts through the whole sub-step.
template <int D>
void Solver<D>::finish_substep() {
    for (std::size_t s = 1; s < motions_.size(); ++s) {
        Body& m = motions_[s];
        Drive& d = drives_[s];
        const Vec<D, float> change = (m.v - d.start) + (d.lost - d.lost_before);
        const Angular<D, float> spin_change = (m.w - d.start_spin) + (d.lost_spin - d.lost_spin_before);
        d.warm = change - (h_ * d.acceleration + (d.damping - 1) * d.start);
        d.warm_spin = spin_change - (h_ * d.spin_acceleration + (d.spin_damping - 1) * d.start_spin);
        const auto product = [](const auto& a, const auto& b) { return dot(a, b); };
        const auto spin_product = [](const auto& a, const auto& b) { return angular_dot(a, b); };
        m.moved -= 0.5f * h_ * steady_part(change, d.change, product);
        m.turned = m.turned - 0.5f * h_ * steady_part(spin_change, d.spin_change, spin_product);
        d.change = change;
        d.spin_change = spin_change;
    }
    for (Rows& rows : rows_) {
        for (NormalRow<D, float>& p : rows.points) p.total_impulse += p.impulse;
        for (int k = 0; k < D - 1; ++k) rows.total_friction[k] += rows.friction_impulse[k];
    }
}

template <int D>
void Solver<D>::find_impacts(const SolverInput<D>& input) {
    impacts_.clear();
    for (std::uint32_t i = 0; i < rows_.size(); ++i) {
        const ContactRecord<D>& record = input.contacts[input.active[i]];
        if (record.restitution == 0) continue;
        const auto [a, b] = pairs_[i];
        const Vec<D, float>& n = rows_[i].normal;
        // Steady constraints count beside the outer forces (a ball that falls on a box at rest), but what
        // they do now may be the echo of a blow: no more than the outer forces could make is believed.
        const float most =
            std::fabs(dot(n, drives_[a].acceleration)) + std::fabs(dot(n, drives_[b].acceleration));
        const float steady = dot(n, drives_[b].change - drives_[a].change) * (1 / h_);
        const float pull = std::clamp(steady, -most, most);
        for (int k = 0; k < record.count; ++k) {
            const NormalRow<D, float>& p = rows_[i].points[k];
            const float speed = dot(n, relative_velocity(motions_[a], motions_[b], p.arm_a, p.arm_b));
            impacts_.push_back({i, static_cast<std::uint32_t>(k), record.restitution, speed, pull});
        }
    }
}

/// Restitution, once at the end of the step: every point that was hit is given the speed and the place that
/// it has after a bounce at the time of its impact. Points of one body share its motion, so a few passes, to
/// and fro, bring them to agree.
template <int D>
void Solver<D>::bounce(const SolverInput<D>& input) {
    constexpr int passes = 8;
    for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t k = 0; k < impacts_.size(); ++k) {
            const Impact& i = impacts_[pass % 2 == 0 ? k : impacts_.size() - 1 - k];
            const NormalRow<D, float>& p = rows_[i.row].points[i.point];
            if (p.total_impulse == 0) continue;
            const Rebound r = rebound(i.restitution, p.separation, i.speed, i.acceleration, input.step,
                                      input.restitution_threshold);
            if (r.bounces) bounce(i, r);
        }
    }
}

template <int D>
void Solver<D>::bounce(const Impact& impact, const Rebound& rebound) {
    Rows& rows = rows_[impact.row];
    NormalRow<D, float>& p = rows.points[impact.point];
    const auto [a, b] = pairs_[impact.row];
    Body still;
    Body &ma = motion(a, still), &mb = motion(b, still);

    const float speed = dot(rows.normal, relative_velocity(ma, mb, p.arm_a, p.arm_b));
    const float blow = std::max(p.mass * (static_cast<float>(rebound.speed) - speed), -p.total_impulse);
    p.total_impulse += blow;
    p.impulse = 0;  // the blow is over: nothing of it belongs into the next step
    push(ma, mb, weights_[a], weights_[b], p.arm_a, p.arm_b, blow * rows.normal);

    // The place: the same impulse arithmetic on displacements instead of velocities.
    const float lack = static_cast<float>(rebound.gap) - gap(rows, p, ma, mb);
    if (lack <= 0) return;
    const Vec<D, float> shift = p.mass * lack * rows.normal;
    ma.moved -= each(weights_[a].mass, shift);
    ma.turned = ma.turned - weights_[a].inertia * cross(p.arm_a, shift);
    mb.moved += each(weights_[b].mass, shift);
    mb.turned = mb.turned + weights_[b].inertia * cross(p.arm_b, shift);
}

template <int D>
void Solver<D>::store(const SolverInput<D>& input) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Rows& rows = rows_[i];
        ContactRecord<D>& record = input.contacts[input.active[i]];
        for (int k = 0; k < record.count; ++k) {
            record.points[k].impulse = rows.points[k].impulse;
            record.points[k].total_impulse = rows.points[k].total_impulse;
        }
        record.friction_impulse = {};
        record.total_friction = {};
        for (int k = 0; k < D - 1; ++k) {
            record.friction_impulse += rows.friction_impulse[k] * rows.tangents[k];
            record.total_friction += rows.total_friction[k] * rows.tangents[k];
        }
        record.spin_impulse = rows.rolling_impulse;
        record.twist_impulse = rows.twist_impulse;
    }
    for (std::size_t s = 1; s < bodies_.size(); ++s) {
        if (input.types[bodies_[s]] != BodyType::dynamic) continue;
        BodyState<D>& state = input.states[bodies_[s]];
        const Body& m = motions_[s];
        state.position += narrow<double>(m.moved);
        turn<D>(state, narrow<double>(m.turned));
        state.velocity = narrow<double>(m.v) + narrow<double>(drives_[s].lost);
        state.angular_velocity = narrow<double>(m.w) + narrow<double>(drives_[s].lost_spin);
    }
}

template class Solver<2>;
template class Solver<3>;

}  // namespace carom::detail
