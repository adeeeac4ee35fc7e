#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "dynamics/joint.hpp"
#include "solver/body_records.hpp"
#include "solver/joint_rows.hpp"

namespace carom::detail {

/// Blocks of joints of one layout, which share no body that can be pushed.
struct JointSpan {
    float* rows = nullptr;  ///< of `JointRows<D, F, L>`
    const std::uint32_t* a = nullptr;
    const std::uint32_t* b = nullptr;          ///< slots of the bodies, one a lane
    const std::uint8_t* some_fixed = nullptr;  ///< by block: has it a body that cannot be pushed?
    std::size_t blocks = 0;
};

/// Where joints are to be found that have nothing but two anchors.
template <int D>
struct JointSites {
    static constexpr std::size_t anchor_stride = 2 * D;

    const double* states = nullptr;  ///< of all bodies
    const std::uint32_t* body_a = nullptr;
    const std::uint32_t* body_b = nullptr;  ///< one a lane: indices in the world
    const double* anchors = nullptr;  ///< both of a joint: from the centres of mass, in the bodies' axes
};

/// The passes over joints of one layout.
template <int D>
struct JointProgram {
    /// Brings the rows to where the bodies are at the start of a step. Nothing for layouts of which that asks
    /// for more than places.
    void (*place)(const JointSpan&, const JointSites<D>&);
    /// Applies the kept impulses, as they are in the rows.
    void (*start)(const JointSpan&, const RecordView<D>&);
    void (*solve)(const JointSpan&, const RecordView<D>&, const JointStep<float>&);
    void (*relax)(const JointSpan&, const RecordView<D>&, const JointStep<float>&);
};

/// The passes over all layouts for one lane width.
template <int D>
struct JointPrograms {
    int width;
    std::array<JointProgram<D>, layouts<D>.size()> of_layout;
};

/// The passes for a lane width that can run here.
template <int D>
const JointPrograms<D>& joint_programs(int width);
template <>
const JointPrograms<2>& joint_programs<2>(int width);
template <>
const JointPrograms<3>& joint_programs<3>(int width);

const JointPrograms<2>& joint_programs_4_2();
const JointPrograms<3>& joint_programs_4_3();
const JointPrograms<2>& joint_programs_8_2();
const JointPrograms<3>& joint_programs_8_3();
const JointPrograms<2>& joint_programs_16_2();
const JointPrograms<3>& joint_programs_16_3();

}  // namespace carom::detail
