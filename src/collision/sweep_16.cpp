#include "collision/sweep_in_lanes.hpp"
#include "simd/lanes.hpp"

namespace carom::detail {

using HWY_NAMESPACE::Lanes;
static_assert(Lanes::count == 16, "this file has to be compiled for the instructions of 16 lanes");

template <int D>
const SweepKernel<D>& sweep_kernel_16() {
    return SweepIn<D, Lanes>::kernel;
}

template const SweepKernel<2>& sweep_kernel_16();
template const SweepKernel<3>& sweep_kernel_16();

}  // namespace carom::detail
