#include "simd/width.hpp"

#include <atomic>
#include <cassert>
#include <cstdlib>

namespace carom::detail {

namespace {

std::atomic<int> overridden{0};

int chosen_width() {
    if (const char* wanted = std::getenv("CAROM_LANES")) {
        const int width = std::atoi(wanted);
        if (can_run_lanes(width)) return width;
    }
    for (const int width : {16, 8, 4}) {
        if (can_run_lanes(width)) return width;
    }
    return 1;
}

}  // namespace

bool can_run_lanes(int width) {
#if defined(__x86_64__) || defined(__i386__)
    // What the levels 2, 3 and 4 of x86-64 ask for, as far as the lanes use it.
    switch (width) {
        case 1:
            return true;
        case 4:
            return __builtin_cpu_supports("sse4.2");
#ifdef CAROM_WIDE_LANES
        case 8:
            return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                   __builtin_cpu_supports("bmi2");
        case 16:
            return can_run_lanes(8) && __builtin_cpu_supports("avx512f") &&
                   __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
                   __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#endif
        default:
            return false;
    }
#else
    return width == 1 || width == 4;
#endif
}

int lane_width() {
    static const int width = chosen_width();
    const int forced = overridden.load(std::memory_order_relaxed);
    return forced > 0 ? forced : width;
}

void set_lane_width(int width) {
    assert(width == 0 || can_run_lanes(width));
    overridden.store(width, std::memory_order_relaxed);
}

}  // namespace carom::detail
