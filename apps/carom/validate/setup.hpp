#pragma once

#include <cmath>
#include <numbers>

#include "subject.hpp"
#include "validate/case.hpp"

/// What the cases share: the step of a game, and motion in the x-y plane of either dimension, where a slope
/// descends along x and bodies roll about the axis out of the plane.
namespace carom::app {

using subject::World;
using subject::World2;
using subject::World3;

constexpr double g = 9.81;          // m/s², the world's default
constexpr double frame = 1.0 / 60;  // s, the step of a game
constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;  // rad

template <int D>
Vec<D> in_plane(double x, double y) {
    Vec<D> v{};
    v.x = x;
    v.y = y;
    return v;
}

/// Spin about the axis out of the x-y plane.
template <int D>
Angular<D> spin(double w) {
    if constexpr (D == 2) {
        return w;
    } else {
        return {0, 0, w};
    }
}
inline double spin_of(double w) { return w; }
inline double spin_of(const Vec3& w) { return w.z; }

/// The rotation by an angle in the x-y plane.
template <int D>
Rotation<D> turned(double angle) {
    if constexpr (D == 2) {
        return Rotation2::from_angle(angle);
    } else {
        return Rotation3::from_axis_angle({0, 0, 1}, angle);
    }
}

/// A fixed plane through the origin that descends along x by `slope` radians.
template <int D>
BodyId<D> add_floor(World<D>& world, const Material& material, double slope = 0) {
    BodyDefinition<D> floor;
    floor.type = BodyType::fixed;
    floor.shapes.push_back({Plane<D>{in_plane<D>(std::sin(slope), std::cos(slope)), 0}});
    floor.shapes.back().material = material;
    return world.add_body(floor);
}

/// Steps a world by `step` until `end` seconds of world time have gone by.
template <int D>
void run_until(World<D>& world, double end, double step = frame) {
    while (world.time() < end - 0.5 * step) world.step(step);
}

}  // namespace carom::app
