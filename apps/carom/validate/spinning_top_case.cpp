#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Tops that precess: hung on a pivot, and standing on a smooth floor.

namespace carom::app {
namespace {

constexpr double mass = 1, along = 0.1, across = 0.06;  // kg, kg·m²
constexpr double arm = 0.5;                             // m, from the tip to the centre of mass
constexpr double tip = 0.05;                            // m, radius of the tip
constexpr double whirl = 30;                            // rad/s about its axis
constexpr double tilt = 30 * degree;

/// A top that keeps its tilt θ precesses at the rate Ω with I₁ Ω² cos θ − I₃ ω₃ Ω + m g l = 0; of the two the
/// slow one. I₁ is taken about what does not move sideways: the pivot, or on a smooth floor the centre of
/// mass.
double precession(double inertia) {
    const double a = inertia * std::cos(tilt), b = along * whirl, c = mass * g * arm;
    return (b - std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

void add_top(std::vector<Result>& results, bool on_pivot, double h) {
    const double rate = precession(on_pivot ? across + mass * arm * arm : across);
    WorldDefinition3 definition;
    definition.sleep = false;
    World3 world(definition);
    Material smooth;
    smooth.friction = 0;
    BodyDefinition3 top;
    // The axis of the top is its y; the tip lies at −arm.
    top.shapes.push_back({Ball{tip}, {0, -arm, 0}});
    top.shapes.back().material = smooth;
    top.mass = mass;
    top.center_of_mass = Vec3{};
    top.inertia = Symmetric3<double>{across, along, across};
    top.rotation = Rotation3::from_axis_angle({0, 0, 1}, -tilt);
    const Vec3 axis = rotate(top.rotation, {0, 1, 0});
    const double height = on_pivot ? 3 : tip;  // of the tip
    top.position = Vec3{0, height, 0} + arm * axis;
    top.angular_velocity = Vec3{0, rate, 0} + (whirl - rate * std::cos(tilt)) * axis;
    if (on_pivot)
        top.velocity = cross(Vec3{0, rate, 0}, arm * axis);
    else
        add_floor(world, smooth);
    const BodyId3 id = world.add_body(top);
    if (on_pivot) {
        JointDefinition3 joint;
        joint.b = id;
        joint.kind = BallJoint<3>{.anchor = {0, height, 0}};
        world.add_joint(joint);
    }
    const auto axis_now = [&] { return rotate(world.rotation(id), {0, 1, 0}); };
    double followed = 0, before = 0, nutation = 0;
    const int steps = static_cast<int>(10 / h + 0.5);
    for (int i = 0; i < steps; ++i) {
        world.step(h);
        const Vec3 a = axis_now();
        const double azimuth = std::atan2(-a.z, a.x);
        followed += std::remainder(azimuth - before, 2 * pi);
        before = azimuth;
        const double off = std::fabs(std::acos(std::clamp(a.y, -1.0, 1.0)) - tilt);
        if (!(off <= nutation)) nutation = off;
    }
    const std::string what =
        fmt::format("3D, {}, h = 1/{:.0f}: ", on_pivot ? "on a pivot" : "on a smooth floor", 1 / h);
    results.push_back(relative(what + "precession (rad/s)", rate, followed / 10, {2e-2, 1e-3}));
    results.push_back(absolute(what + "change of its tilt (rad)", 0, nutation, {5e-2, 1e-3}));
}

}  // namespace

std::vector<Result> spinning_tops() {
    std::vector<Result> results;
    for (const bool on_pivot : {true, false})
        for (const double h : {frame, frame / 4, frame / 16}) add_top(results, on_pivot, h);
    return results;
}

}  // namespace carom::app
