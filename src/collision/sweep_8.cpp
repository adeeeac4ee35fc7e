#include "collision/sweep_in_lanes.hpp"
#include "simd/lanes.hpp"

namespace carom::detail {

using HWY_NAMESPACE::Lanes;
static_assert(Lanes::count == 8, "this file has to be compiled for the instructions of 8 lanes");

template <int D>
const SweepKernel<D>& sweep_kernel_8() {
    return SweepIn<D, Lanes>::kernel;
}

template const SweepKernel<2>& sweep_kernel_8();
template const SweepKernel<3>& sweep_kernel_8();

}  // namespace carom::detail
