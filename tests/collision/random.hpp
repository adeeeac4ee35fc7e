#pragma once

#include <cstdint>
#include <random>

#include "carom/transform.hpp"

namespace carom::test {

/// Seeded random numbers that are the same with every standard library.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    std::uint64_t bits() { return engine_(); }
    int below(int n) { return int(engine_() % std::uint64_t(n)); }
    /// Uniform in [0, 1).
    double unit() { return double(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }

    /// Uniform in the cube of that half length.
    template <int D>
    Vec<D> in_cube(double half) {
        Vec<D> v;
        for (int i = 0; i < D; ++i) v[i] = between(-half, half);
        return v;
    }
    template <int D>
    Vec<D> direction() {
        for (;;) {
            const Vec<D> v = in_cube<D>(1);
            const double l = length(v);
            if (l > 0.1 && l < 1) return v / l;
        }
    }
    template <int D>
    Rotation<D> rotation() {
        if constexpr (D == 2) {
            const Vec2 v = direction<2>();
            return {v.x, v.y};
        } else {
            for (;;) {
                const Rotation<3> q{between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)};
                const double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
                if (n > 0.1 && n < 1) return normalized(q);
            }
        }
    }
    template <int D>
    Transform<D> placement(double half) {
        const Vec<D> position = in_cube<D>(half);
        return {position, rotation<D>()};
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace carom::test
