#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "math/dim.hpp"

/// Joints as the solver sees them. A joint is made of a few parts, of which each type has others; which it
/// has is its layout. The types themselves are in src/joints.
namespace carom::detail {

/// What a joint does about the gap between its two anchors.
enum class LinearPart : std::uint8_t {
    none,
    point,  ///< the anchors stay together
    line,   ///< anchor b stays on the line through anchor a along the x axis of frame a
    held,   ///< a spring of limited force draws them together
};

/// What it does about the turn between its two frames.
enum class AngularPart : std::uint8_t {
    none,
    locked,  ///< the frames stay parallel
    across,  ///< 3D: their x axes do
    square,  ///< 3D: the x axis of a and the y axis of b stay at a right angle
    held,    ///< a spring and friction of limited torque work against the turn
};

/// The arithmetic of a coordinate that may be limited, driven and sprung.
enum class DriveKind : std::uint8_t { turn, slide, stretch };

constexpr int most_drives = 6;

struct Layout {
    LinearPart linear = LinearPart::none;
    AngularPart angular = AngularPart::none;
    int drive_count = 0;
    std::array<DriveKind, most_drives> drives{};

    friend constexpr bool operator==(const Layout&, const Layout&) = default;
};

template <class... Kinds>
constexpr Layout layout(LinearPart linear, AngularPart angular, Kinds... drives) {
    return {linear, angular, sizeof...(drives), {drives...}};
}

/// All layouts that a joint may have.
template <int D>
constexpr auto layouts = [] {
    using enum LinearPart;
    using enum DriveKind;
    using A = AngularPart;
    if constexpr (D == 2) {
        return std::array{layout(point, A::none),
                          layout(point, A::none, turn),
                          layout(point, A::locked),
                          layout(point, A::held),
                          layout(held, A::none),
                          layout(held, A::locked),
                          layout(held, A::held),
                          layout(none, A::locked),
                          layout(none, A::held),
                          layout(none, A::none, stretch),
                          layout(line, A::locked, slide),
                          layout(line, A::none, slide, turn),
                          layout(none, A::none, slide, stretch),
                          layout(none, A::none, slide, slide, turn)};
    } else {
        return std::array{layout(point, A::none),
                          layout(point, A::held, turn, turn),
                          layout(point, A::across),
                          layout(point, A::across, turn),
                          layout(point, A::locked),
                          layout(point, A::held),
                          layout(held, A::none),
                          layout(held, A::locked),
                          layout(held, A::held),
                          layout(none, A::across),
                          layout(none, A::held),
                          layout(none, A::none, stretch),
                          layout(line, A::locked, slide),
                          layout(line, A::square, slide, turn, turn),
                          layout(none, A::none, slide, stretch, slide),
                          layout(none, A::none, slide, slide, slide, turn, turn, turn)};
    }
}();

/// The place of a layout in the list.
template <int D>
constexpr int layout_index(const Layout& wanted) {
    for (std::size_t i = 0; i < layouts<D>.size(); ++i) {
        if (layouts<D>[i] == wanted) return static_cast<int>(i);
    }
    return -1;
}

/// What a coordinate means.
enum class Measure : std::uint8_t {
    twist,   ///< turn about the x axes
    swing,   ///< 3D: angle between the x axes
    spin,    ///< 3D: turn about the y axis of b against the x axis of a
    steer,   ///< 3D: turn of the y axis of b about the x axis of a
    turn_x,  ///< 3D: along the x axis of a, of the turn of b against a as a rotation vector
    turn_y,  ///< the same along the y axis
    turn_z,
    along,    ///< way along the x axis of a
    along_y,  ///< the same along the y axis
    along_z,
    stretch,  ///< distance of the anchors
};

constexpr DriveKind kind_of(Measure measure) {
    if (measure == Measure::stretch) return DriveKind::stretch;
    return measure >= Measure::along ? DriveKind::slide : DriveKind::turn;
}

/// A spring as the user gives it; none where the frequency is zero.
struct SpringSettings {
    double frequency = 0, damping_ratio = 0, rest = 0;
    double most = std::numeric_limits<double>::infinity();  ///< force or torque

    // As it acts through sub-steps of one length: a unit of mass is pulled by stiffness · the mean stretch
    // and damping · the mean speed. Worked out anew when the length changes.
    double substep = 0, stiffness = 0, damping = 0;
};

/// A limit that follows the coordinate one way.
enum class Pawl : std::uint8_t { none, holds_below, holds_above };

/// What a coordinate of a joint may be and what drives it.
struct DriveSettings {
    Measure measure = Measure::twist;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    SpringSettings spring;
    double motor_speed = 0, motor_most = 0;  ///< no motor where the most is zero
    Pawl pawl = Pawl::none;
    double pitch = 0;       ///< from tooth to tooth; the pawl holds anywhere where it is zero
    double zero = 0;        ///< what is subtracted from the raw measure
    double coordinate = 0;  ///< as last measured: whole turns are counted from there
};

/// Settings of the parts that are held by springs.
struct HeldSettings {
    SpringSettings linear, angular;
    double friction = 0;  ///< greatest torque
};

/// The force and the torques about the two centres of mass (as impulses) that a joint exerts: on b as they
/// are, on a the opposite.
template <int D, class F>
struct Wrench {
    Vec<D, F> force{};
    Angular<D, F> on_a{}, on_b{};
};

constexpr int most_kept = 24;  ///< floats

/// Where the impulses of a drive are among those that are kept, in a joint of drives alone.
constexpr std::size_t kept_of_drive(int drive) { return 4 * static_cast<std::size_t>(drive); }

template <int D>
class Curve;

/// Of a joint along a path: the path in the frame of a, and where on it the joint is.
template <int D>
struct PathState {
    std::shared_ptr<const Curve<D>> curve;  ///< none for other joints
    double place = 0;
    double rounds = 0;  ///< of a closed path
    Vec<D> normal{};    ///< to the side to which it bends there
};

constexpr std::uint32_t no_body = 0xffffffffu;

/// Layout of a joint that is a coupling: it has no rows of its own.
constexpr std::uint32_t no_layout = 0xffffffffu;

/// A joint between two bodies. Frame and anchor of the world, where there is no body a, are those of the
/// world.
template <int D>
struct JointRecord {
    std::uint32_t body_a = no_body, body_b = no_body;
    std::uint32_t layout = 0;          ///< in `layouts<D>`
    Vec<D> anchor_a{}, anchor_b{};     ///< in the frames of the bodies
    Rotation<D> frame_a{}, frame_b{};  ///< the joint's frame in those of the bodies
    std::vector<DriveSettings> drives;
    HeldSettings held;
    PathState<D> path;
    Wrench<D, float> wrench{};  ///< impulse of the last sub-step, N·s: force, and torques about the centres
    Wrench<D, float> before{};  ///< the same of the sub-step before that
    Wrench<D, float> total{};   ///< impulse of the whole last step
    std::array<float, most_kept> kept{};  ///< impulses of the rows in the last sub-step
};

/// A joint that couples two coordinates, each between two bodies: the sum of factor · coordinate stays what
/// it is, or at most that (a rope).
template <int D>
struct CouplingRecord {
    std::uint32_t joint = 0;             ///< its place among the joints of the world
    std::array<JointRecord<D>, 2> ends;  ///< each with one drive, whose coordinate it is
    std::array<double, 2> factors{};
    double sum = 0;
    bool is_rope = false;
    float kept = 0, before = 0;  ///< impulse of the last sub-step, and of the one before
};

}  // namespace carom::detail
