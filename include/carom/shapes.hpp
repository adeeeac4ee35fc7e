#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "carom/transform.hpp"

namespace carom {

/// What a shape is made of.
struct Material {
    double density = 1000;   ///< kg/m³ (kg/m² in the plane), not negative
    double friction = 0.6;   ///< Coulomb's coefficient, not negative; a pair uses the geometric mean
    double restitution = 0;  ///< share of the approach speed that comes back, 0 … 1; a pair uses the larger
    double rolling_resistance =
        0;  ///< coefficient c: the resisting torque is at most c · radius · normal force

    friend bool operator==(const Material&, const Material&) = default;
};

/// A disk in the plane, a solid sphere in space, about the origin of the shape's frame.
struct Ball {
    double radius = 0.5;  ///< m, positive

    friend bool operator==(const Ball&, const Ball&) = default;
};

/// A rectangle or a cuboid, centred on the origin of the shape's frame.
template <int D>
struct Box {
    Vec<D> size{};        ///< full lengths, m, positive, the rounding included
    double rounding = 0;  ///< radius of the rounded edges, m, 0 … half of the smallest length

    friend bool operator==(const Box&, const Box&) = default;
};

/// All points within `radius` of the segment from `from` to `to`.
template <int D>
struct Capsule {
    Vec<D> from{};        ///< m
    Vec<D> to{};          ///< m
    double radius = 0.5;  ///< m, positive

    friend bool operator==(const Capsule&, const Capsule&) = default;
};

/// The convex hull of `points` (at least D + 1 that span an area or a volume, at most 4096 in 3D), grown by
/// `rounding`. A triangle is a hull of three points.
template <int D>
struct Hull {
    std::vector<Vec<D>> points{};  ///< m, in any order
    double rounding = 0;           ///< m, not negative

    friend bool operator==(const Hull&, const Hull&) = default;
};

/// The half-space n · x ≤ offset. Only fixed bodies carry it; it has no mass.
template <int D>
struct Plane {
    Vec<D> normal{};    ///< out of the solid; any length but zero
    double offset = 0;  ///< m, along the unit normal

    friend bool operator==(const Plane&, const Plane&) = default;
};

/// A solid cylinder about the y axis of the shape's frame, centred on its origin.
struct Cylinder {
    double radius = 0.5;  ///< m, positive
    double height = 1;    ///< m, positive

    friend bool operator==(const Cylinder&, const Cylinder&) = default;
};

/// A solid cone about the y axis of the shape's frame; the base lies at y = −height/2, the tip at +height/2.
struct Cone {
    double radius = 0.5;  ///< m, positive
    double height = 1;    ///< m, positive

    friend bool operator==(const Cone&, const Cone&) = default;
};

/// A line of segments through `points`, the ground of the plane. What lies to the right of the direction of
/// travel is solid: along +x the solid is below, and a loop round a solid runs clockwise, one round a hollow
/// counter-clockwise. A chain stops shapes whose centre is in front of it; from behind they pass.
struct Chain {
    std::vector<Vec2> points{};  ///< m; at least two, three for a loop; no two in a row at the same place
    bool loop = false;           ///< the last point is joined to the first
    bool two_sided = false;      ///< the segments stop shapes from either side
    std::vector<Material> materials{};  ///< of single segments; without any, the shape's is that of all
    std::vector<std::uint16_t> material_of{};  ///< for each segment the index of its material

    friend bool operator==(const Chain&, const Chain&) = default;
};

/// A surface of triangles, the ground of space; it need not be closed. A triangle stops shapes whose centre
/// is on the side from which its corners run counter-clockwise.
struct Mesh {
    std::vector<Vec3> vertices{};  ///< m
    /// Indices of three different vertices each. Triangles thinner than 1e-10 of their length, of which real
    /// data have some, keep their index but are left out.
    std::vector<std::array<std::uint32_t, 3>> triangles{};
    bool two_sided = false;             ///< the triangles stop shapes from either side
    std::vector<Material> materials{};  ///< of single triangles; without any, the shape's is that of all
    std::vector<std::uint16_t> material_of{};  ///< for each triangle the index of its material

    friend bool operator==(const Mesh&, const Mesh&) = default;
};

/// Ground given by its height above evenly spaced places, +y being up; what is below is solid. It begins at
/// the origin of the shape's frame: height i of the plane stands at x = i · spacing, height [row][column] of
/// space at x = column · spacing[0], z = row · spacing[1]. A cell of space is two triangles, parted by the
/// line from its corner [row][column] to [row + 1][column + 1]. A height that is not a number (NaN) makes a
/// hole: the segments or triangles that end there are left out.
template <int D>
struct HeightField {
    /// m; at least two in each direction, rows of equal length.
    std::conditional_t<D == 2, std::vector<double>, std::vector<std::vector<double>>> heights{};
    std::array<double, D - 1> spacing{};       ///< m, positive
    std::vector<Material> materials{};         ///< of single cells; without any, the shape's is that of all
    std::vector<std::uint16_t> material_of{};  ///< for each cell, row by row, the index of its material

    friend bool operator==(const HeightField&, const HeightField&) = default;
};

using Box2 = Box<2>;
using Box3 = Box<3>;
using Capsule2 = Capsule<2>;
using Capsule3 = Capsule<3>;
using Hull2 = Hull<2>;
using Hull3 = Hull<3>;
using Plane2 = Plane<2>;
using Plane3 = Plane<3>;
using HeightField2 = HeightField<2>;
using HeightField3 = HeightField<3>;

/// One of the shapes that exist in the dimension `D`. Lengths lie between 1e-9 and 1e9 m. Chains, meshes and
/// height fields have no mass and are carried by fixed and kinematic bodies only.
template <int D>
using Geometry = std::conditional_t<
    D == 2, std::variant<Ball, Box<2>, Capsule<2>, Hull<2>, Plane<2>, Chain, HeightField<2>>,
    std::variant<Ball, Box<3>, Capsule<3>, Hull<3>, Plane<3>, Cylinder, Cone, Mesh, HeightField<3>>>;

/// Who meets whom: a pair collides when each one's `category` is in the other's `mask`. Two shapes of the
/// same non-zero `group` always collide when it is positive and never when it is negative.
struct Filter {
    std::uint64_t category = 1;
    std::uint64_t mask = ~std::uint64_t{0};
    std::int32_t group = 0;

    friend bool operator==(const Filter&, const Filter&) = default;
};

/// A shape as it is put on a body.
template <int D>
struct ShapeDefinition {
    Geometry<D> geometry{};
    Vec<D> center{};         ///< place of the shape's frame in the body's frame, m
    Rotation<D> rotation{};  ///< turn of the shape's frame in the body's frame; unit length
    Material material{};
    Filter filter{};
    /// Notices what overlaps it, touches nothing, and has no mass unless the body has nothing but sensors.
    /// Sensors do not notice one another.
    bool sensor = false;
    /// The side (in the shape's frame, any length but zero) from which others land on the shape: whoever
    /// comes from elsewhere passes through until it has left the shape.
    std::optional<Vec<D>> one_way{};
    /// Velocity of the surface against the body, in the shape's frame, m/s: a conveyor belt. What lies on it
    /// is dragged along by friction; only the part along the surface counts.
    Vec<D> surface_velocity{};
    std::uint64_t user_data = 0;  ///< yours

    friend bool operator==(const ShapeDefinition&, const ShapeDefinition&) = default;
};

using ShapeDefinition2 = ShapeDefinition<2>;
using ShapeDefinition3 = ShapeDefinition<3>;

}  // namespace carom
