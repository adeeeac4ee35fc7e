#include "solver/solver.hpp"

#include <algorithm>

#include "math/trig.hpp"
#include "simd/width.hpp"

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

}  // namespace

template <int D>
void Solver<D>::set_lengths(const SolverInput<D>& input) {
    const double h = input.step / input.substeps;
    h_ = static_cast<float>(h);
    const double hertz = std::min(contact_frequency, 0.125 / h);
    sub_ = {1 / h_, contact_push_speed, softness(hertz, contact_damping_ratio, h),
            softness(2 * hertz, contact_damping_ratio, h)};
}

/// `pass(section, blocks, passes)` for the blocks of each section that has some.
template <int D>
template <class Pass>
void Solver<D>::each_section(Pass&& pass) {
    for (Section& section : sections_) {
        if (!section.blocks.empty()) pass(section.blocks.span(), section.blocks.passes());
    }
}

template <int D>
void Solver<D>::run(const SolverInput<D>& input) {
    if (input.active.empty() && input.active_joints.empty()) return;
    set_lengths(input);
    passes_ = &passes_of_width<D>(lane_width());
    gather_bodies(input);
    prepare_joints(input);  // and apply the impulses that they have kept
    deal_contacts(input);   // the same

    sums_begun_ = false;
    passes_->begin_warm(body_span(), h_);
    each_section([&](auto span, auto& passes) { passes.look_ahead(span, view_, h_); });
    passes_->begin(body_span(), h_);
    find_impacts(input);
    step_through(input.substeps);
    bounce(input);
    store(input);
}

template <int D>
void Solver<D>::step_through(int substeps) {
    passes_->integrate_velocities(body_span(), h_);
    for (int i = 0; i < substeps; ++i) {
        joints_.solve(view_);
        each_section([&](auto span, auto& passes) {
            (i == 0 ? passes.solve : passes.solve_and_tally)(span, view_, sub_);
        });
        const bool some_struck = find_struck();
        if (some_struck) settle_struck<true>();
        passes_->integrate_positions(body_span(), h_);
        joints_.relax(view_);
        each_section([&](auto span, auto& passes) { passes.relax(span, view_, sub_); });
        if (some_struck) {
            settle_struck<false>();
            sum_struck();
            note_blows();
        }
        const bool last = i + 1 == substeps;
        (last ? passes_->finish : passes_->finish_and_integrate_velocities)(body_span(), h_);
    }
    each_section([&](auto span, auto& passes) { passes.tally(span); });
    forget_last_blows();
}

template void Solver<2>::run(const SolverInput<2>&);
template void Solver<3>::run(const SolverInput<3>&);

}  // namespace carom::detail
