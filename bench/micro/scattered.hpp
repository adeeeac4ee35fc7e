#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "carom/carom.hpp"

namespace carom::bench {

/// Seeded random numbers, the same with every standard library.
class Scatter {
  public:
    explicit Scatter(std::uint64_t seed) : engine_(seed) {}

    double between(double low, double high) {
        return low + (high - low) * (double(engine_() >> 11) * 0x1p-53);
    }
    bool coin() { return engine_() >> 63; }
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
            const double square = length_squared(v);
            if (square > 0.01 && square < 1) return normalized(v);
        }
    }
    template <int D>
    Rotation<D> rotation() {
        if constexpr (D == 2)
            return Rotation2::from_angle(between(-3.14, 3.14));
        else
            return Rotation3::from_axis_angle(direction<3>(), between(-3.14, 3.14));
    }

  private:
    std::mt19937_64 engine_;
};

template <int D>
struct Kind {
    std::string name;
    Geometry<D> geometry;
};

/// A shape of each kind, about 1 m large.
template <int D>
std::vector<Kind<D>> kinds_of() {
    Scatter scatter(3);
    Hull<D> hull;
    for (int i = 0; i < (D == 2 ? 8 : 24); ++i) hull.points.push_back(0.5 * scatter.direction<D>());
    Vec<D> size, half{}, up{};
    for (int i = 0; i < D; ++i) size[i] = 1;
    half.x = 0.25;
    up.y = 1;
    std::vector<Kind<D>> kinds{{"ball", Ball{0.5}},
                               {"capsule", Capsule<D>{-half, half, 0.25}},
                               {"box", Box<D>{size}},
                               {"hull", hull},
                               {"plane", Plane<D>{up, 0}}};
    if constexpr (D == 3) {
        kinds.push_back({"cylinder", Cylinder{0.5, 1}});
        kinds.push_back({"cone", Cone{0.5, 1}});
    }
    return kinds;
}

/// Fixed boxes and balls, 0.5 to 1.5 m large, anywhere in a cube of the half length `half`.
template <int D>
World<D> scattered_world(int shapes, double half) {
    Scatter scatter(5);
    World<D> world;
    for (int i = 0; i < shapes; ++i) {
        BodyDefinition<D> body;
        body.type = BodyType::fixed;
        body.position = scatter.in_cube<D>(half);
        body.rotation = scatter.rotation<D>();
        const double size = scatter.between(0.5, 1.5);
        if (scatter.coin()) {
            body.shapes = {{Ball{0.5 * size}}};
        } else {
            Box<D> box{};
            for (int k = 0; k < D; ++k) box.size[k] = size;
            body.shapes = {{box}};
        }
        world.add_body(body);
    }
    return world;
}

}  // namespace carom::bench
