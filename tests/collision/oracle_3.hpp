#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "carom/collide.hpp"
#include "random.hpp"

namespace carom::test::space {

/// A placed shape by its definition alone: slow, simple, and independent of the engine's code.
class Body3 {
  public:
    Body3(const Geometry<3>& geometry, const Transform3& placed);
    /// A triangle, which has two faces and no volume.
    explicit Body3(const std::array<Vec3, 3>& triangle);

    /// The furthest that the shape reaches along the unit vector, in the outer frame.
    double reach(const Vec3& direction) const;
    /// Signed distance of a point from the surface, negative inside.
    double height(const Vec3& point) const;
    /// A length of the order of the shape's size, and of its thinnest part.
    double size() const { return size_; }
    double thickness() const { return thickness_; }
    double radius() const { return radius_; }
    /// How far the engine's shape may be off: hulls leave out points that stand out by less than 1e-5 of the
    /// size.
    double vagueness() const { return hull_ ? 3e-5 * size_ : 0; }
    bool is_plane() const { return plane_; }
    /// A core that is a point, a segment or a polyhedron has all its corners here; others have none.
    const std::vector<Vec3>& corners() const { return corners_; }
    const std::vector<Vec3>& normals() const { return placed_normals_; }
    const Transform3& placed() const { return placed_; }

  private:
    void set(const Ball& ball);
    void set(const Box3& box);
    void set(const Capsule3& capsule);
    void set(const Hull3& hull);
    void set(const Plane3& plane);
    void set(const Cylinder& cylinder) { set_revolved(cylinder.radius, cylinder.radius, cylinder.height); }
    void set(const Cone& cone) { set_revolved(cone.radius, 0, cone.height); }
    void set(const Mesh&) {}  // a mesh or height field is tried triangle by triangle
    void set(const HeightField3&) {}
    void set_revolved(double bottom, double top, double height);
    void find_faces();
    double polyhedron_height(const Vec3& p) const;
    double revolved_height(const Vec3& p) const;

    struct Face {
        Vec3 normal;
        double offset;
    };
    Transform3 placed_;
    std::vector<Vec3> vertices_;  ///< of the core, in the shape's frame
    std::vector<Face> faces_;
    std::vector<Vec3> corners_, placed_normals_;
    double bottom_ = 0, top_ = 0, half_height_ = 0;  ///< radii of a body of revolution
    double radius_ = 0, size_ = 0, thickness_ = 0;
    Plane3 half_space_;
    bool plane_ = false, hull_ = false;
};

/// The gap between two shapes along a unit vector from a to b.
double gap_along(const Body3& a, const Body3& b, const Vec3& axis);

/// The widest gap over all directions: the distance of shapes that are apart, minus the depth of those that
/// overlap. Exact for points, segments and polyhedra (all pairs of features are tried); for cylinders and
/// cones a search over many directions, which may fall a little short.
double widest_gap(const Body3& a, const Body3& b);

/// The kinds of shape, in the order of `Geometry<3>`.
enum class Kind { ball, box, capsule, hull, plane, cylinder, cone };
constexpr int kinds = 7;
std::string name_of(Kind kind);

/// A shape of random proportions whose largest length is about `size`; now and then it is thin.
Geometry<3> random_geometry(Kind kind, double size, Random& random);

}  // namespace carom::test::space
