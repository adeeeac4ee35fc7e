#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "carom/mass.hpp"
#include "carom/scheduler.hpp"
#include "carom/shapes.hpp"
#include "geometry/columns.hpp"

namespace carom::detail {

/// Kinds of shape, in the order of the rows and columns of the collision matrix. A facet is one segment or
/// triangle of a terrain while something collides with it, and is not in the matrix.
enum class ShapeKind : std::uint8_t { ball, capsule, box, hull, cylinder, cone, plane, terrain, facet };

template <int D>
class Terrain;

/// A convex polygon (2D): corners counter-clockwise; normal i belongs to the edge from corner i to i + 1.
struct Polygon {
    std::vector<Vec2> vertices;
    std::vector<Vec2> normals;
};

/// A convex polyhedron (3D). Face f has the corners indices[first[f]] … indices[first[f + 1] − 1],
/// counter-clockwise seen from outside, and lies in the plane normals[f] · x = offsets[f].
struct Polyhedron {
    struct Edge {
        std::uint32_t from, to;     ///< corners; the edge runs so along `left`'s boundary
        std::uint32_t left, right;  ///< the two faces that it parts
    };
    std::vector<Vec3> vertices;
    std::vector<Vec3> normals;
    std::vector<double> offsets;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> first;  ///< one more than there are faces
    std::vector<Edge> edges;
    Vec3 middle{};          ///< mean of the corners
    double extent = 0;      ///< from the middle to the corner furthest from it
    double unevenness = 0;  ///< by how much corners stand out of faces
    Columns corners;        ///< the vertices once more, where there are many
    Columns faces;          ///< the normals once more, where there are many
};

template <int D>
using Polytope = std::conditional_t<D == 2, Polygon, Polyhedron>;

/// A shape as the engine works with it: checked, and placed in the frame of its body, so that only the
/// body's own placement is left to apply. Shapes of kind box and hull are `core` grown by `radius`;
/// a capsule is the segment from `a` to `b` grown by `radius`; a ball is the point `a` grown by `radius`.
template <int D>
struct Shape {
    ShapeKind kind = ShapeKind::ball;
    double radius = 0;       ///< ball, capsule: radius; box, hull: rounding; cylinder, cone: radius
    double half_height = 0;  ///< cylinder, cone
    Vec<D> a{};              ///< ball: centre; capsule: one end; cylinder, cone, box: centre;
                             ///< plane: unit normal
    Vec<D> b{};              ///< capsule: other end; cylinder, cone: unit axis; box: half lengths of
                             ///< the core (without the rounding)
    double offset = 0;       ///< plane: n · x ≤ offset is solid
    Rotation<D> rotation{};  ///< box: turn of its axes in the body
    std::shared_ptr<const Polytope<D>> core;    ///< box, hull: corners and faces in the body's frame
    std::shared_ptr<const Terrain<D>> terrain;  ///< chain, mesh, height field: in the body's frame
};

/// Lengths that shapes may have, m. Beyond these, volumes and moments of inertia leave the range in which
/// the engine computes well.
constexpr double shortest_length = 1e-9, longest_length = 1e9;

/// Checks what a shape is made of. Throws `Error` that names the field.
void check_material(const Material& material);

/// Checks the definition and makes the shape, large terrain by the workers of the scheduler if there is one.
/// Throws `Error` that names the field (`radius`, `size`, …).
template <int D>
Shape<D> make_shape(const ShapeDefinition<D>& definition, Scheduler* scheduler = nullptr);

/// Axis-aligned bounds of the shape on a body at `placed`; a plane's are infinite (±1e300) where they must
/// be.
template <int D>
Aabb<D> bounds(const Shape<D>& shape, const Transform<D>& placed);

/// The point of the shape that lies furthest along `direction` (any length but zero), in the body's frame,
/// without `radius` for ball, capsule, box and hull (their core only). Not for planes and terrains.
template <int D>
Vec<D> core_support(const Shape<D>& shape, const Vec<D>& direction);

/// The index of the corner that lies furthest along the direction; the first of several.
std::size_t furthest_corner(const Polygon& core, const Vec2& direction);
std::size_t furthest_corner(const Polyhedron& core, const Vec3& direction);

/// A point about in the middle of a convex shape, in the frame of its body.
template <int D>
Vec<D> middle_of(const Shape<D>& convex);

/// A ball that fits into a convex shape, about its middle or its centre of mass, as a shape of its own.
template <int D>
Shape<D> inner_ball(const Shape<D>& convex);

/// The flat face of the shape, rounding included, that looks most along the unit vector `direction` (in the
/// body's frame): its plane n · x = offset. Nothing when that is more than 2.5 degrees off.
template <int D>
struct FacePlane {
    Vec<D> normal{};
    double offset = 0;
};
template <int D>
std::optional<FacePlane<D>> facing_plane(const Shape<D>& shape, const Vec<D>& direction);

/// The radius by which the core of `core_support` is grown: zero for cylinder and cone.
template <int D>
double core_radius(const Shape<D>& shape) {
    return shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone ? 0.0 : shape.radius;
}

/// Convex hull of the points, corners counter-clockwise, collinear ones left out (Andrew 1979).
/// Throws `Error` when the points span no area.
Polygon convex_polygon(const std::vector<Vec2>& points);

/// Convex hull of the points, coplanar triangles merged into faces (Quickhull, Barber et al. 1996).
/// Throws `Error` when the points span no volume.
Polyhedron convex_polyhedron(const std::vector<Vec3>& points);

}  // namespace carom::detail
