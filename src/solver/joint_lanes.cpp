#include "solver/joint_passes_in_lanes.hpp"

namespace carom::detail {

template <>
const JointPrograms<2>& joint_programs<2>(int width) {
    switch (width) {
        case 4:
            return joint_programs_4_2();
#ifdef CAROM_WIDE_LANES
        case 8:
            return joint_programs_8_2();
        case 16:
            return joint_programs_16_2();
#endif
        default:
            return JointPassesIn<2, float>::all;
    }
}

template <>
const JointPrograms<3>& joint_programs<3>(int width) {
    switch (width) {
        case 4:
            return joint_programs_4_3();
#ifdef CAROM_WIDE_LANES
        case 8:
            return joint_programs_8_3();
        case 16:
            return joint_programs_16_3();
#endif
        default:
            return JointPassesIn<3, float>::all;
    }
}

}  // namespace carom::detail
