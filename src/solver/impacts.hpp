#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/contact_store.hpp"
#include "solver/drive.hpp"
#include "solver/reflect.hpp"

namespace carom::detail {

/// What the impacts of a step see of the solver.
template <int D>
struct ImpactView {
    std::span<ContactStore<D>* const> stores;
    RecordView<D> bodies;
    LaneStore<Drive<D, float>>* drives = nullptr;
    std::uint32_t slots = 0;  ///< one more than the last
    double step = 0, substep = 0;
    double threshold = 0;  ///< m/s: slower impacts do not bounce
};

/// Impacts with restitution, each at its own time within a sub-step, and those that come together at once.
///
/// Before a sub-step is solved, its bodies are on their way: each flies with a constant acceleration a by
/// outer forces and by what constraints did in the sub-step before. The gap at a point is a quadratic
/// function of time, so the time τ of its impact is known. At the first of these times all points that have
/// closed and at which bodies approach each other are reflected together, then again those at which bodies
/// approach each other now, and so on until nobody does (see `Reflection`). What touches at rest is left out
/// until something comes on to it, so that a blow runs through a row of balls in the right order, and what is
/// symmetric stays so, as all of it is reflected at once. Then the next time is looked for: chains of
/// impacts, and several bounces of one body, fit into a sub-step.
///
/// A blow that changes a velocity by Δv at τ makes the path x(t) = x₀ + v₀ t + ½ a t² go on as
///
///     x(t) = (x₀ − Δv τ) + (v₀ + Δv) t + ½ a t²     for t ≥ τ.
///
/// So it is a change of the velocity and of the place at the start of the sub-step, exact for flight, and the
/// solver, which knows nothing of it, goes on from there. The places are changed when it has integrated them,
/// since those paths lead through the obstacle before τ. For the sub-step the points of these bodies are
/// given the gaps with which the solver sees what their paths will do (`bend_gaps`).
///
/// All this is done in double precision by one worker, in the order of the contacts' numbers. Time is
/// bounded: when a blow has cost too much, approach that is slow beside it is left to the solver, which takes
/// it away without a bounce.
template <int D>
class ImpactSolver {
  public:
    /// Before the first sub-step: may anything bounce in this step?
    bool find_candidates(const ImpactView<D>& view);
    /// Before a sub-step is solved, with velocities integrated.
    void strike(const ImpactView<D>& view);
    /// When its positions have been integrated.
    void shift(const ImpactView<D>& view);
    /// After the last sub-step.
    void end(const ImpactView<D>& view) { straighten(view); }

  private:
    using Rows = ContactRows<D, double>;
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Candidate {
        std::uint32_t number, section, index;
    };
    /// A body of a contact that is looked at.
    struct Flight {
        std::uint32_t slot = 0;
        bool listed = false;        ///< are all its contacts looked at?
        bool struck = false;        ///< in this sub-step
        Motion<D, double> start{};  ///< at the start of the sub-step, with the blows since
        Vec<D> acceleration{};
        Angular<D> spin_acceleration{};
        Motion<D, double> blow{};  ///< what the blows changed of it
    };
    struct Contact {
        std::uint32_t section = 0, index = 0;
        std::uint32_t a = 0, b = 0;  ///< indices of flights
        double restitution = 0;
        Rows rows;
    };
    /// One point of a contact, and when it will be struck.
    struct Point {
        std::uint32_t contact = 0, number = 0;
        double time = 0, speed = 0;
        bool struck = false;  ///< in this sub-step
        bool comes = false;   ///< it will be struck soon after the sub-step
    };
    /// The separation of a point as it stood in its row, and what it is while velocities are relaxed.
    struct Bent {
        std::uint32_t point;
        float separation, relaxed;
    };

    void reset(const ImpactView<D>& view);
    std::uint32_t flight_of(std::uint32_t slot, const ImpactView<D>& view);
    void load(Flight& flight, const ImpactView<D>& view);
    void add_contact(const Candidate& candidate, const ImpactView<D>& view);
    void list_contacts_of(std::uint32_t flight, const ImpactView<D>& view);
    void link_contacts(const ImpactView<D>& view);
    Motion<D, double> at(const Flight& flight, double time) const;
    double gap_at(const Point& point, double time) const;
    double speed_at(const Point& point, double time) const;
    void find_impact(Point& point, double from, const ImpactView<D>& view) const;
    bool strike_first(const ImpactView<D>& view);
    void expect(std::uint32_t point, double from, const ImpactView<D>& view);
    std::uint32_t take_first();
    std::size_t most_work() const { return 20'000 + 30 * points_.size(); }
    void involve(std::uint32_t flight, double time, const ImpactView<D>& view);
    void run_rounds(double time, double speed, const ImpactView<D>& view);
    void apply(double time);
    void bend_gaps(const ImpactView<D>& view);
    void straighten(const ImpactView<D>& view);
    float& separation_of(const Point& point, const ImpactView<D>& view) const;
    void tally(const ImpactPoint<D>& struck, const Point& point, const ImpactView<D>& view) const;

    std::vector<Candidate> candidates_;
    std::vector<Flight> flights_;
    std::vector<Contact> contacts_;
    std::vector<Point> points_;
    std::vector<std::vector<std::uint32_t>> points_of_;  ///< by flight
    std::vector<Bent> bent_;
    std::vector<std::pair<double, std::uint32_t>>
        queue_;             ///< a heap of times and points; some are of the past
    std::size_t work_ = 0;  ///< in this sub-step
    std::vector<std::uint32_t> flight_of_slot_;
    std::vector<std::uint32_t> links_begin_;        ///< by slot, and one more: its contacts in `links_`
    std::vector<Candidate> links_;                  ///< by slot
    std::vector<std::vector<std::uint8_t>> taken_;  ///< by section and index: is the contact looked at?

    // Of one impact.
    std::vector<ImpactBody<D>> bodies_;   ///< by flight
    std::vector<std::uint8_t> involved_;  ///< by flight
    std::vector<std::uint32_t> involved_flights_;
    std::vector<std::uint32_t> touching_;    ///< points that have closed, of these
    std::vector<std::uint8_t> is_touching_;  ///< by point
    std::vector<std::uint32_t> first_;       ///< points that began it
    std::vector<std::uint32_t> chosen_;      ///< points that are reflected
    std::vector<ImpactPoint<D>> strikes_;    ///< the same
    Reflection<D> reflection_;
};

}  // namespace carom::detail
