#pragma once

#include <cstddef>
#include <cstdint>

#include "core/crew.hpp"
#include "solver/apart.hpp"
#include "solver/body_records.hpp"
#include "solver/body_source.hpp"
#include "solver/contact_rows.hpp"
#include "solver/drive.hpp"
#include "solver/marks.hpp"
#include "solver/prepare.hpp"

namespace carom::detail {

/// What some contact of a block has, so that the passes may leave out what none has.
enum Trait : std::uint8_t {
    some_fixed = 1,
    some_round = 2,
    some_rolling = 4,
    some_bouncy = 8,
    some_belts = 16,
    some_in_flight = 32,  ///< as `prepare` found it
};

/// Blocks of contacts, to be solved in this order. The contacts of a block share no body that can be pushed.
template <int D>
struct BlockSpan {
    float* rows = nullptr;   ///< of `ContactRows<D, F>`
    float* marks = nullptr;  ///< of `ContactMarks<D, F>`; the solving passes do without
    const std::uint32_t* a = nullptr;
    const std::uint32_t* b = nullptr;       ///< records of the bodies, one a lane; see `record_of`
    const std::uint32_t* body_a = nullptr;  ///< their indices in the world
    const std::uint32_t* body_b = nullptr;
    const std::uint32_t* shape_a = nullptr;  ///< in `LaneShapes`
    const std::uint32_t* shape_b = nullptr;
    std::uint8_t* traits = nullptr;
    std::uint32_t* found = nullptr;  ///< a bit a lane, written by the passes that look for something
    std::size_t blocks = 0;
};

/// All bodies with what drives them.
template <int D>
struct BodySpan {
    RecordView<D> view;
    float* drives = nullptr;  ///< of `Drive<D, F>`
    Part blocks;              ///< of them
};

/// Blocks of pairs that do not touch.
struct ApartSpan {
    float* marks = nullptr;  ///< of `ApartMarks<D, F>`
    const std::uint32_t* body_a = nullptr;
    const std::uint32_t* body_b = nullptr;
    const std::uint32_t* shape_a = nullptr;  ///< in `LaneShapes`
    const std::uint32_t* shape_b = nullptr;
    std::uint32_t* found = nullptr;
    std::size_t blocks = 0;
};

/// The inner loops of the solver for one lane width.
template <int D>
struct Passes {
    static constexpr std::size_t most_lanes = 16;
    int width;

    // Over contacts.
    /// Carries the points along with the bodies; makes the manifolds anew for which that does not do, as far
    /// as their shapes are among those `for_lanes`; and finds the contacts that are left.
    void (*refresh)(const BlockSpan<D>&, const PoseView<D>&, const float* for_lanes, float reach);
    /// Finds the pairs that may touch. Where what held them apart does so no more, it looks for another axis
    /// that does, if their shapes are among those `for_lanes`.
    void (*find_near)(const ApartSpan&, const PoseView<D>&, const float* for_lanes,
                      const ApartLimits<float>&);
    /// Effective masses; applies the impulses that are kept; finds the contacts that have none.
    void (*prepare)(const BlockSpan<D>&, const RecordView<D>&);
    void (*warm_start)(const BlockSpan<D>&, const RecordView<D>&);
    /// The records have to hold the change of velocity in place of the velocity and the acceleration by outer
    /// forces in place of the way.
    void (*look_ahead)(const BlockSpan<D>&, const RecordView<D>&, float h);
    /// The passes with bias but without friction find the contacts that push then.
    void (*solve)(const BlockSpan<D>&, const RecordView<D>&, const SubStep<float>&);
    void (*solve_and_tally)(const BlockSpan<D>&, const RecordView<D>&, const SubStep<float>&);
    void (*solve_with_friction)(const BlockSpan<D>&, const RecordView<D>&, const SubStep<float>&);
    void (*relax)(const BlockSpan<D>&, const RecordView<D>&, const SubStep<float>&);
    void (*tally)(const BlockSpan<D>&);
    /// After the step: finds the contacts that have begun or ended to touch.
    void (*touch)(const BlockSpan<D>&);

    // Over bodies.
    /// Fills records and drives from the bodies' states.
    void (*load)(const BodySpan<D>&, const BodySource<D>&);
    /// Brings the states of the bodies that are present to the end of the step, but for those that turned
    /// far: these are no longer present then.
    void (*store)(const BodySpan<D>&, const BodySource<D>&);
    /// Takes the velocities as what the kept impulses make, and leaves what `look_ahead` wants.
    void (*begin_warm)(const BodySpan<D>&, float h);
    /// Puts the velocities of the start back, ready for the first sub-step.
    void (*begin)(const BodySpan<D>&, float h);
    void (*integrate_velocities)(const BodySpan<D>&, float h);
    void (*integrate_positions)(const BodySpan<D>&, float h);
    void (*finish)(const BodySpan<D>&, float h);
    void (*finish_and_integrate_velocities)(const BodySpan<D>&, float h);
};

/// The passes for a lane width that can run here.
template <int D>
const Passes<D>& passes_of_width(int width);
template <>
const Passes<2>& passes_of_width<2>(int width);
template <>
const Passes<3>& passes_of_width<3>(int width);

}  // namespace carom::detail
