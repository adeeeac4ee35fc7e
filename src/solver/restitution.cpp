#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "solver/solver.hpp"

/// Restitution. Impacts that are not taken together come once, at the end of the step, for the points that
/// were hit.
namespace carom::detail {

template <int D>
ImpactView<D> Solver<D>::impact_view(const SolverInput<D>& input) {
    return {stores_,
            view_,
            &drives_,
            slots_.size(),
            input.step,
            input.step / input.substeps,
            input.restitution_threshold};
}

/// Before the first sub-step: what may bounce?
template <int D>
void Solver<D>::expect_impacts(const SolverInput<D>& input) {
    impacts_.clear();
    stores_.clear();
    some_impacts_ = false;
    if (std::ranges::none_of(used_, [](const Section* s) { return s->contacts.some_bounce(); })) return;
    if (!input.impacts_together) {
        note_impacts();
        find_impacts();
        return;
    }
    for (Section& s : sections_) stores_.push_back(&s.contacts);
    some_impacts_ = impact_solver_.find_candidates(impact_view(input));
}

/// Lists the points that may bounce, in the order of the world's contacts.
template <int D>
void Solver<D>::note_impacts() {
    for (std::uint32_t number = 0; number < sections_.size(); ++number) {
        const ContactStore<D>& store = sections_[number].contacts;
        if (!store.some_bounce()) continue;
        for (std::uint32_t index = 0; index < store.size(); ++index) {
            if (!(store.traits(index / store.width()) & some_bouncy)) continue;
            const float restitution = store.restitution(index);
            if (restitution == 0) continue;
            const Rows model;
            for (std::uint32_t k = 0; k < Rows::capacity; ++k) {
                if (store.rows().at(index, field_of(model, model.points[k].mass)) > 0)
                    impacts_.push_back({store.contact(index), number, index, k, restitution, 0, 0});
            }
        }
    }
    std::ranges::sort(impacts_, [](const Impact& one, const Impact& other) {
        return std::tie(one.contact, one.point) < std::tie(other.contact, other.point);
    });
}

/// Completes `impacts_` by how the points move at the start of the step.
template <int D>
void Solver<D>::find_impacts() {
    for (Impact& i : impacts_) {
        const ContactStore<D>& store = sections_[i.section].contacts;
        const Rows rows = store.rows().get(i.index);
        const std::uint32_t a = store.a(i.index), b = store.b(i.index);
        const Drive<D, float> drive_a = drives_.get(a), drive_b = drives_.get(b);
        const Vec<D, float>& n = rows.normal;
        // Steady constraints count beside the outer forces (a ball that falls on a box at rest), but what
        // they do now may be the echo of a blow: no more than the outer forces could make is believed.
        const float most = std::fabs(dot(n, drive_a.acceleration)) + std::fabs(dot(n, drive_b.acceleration));
        const float steady = dot(n, drive_b.change - drive_a.change) * (1 / h_);
        i.acceleration = std::clamp(steady, -most, most);
        const NormalRow<D, float>& p = rows.points[i.point];
        i.speed = dot(n, relative_velocity(gather<float>(view_, &a).motion, gather<float>(view_, &b).motion,
                                           arm_a(rows, p), arm_b(rows, p)));
    }
}

/// Every point that was hit is given the speed and the place that it has after a bounce at the time of its
/// impact. Points of one body share its motion, so a few passes, to and fro, bring them to agree.
template <int D>
void Solver<D>::bounce(const SolverInput<D>& input) {
    constexpr int passes = 8;
    const Rows model;
    for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t k = 0; k < impacts_.size(); ++k) {
            const Impact& i = impacts_[pass % 2 == 0 ? k : impacts_.size() - 1 - k];
            const LaneStore<Rows>& rows = sections_[i.section].contacts.rows();
            const NormalRow<D, float>& p = model.points[i.point];
            if (rows.at(i.index, field_of(model, p.total_impulse)) == 0) continue;
            const float separation = rows.at(i.index, field_of(model, p.separation));
            const Rebound r = rebound(i.restitution, separation, i.speed, i.acceleration, input.step,
                                      input.restitution_threshold);
            if (r.bounces) bounce(i, r);
        }
    }
}

template <int D>
void Solver<D>::bounce(const Impact& impact, const Rebound& rebound) {
    ContactStore<D>& store = sections_[impact.section].contacts;
    Rows rows = store.rows().get(impact.index);
    NormalRow<D, float>& p = rows.points[impact.point];
    const std::uint32_t slot_a = store.a(impact.index), slot_b = store.b(impact.index);
    Body<D, float> body_a = gather<float>(view_, &slot_a), body_b = gather<float>(view_, &slot_b);
    Motion<D, float>&a = body_a.motion, &b = body_b.motion;
    const Weight<D, float>&wa = body_a.weight, &wb = body_b.weight;

    const Vec<D, float> from_a = arm_a(rows, p), from_b = arm_b(rows, p);
    const float speed = dot(rows.normal, relative_velocity(a, b, from_a, from_b));
    const float blow = std::max(p.mass * (static_cast<float>(rebound.speed) - speed), -p.total_impulse);
    p.total_impulse += blow;
    p.impulse = 0;  // the blow is over: nothing of it belongs into the next step
    push(a, b, wa, wb, from_a, from_b, blow * rows.normal);

    // The place: the same impulse arithmetic on displacements instead of velocities.
    const float lack = static_cast<float>(rebound.gap) - gap(rows, p, a, b);
    if (lack > 0) {
        Motion<D, float> shift_a{}, shift_b{};
        push(shift_a, shift_b, wa, wb, from_a, from_b, p.mass * lack * rows.normal);
        a.moved += shift_a.v;
        a.turned = a.turned + shift_a.w;
        b.moved += shift_b.v;
        b.turned = b.turned + shift_b.w;
    }
    store.rows().set(impact.index, rows);
    for (const auto& [slot, body] : {std::pair{slot_a, body_a}, std::pair{slot_b, body_b}}) {
        if (slot < view_.first_movable) continue;
        scatter_velocity(view_, &slot, body, false);
        scatter_way(view_, &slot, body);
    }
}

#define CAROM_INSTANTIATE(D)                                              \
    template void Solver<D>::expect_impacts(const SolverInput<D>&);       \
    template ImpactView<D> Solver<D>::impact_view(const SolverInput<D>&); \
    template void Solver<D>::bounce(const SolverInput<D>&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
