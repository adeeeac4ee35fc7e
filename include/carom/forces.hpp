#pragma once

#include <limits>
#include <optional>
#include <type_traits>
#include <variant>

#include "carom/ids.hpp"
#include "carom/inertia.hpp"
#include "carom/vec.hpp"

namespace carom {

/// A constant force on a body, at a point of it.
template <int D>
struct ConstantForce {
    BodyId<D> body{};
    Vec<D> value{};                 ///< N
    std::optional<Vec<D>> point{};  ///< in the body's frame, m; the centre of mass when left out
    bool local = false;             ///< `value` turns with the body
};

/// A constant torque on a body.
template <int D>
struct ConstantTorque {
    BodyId<D> body{};
    Angular<D> value{};  ///< N·m, along the axes of the world
};

/// One blow at the time `at`: the step that begins at or first after it.
template <int D>
struct TimedImpulse {
    BodyId<D> body{};
    Vec<D> value{};                 ///< N·s
    std::optional<Vec<D>> point{};  ///< in the body's frame, m; the centre of mass when left out
    double at = 0;                  ///< s, not negative
};

/// Resistance of the medium: F = −(linear + quadratic · |v|) v.
template <int D>
struct Drag {
    std::optional<BodyId<D>> body{};  ///< every dynamic body when left out
    double linear = 0;                ///< N·s/m, not negative
    double quadratic = 0;             ///< N·s²/m², not negative
};

/// Air that moves: F = ½ · density · A · |u| u with u = velocity − v and A the cross-section of a ball
/// (3D: disk, 2D: diameter) of the same measure as the body's shapes; drag coefficient 1.
template <int D>
struct Wind {
    Vec<D> velocity{};     ///< m/s
    double density = 1.2;  ///< kg/m³ (kg/m² in the plane), not negative
};

/// Attraction to a point by Newton's law: a = −gm (x − center) / |x − center|³, on every dynamic body.
template <int D>
struct PointGravity {
    Vec<D> center{};  ///< m
    double gm = 1;    ///< m³/s²
};

/// A spring with a damper between two bodies, or a body and the world (`a` left out).
template <int D>
struct Spring {
    std::optional<BodyId<D>> a{};
    BodyId<D> b{};
    Vec<D> anchor_a{};               ///< in the frame of `a`, or in the world, m
    Vec<D> anchor_b{};               ///< in the frame of `b`, m
    double stiffness = 0;            ///< N/m, not negative
    double damping = 0;              ///< N·s/m along the line between the anchors, not negative
    std::optional<double> length{};  ///< rest length, m; the distance at the start when left out
};

/// Water, or another fluid at rest or in steady flow, in the half-space up · x ≤ surface. On every dynamic
/// body acts the weight of what its shapes displace, in the middle of that: density · V · g, with V the
/// volume below the surface (where shapes of a body overlap it counts twice, as mass does) and g the
/// component of the world's gravity against `up`. Drag acts in the middle of the wetted part, against the
/// velocity u that it has in the water: F = −K u, K = linear_drag · density · V + ½ · quadratic_drag ·
/// density · A · s, with A the wetted share of the cross-section of a ball of the same measure as the body's
/// shapes, and s the mean speed of the body in the water, turning included; turning is slowed at the same
/// rate, by the torque −K (I/m) ω. Drag never does more within a step than stop. Bodies that float may fall
/// asleep.
template <int D>
struct Buoyancy {
    Vec<D> up = [] {
        Vec<D> y{};
        y.y = 1;
        return y;
    }();                        ///< out of the water; any length but zero
    double surface = 0;         ///< m, along the unit vector of `up`
    double density = 1000;      ///< kg/m³ (kg/m² in the plane), not negative
    double linear_drag = 0;     ///< 1/s, not negative: at which what has the density of the water slows down
    double quadratic_drag = 0;  ///< a drag coefficient, not negative; about 0.5 for a ball, 1 for a cube
    Vec<D> flow{};              ///< velocity of the water, m/s
};

/// One generator of forces, and when it acts.
template <int D>
struct ForceDefinition {
    std::variant<ConstantForce<D>, ConstantTorque<D>, TimedImpulse<D>, Drag<D>, Wind<D>, PointGravity<D>,
                 Spring<D>, Buoyancy<D>>
        kind{};
    double from = 0;                                      ///< s of world time
    double to = std::numeric_limits<double>::infinity();  ///< s of world time
};

using ForceDefinition2 = ForceDefinition<2>;
using ForceDefinition3 = ForceDefinition<3>;

}  // namespace carom
