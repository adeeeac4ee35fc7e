#include "simd/lanes.hpp"
#include "solver/joint_passes_in_lanes.hpp"

namespace carom::detail {

using HWY_NAMESPACE::Lanes;
static_assert(Lanes::count == 8, "this file has to be compiled for the instructions of 8 lanes");

const JointPrograms<2>& joint_programs_8_2() { return JointPassesIn<2, Lanes>::all; }
const JointPrograms<3>& joint_programs_8_3() { return JointPassesIn<3, Lanes>::all; }

}  // namespace carom::detail
