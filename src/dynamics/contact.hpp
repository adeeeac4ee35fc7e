#pragma once

#include <array>
#include <cstdint>

#include "carom/collide.hpp"
#include "math/dim.hpp"

namespace carom::detail {

/// One point of a persistent contact. Arms lead from the centres of mass to the point, along the world's
/// axes.
template <int D>
struct ContactRecordPoint {
    Vec<D, float> arm_a{}, arm_b{};
    float separation = 0;  ///< at the start of the step, m
    float impulse = 0;  ///< normal impulse of the last sub-step, N·s: where the next one starts (warm start)
    float total_impulse = 0;  ///< normal impulse of the whole step, N·s
    std::uint32_t feature = 0;
};

/// Where the solver keeps a contact: its colour, and its place among the contacts of that colour.
struct ContactPlace {
    static constexpr std::uint8_t nowhere = 255;
    std::uint8_t colour = nowhere;
    std::uint32_t index = 0;

    explicit operator bool() const { return colour != nowhere; }
};

/// Two shapes whose bounds overlap, from step to step. `count` is zero while they are out of reach. While the
/// solver has the contact, what the solver knows of it is newer than what stands here.
template <int D>
struct ContactRecord {
    std::uint32_t shape_a = 0, shape_b = 0;
    std::uint32_t facet = 0;  ///< of the terrain where one of the shapes is one, `no_part` otherwise
    std::uint32_t body_a = 0, body_b = 0;
    int count = 0;
    float restitution = 0;
    float friction = 0;
    float rolling = 0;  ///< coefficient × radius, m: resisting torque a unit of normal force
    float roundness_a = 0,
          roundness_b = 0;   ///< radius with which each shape rolls here, m; 0 for a corner or a face
    Vec<D, float> normal{};  ///< from a to b
    Vec<D, float> friction_impulse{};  ///< on b in the last sub-step, N·s
    float twist_impulse = 0;           ///< 3D: friction about the normal in the last sub-step, N·m·s
    Vec<D, float>
        surface_velocity{};  ///< how fast b's surface runs along a's beside the motion of the bodies
                             ///< (conveyor belts), m/s; friction works against slip, this included
    Angular<D, float> spin_impulse{};  ///< rolling resistance on b in the last sub-step, N·m·s
    std::array<ContactRecordPoint<D>, Manifold<D>::capacity> points{};
    Vec<D, float> total_friction{};  ///< on b through the whole step, N·s
    bool on_fixed = false;           ///< one of the bodies is fixed
    bool special = false;            ///< one of the shapes is one-way or a conveyor belt
    bool touching = false;           ///< as last reported by an event
    bool passing = false;            ///< through a one-way shape
    bool merged = false;             ///< its points are kept by another contact of the same patch
    float nearest = 0;               ///< if merged: the smallest separation of its own points, m
    ContactPlace place{};
    static constexpr std::uint32_t nowhere = ~std::uint32_t{0};
    std::uint32_t loose = nowhere;  ///< its place in the list of those that are looked at one by one
    std::uint32_t apart = nowhere;  ///< its place among those that are known not to touch
};

/// The contact with a and b exchanged.
template <int D>
ContactRecord<D> exchanged(ContactRecord<D> contact);

/// Points of the last step and of this one are the same when they belong to the same features; where two
/// features meet the name may change from step to step, and then the nearest point that is left counts, if it
/// is within this share of the smaller body's radius.
constexpr double near_share = 0.1;

/// Gives the contact the impulses that it had in the last step, when it was `old`. Points are near each other
/// when their arms on a (`on_b`: on b) differ by less than `near`.
template <int D>
void carry_impulses(const ContactRecord<D>& old, ContactRecord<D>& now, double near, bool on_b);

}  // namespace carom::detail
