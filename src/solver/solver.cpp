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

template <int D>
Solver<D>::Solver() : passes_(&passes_of_width<D>(lane_width())) {
    for (int colour = 0; colour < Colours::count; ++colour) sections_[colour].contacts.set_passes(*passes_);
    sections_[Colours::overflow].contacts.set_passes(passes_of_width<D>(1));
    drives_.set_width(passes_->width);
    view_.first_movable = slots_.first_movable();
}

template <int D>
void Solver<D>::add(std::uint32_t contact, ContactRecord<D>& c, const Carrying<D>* carrying) {
    const BodyPair bodies{slots_.slot(c.body_a), slots_.slot(c.body_b), c.body_a, c.body_b};
    const int colour =
        colours_.take({bodies.slot_a, bodies.slot_b, pair_key(c.body_a, c.body_b)}, view_.first_movable);
    c.place.colour = static_cast<std::uint8_t>(colour);
    c.place.index = sections_[colour].contacts.push(contact, bodies, view_.first_movable);
    ++count_;
    ++touching_[bodies.slot_a];
    ++touching_[bodies.slot_b];
    write(c, carrying);
}

template <int D>
void Solver<D>::write(const ContactRecord<D>& c, const Carrying<D>* carrying) {
    sections_[c.place.colour].contacts.write(c.place.index, c, carrying);
}

template <int D>
void Solver<D>::read(ContactCache<D>& cache, ContactRecord<D>& c) const {
    sections_[c.place.colour].contacts.read(c.place.index, cache, c);
}

template <int D>
bool Solver<D>::is_carried(const ContactRecord<D>& c) const {
    return sections_[c.place.colour].contacts.is_carried(c.place.index);
}

template <int D>
std::uint32_t Solver<D>::remove(ContactRecord<D>& c) {
    ContactStore<D>& store = sections_[c.place.colour].contacts;
    const SlotPair pair{store.a(c.place.index), store.b(c.place.index), 0};
    colours_.give_back(pair, c.place.colour, view_.first_movable);
    --touching_[pair.a];
    --touching_[pair.b];
    --count_;
    const std::uint32_t moved = store.remove(c.place.index, view_.first_movable);
    c.place.colour = ContactPlace::nowhere;
    return moved;
}

template <int D>
void Solver<D>::rename(const ContactRecord<D>& c, std::uint32_t contact) {
    sections_[c.place.colour].contacts.rename(c.place.index, contact);
}

template <int D>
void Solver<D>::mark_jointed(const SolverInput<D>& input) {
    jointed_.assign(slots_.size(), 0);
    const auto mark = [&](const JointRecord<D>& joint) {
        if (joint.body_a != no_body) jointed_[slots_.slot(joint.body_a)] = 1;
        jointed_[slots_.slot(joint.body_b)] = 1;
    };
    for (const std::uint32_t i : input.active_joints) mark(input.joints[i]);
    for (const std::uint32_t i : input.active_couplings) {
        for (const JointRecord<D>& end : input.couplings[i].ends) mark(end);
    }
    jointed_[BodySlots::still] = 0;
}

template <int D>
void Solver<D>::run(const SolverInput<D>& input) {
    if (joints_.expects_others()) mark_jointed(input);
    if (count_ == 0 && input.active_joints.empty() && input.active_couplings.empty()) return;
    set_lengths(input);
    make_room();
    set_free_axes(input);
    joints_.plan(joint_input(input));
    const bool alone = is_small() && joints_.is_small();
    run_crew(input.scheduler, alone, [&](const Crew& crew) { work(input, crew); });
}

/// What each worker does: all of them run through this, and meet where one needs what others did. What is
/// small or has an order the first one does alone.
template <int D>
void Solver<D>::work(const SolverInput<D>& input, const Crew& crew) {
    load_bodies(input, crew);
    joints_.prepare(joint_input(input), crew);  // and apply the impulses that they have kept
    prepare_contacts(crew);                     // the same

    each_body_share(crew, [&](const BodySpan<D>& bodies) { passes_->begin_warm(bodies, h_); });
    each_share(crew, false, [&](const Passes<D>& passes, const BlockSpan<D>& span) {
        passes.look_ahead(span, view_, h_);
    });
    crew.meet();
    each_body_share(crew, [&](const BodySpan<D>& bodies) { passes_->begin(bodies, h_); });
    crew.alone([&] { expect_impacts(input); });
    step_through(input, crew);
    crew.alone([&] {
        if (some_impacts_) impact_solver_.end(impact_view(input));
        bounce(input);
    });
    joints_.store(joint_input(input), crew);
    store_bodies(input, crew);
}

template <int D>
void Solver<D>::step_through(const SolverInput<D>& input, const Crew& crew) {
    each_body_share(crew, [&](const BodySpan<D>& bodies) { passes_->integrate_velocities(bodies, h_); });
    for (int i = 0; i < input.substeps; ++i) {
        if (some_impacts_) crew.alone([&] { impact_solver_.strike(impact_view(input)); });
        joints_.solve(view_, crew);
        each_share(crew, true, [&](const Passes<D>& passes, const BlockSpan<D>& span) {
            (i == 0 ? passes.solve : passes.solve_and_tally)(span, view_, sub_);
        });
        crew.alone([&] {
            find_struck();
            some_joints_struck_ = some_struck_ && pick_struck_joints();
        });
        settle<true>(crew);
        each_body_share(crew, [&](const BodySpan<D>& bodies) { passes_->integrate_positions(bodies, h_); });
        if (some_impacts_) crew.alone([&] { impact_solver_.shift(impact_view(input)); });
        joints_.relax(view_, crew);
        each_share(crew, true, [&](const Passes<D>& passes, const BlockSpan<D>& span) {
            passes.relax(span, view_, sub_);
        });
        if (some_struck_) {
            settle<false>(crew);
            crew.alone([&] { mark_struck_bodies(); });
            find_struck_blocks(crew);
            crew.alone([&] {
                sum_struck();
                note_blows();
            });
        }
        const bool last = i + 1 == input.substeps;
        each_body_share(crew, [&](const BodySpan<D>& bodies) {
            (last ? passes_->finish : passes_->finish_and_integrate_velocities)(bodies, h_);
        });
    }
    each_share(crew, false, [](const Passes<D>& passes, const BlockSpan<D>& span) { passes.tally(span); });
    crew.meet();
    if (crew.is_first()) forget_last_blows();
}

template class Solver<2>;
template class Solver<3>;

}  // namespace carom::detail
