#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <vector>

#include "carom/carom.hpp"

/// What the tests of the world build their scenes from.
namespace carom::test {

constexpr double frame_time = 1.0 / 60;

/// What a typed test suite is written over, to run in the plane and in space.
using BothDimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

/// How often a test of random cases tries: as often as it says, or as the environment variable CAROM_TRIALS
/// asks.
inline int trials(int own) {
    const char* asked = std::getenv("CAROM_TRIALS");
    return asked ? std::atoi(asked) : own;
}

/// A vector of either dimension: z is left out in the plane.
template <int D>
Vec<D> vec(double x, double y, [[maybe_unused]] double z = 0) {
    if constexpr (D == 2)
        return {x, y};
    else
        return {x, y, z};
}

/// A spin about z, the axis that both dimensions have.
template <int D>
Angular<D> spin(double w) {
    if constexpr (D == 2)
        return w;
    else
        return {0, 0, w};
}

/// A turn about z.
template <int D>
Rotation<D> turn_about_z(double angle) {
    if constexpr (D == 2)
        return Rotation2::from_angle(angle);
    else
        return Rotation3::from_axis_angle({0, 0, 1}, angle);
}

template <int D>
double spin_speed(const Angular<D>& w) {
    if constexpr (D == 2)
        return std::fabs(w);
    else
        return length(w);
}

template <int D>
WorldDefinition<D> no_gravity() {
    WorldDefinition<D> definition;
    definition.gravity = {};
    definition.sleep = false;
    return definition;
}

template <int D>
WorldDefinition<D> sleepless() {
    WorldDefinition<D> definition;
    definition.sleep = false;
    return definition;
}

template <int D>
ShapeDefinition<D> shape_of(const Geometry<D>& geometry, const Material& material = {}) {
    ShapeDefinition<D> shape;
    shape.geometry = geometry;
    shape.material = material;
    return shape;
}

template <int D>
BodyDefinition<D> body_of(const Geometry<D>& geometry, const Vec<D>& position = {},
                          const Material& material = {}) {
    BodyDefinition<D> body;
    body.position = position;
    body.shapes = {shape_of<D>(geometry, material)};
    return body;
}

template <int D>
BodyDefinition<D> fixed_of(const Geometry<D>& geometry, const Vec<D>& position = {},
                           const Material& material = {}) {
    BodyDefinition<D> body = body_of<D>(geometry, position, material);
    body.type = BodyType::fixed;
    return body;
}

/// The half-space below y = 0.
template <int D>
BodyDefinition<D> ground(const Material& material = {}) {
    return fixed_of<D>(Plane<D>{vec<D>(0, 1), 0}, {}, material);
}

/// A box with equal sides.
template <int D>
Box<D> cube(double side) {
    return {vec<D>(side, side, side)};
}

/// A dynamic point with mass 1 and, in every direction, moment of inertia 1.
template <int D>
BodyDefinition<D> unit_body(const Vec<D>& position = {}) {
    BodyDefinition<D> body;
    body.position = position;
    body.mass = 1;
    if constexpr (D == 2)
        body.inertia = 1;
    else
        body.inertia = Inertia<3>{1, 1, 1, 0, 0, 0};
    return body;
}

template <int D>
void run(World<D>& world, int steps, double dt = frame_time) {
    for (int i = 0; i < steps; ++i) world.step(dt);
}

/// The deepest overlap of any two bodies' shapes, by the collision functions of the public face; m, and zero
/// where nothing overlaps. Two fixed bodies may overlap.
template <int D>
double deepest_overlap(const World<D>& world) {
    struct Placed {
        Solid<D> solid;
        Transform<D> transform;
        BodyId<D> body;
        bool dynamic;
    };
    std::vector<Placed> all;
    for (const BodyId<D>& body : world.bodies()) {
        for (const ShapeId<D>& shape : world.shapes(body)) {
            all.push_back({Solid<D>(world.shape(shape)), world.transform(body), body,
                           world.type(body) == BodyType::dynamic});
        }
    }
    double deepest = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t k = i + 1; k < all.size(); ++k) {
            const Placed &a = all[i], &b = all[k];
            if (a.body == b.body || !(a.dynamic || b.dynamic)) continue;
            const auto apart = separation(a.solid, a.transform, b.solid, b.transform);
            if (apart) deepest = std::max(deepest, -apart->distance);
        }
    }
    return deepest;
}

/// The largest speed of any part of a dynamic body within `size` of its centre of mass, m/s.
template <int D>
double fastest(const World<D>& world, double size = 0.5) {
    double speed = 0;
    for (const BodyId<D>& body : world.bodies()) {
        if (world.type(body) != BodyType::dynamic) continue;
        speed = std::max(speed,
                         length(world.velocity(body)) + size * spin_speed<D>(world.angular_velocity(body)));
    }
    return speed;
}

}  // namespace carom::test
