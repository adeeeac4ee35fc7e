#include "simd/lanes.hpp"
#include "solver/lanes.hpp"
#include "solver/passes_in_lanes.hpp"

namespace carom::detail {

using HWY_NAMESPACE::Lanes;
static_assert(Lanes::count == 4, "this file has to be compiled for the instructions of 4 lanes");

const Passes<2>& passes_4_2() { return PassesIn<2, Lanes>::all; }
const Passes<3>& passes_4_3() { return PassesIn<3, Lanes>::all; }

}  // namespace carom::detail
