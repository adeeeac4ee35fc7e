#include "solver/lanes.hpp"

#include "solver/passes_in_lanes.hpp"

namespace carom::detail {

const Passes<2>& passes_1_2() { return PassesIn<2, float>::all; }
const Passes<3>& passes_1_3() { return PassesIn<3, float>::all; }

template <>
const Passes<2>& passes_of_width<2>(int width) {
    switch (width) {
        case 4:
            return passes_4_2();
#ifdef CAROM_WIDE_LANES
        case 8:
            return passes_8_2();
        case 16:
            return passes_16_2();
#endif
        default:
            return passes_1_2();
    }
}

template <>
const Passes<3>& passes_of_width<3>(int width) {
    switch (width) {
        case 4:
            return passes_4_3();
#ifdef CAROM_WIDE_LANES
        case 8:
            return passes_8_3();
        case 16:
            return passes_16_3();
#endif
        default:
            return passes_1_3();
    }
}

}  // namespace carom::detail
