#include "geometry/polytope_mass.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

/// a bᵀ + b aᵀ
Symmetric3<double> product(const Vec3& a, const Vec3& b) {
    return {2 * a.x * b.x,         2 * a.y * b.y,         2 * a.z * b.z,
            a.x * b.y + a.y * b.x, a.x * b.z + a.z * b.x, a.y * b.z + a.z * b.y};
}

/// ∫ 1, ∫ x, ∫ x xᵀ over a volume, an area or a line.
struct Integrals {
    double size = 0;
    Vec3 first{};
    Symmetric3<double> second{};

    /// Adds a piece whose integrals are about the point `from`.
    void add(const Integrals& piece, const Vec3& from) {
        size += piece.size;
        first += piece.first + piece.size * from;
        second = second + piece.second + product(from, piece.first) + outer_square(from) * piece.size;
    }
};

/// The tetrahedron of the origin and three corners; the triangle of the three, for which only the size
/// differs: a simplex of n corners has ∫ x = size/n Σ xᵢ and ∫ x xᵀ = size/(n (n + 1)) (Σ xᵢ xᵢᵀ + Σ xᵢ Σ
/// xᵢᵀ). See Tonon 2004, Explicit exact formulas for the 3-D tetrahedron inertia tensor.
Integrals simplex(double size, double corners, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 sum = a + b + c;
    const auto squares = outer_square(a) + outer_square(b) + outer_square(c) + outer_square(sum);
    return {size, size / corners * sum, squares * (size / (corners * (corners + 1)))};
}

/// A face swept by `radius` along its normal: points x + t n with 0 ≤ t ≤ radius.
Integrals prism(const Integrals& face, const Vec3& normal, double radius) {
    const double t = radius, t2 = t * t / 2, t3 = t * t * t / 3;
    return {face.size * t, t * face.first + t2 * face.size * normal,
            face.second * t + product(face.first, normal) * t2 + outer_square(normal) * (face.size * t3)};
}

/// The arc on the unit sphere from m to n, two unit vectors, turning by `angle` about the unit vector `axis`.
struct Arc {
    Vec3 m, n, axis;
    double angle;
};

/// The wedge of a cylinder about an edge of the length given that runs along the axis of the arc, about the
/// middle of the edge: points t axis + ρ d, where d runs over the arc.
Integrals wedge(const Arc& arc, double length, double radius) {
    const double square = radius * radius;
    const Vec3 across = cross(arc.axis, arc.m);
    const auto [sine, cosine] = sin_cos(arc.angle);
    // With d = m cos φ + across sin φ: ∫ d dφ and ∫ d dᵀ dφ.
    const Vec3 direction = sine * arc.m + (1 - cosine) * across;
    const auto directions = outer_square(arc.m) * (0.5 * (arc.angle + sine * cosine)) +
                            outer_square(across) * (0.5 * (arc.angle - sine * cosine)) +
                            product(arc.m, across) * (0.5 * sine * sine);
    const double area = 0.5 * square * arc.angle;
    return {length * area, length * square * radius / 3 * direction,
            directions * (0.25 * length * square * square) +
                outer_square(arc.axis) * (area * length * length * length / 12)};
}

/// Integrals over the directions d that are normal to a corner, a spherical polygon on the unit sphere whose
/// sides are the arcs around the edges that end at the corner. Its area is 2π less the angles of the faces at
/// the corner (Descartes), and ∫ d = ½ Σ angle c, with c the unit normal of an arc's plane, to the inside
/// (Stokes).
struct Directions {
    double area = 2 * pi;
    Vec3 first{};

    /// The part of a ball around the corner that lies in these directions, but for ∫ x xᵀ about the corner:
    /// as all these parts make up one ball, that is added at once for all.
    Integrals sector(double radius) const {
        const double cube = radius * radius * radius;
        return {area * cube / 3, cube * radius / 4 * first, {}};
    }
};

double angle_between(const Vec3& a, const Vec3& b) { return atan2(length(cross(a, b)), dot(a, b)); }

/// The core and the prisms on its faces; takes the angles of the faces off the corners' directions.
void add_faces(Integrals& sum, std::vector<Directions>& corners, const Polyhedron& core,
               const std::vector<Vec3>& vertices, double radius) {
    for (std::size_t f = 0; f < core.normals.size(); ++f) {
        const std::size_t first = core.first[f], count = core.first[f + 1] - first;
        const auto index = [&](std::size_t i) { return core.indices[first + i % count]; };
        Integrals face;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 &a = vertices[index(0)], &b = vertices[index(i)], &c = vertices[index(i + 1)];
            sum.add(simplex(dot(a, cross(b, c)) / 6, 4, a, b, c), {});
            face.add(simplex(0.5 * dot(core.normals[f], cross(b - a, c - a)), 3, a, b, c), {});
            corners[index(i + 1)].area -= angle_between(vertices[index(i + 2)] - c, b - c);
        }
        sum.add(prism(face, core.normals[f], radius), {});
    }
}

}  // namespace

MassProperties3 polytope_mass(const Polyhedron& core, double radius) {
    // All lengths from a point nearby, so that nothing cancels for a polyhedron far from the origin.
    Vec3 middle{};
    for (const Vec3& v : core.vertices) middle += v / static_cast<double>(core.vertices.size());
    std::vector<Vec3> vertices;
    for (const Vec3& v : core.vertices) vertices.push_back(v - middle);

    Integrals sum;
    std::vector<Directions> corners(vertices.size());
    add_faces(sum, corners, core, vertices, radius);
    for (const auto& edge : core.edges) {
        const Vec3 &a = vertices[edge.from], &b = vertices[edge.to];
        const Vec3 &m = core.normals[edge.left], &n = core.normals[edge.right];
        const Vec3 along = normalized(b - a);
        const Arc arc{m, n, along, atan2(dot(cross(m, n), along), dot(m, n))};
        sum.add(wedge(arc, length(b - a), radius), 0.5 * (a + b));
        corners[edge.from].first -= 0.5 * arc.angle * along;
        corners[edge.to].first += 0.5 * arc.angle * along;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) sum.add(corners[i].sector(radius), vertices[i]);
    const double ball = 4 * pi / 15 * radius * radius * radius * radius * radius;
    sum.second = sum.second + diagonal(ball, ball, ball);

    const Vec3 center = sum.first / sum.size;
    const auto second = sum.second - outer_square(center) * sum.size;
    const double diagonal_sum = trace(second);
    return {sum.size, middle + center, diagonal(diagonal_sum, diagonal_sum, diagonal_sum) - second};
}

}  // namespace carom::detail
