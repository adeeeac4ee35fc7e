#include "geometry/polytope_mass.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

/// ∫ 1, ∫ x, ∫ |x|² over an area.
struct Integrals {
    double area = 0;
    Vec2 first{};
    double second = 0;

    /// Adds a piece whose integrals are about the point `from`.
    void add(const Integrals& piece, const Vec2& from) {
        area += piece.area;
        first += piece.first + piece.area * from;
        second += piece.second + 2 * dot(from, piece.first) + piece.area * dot(from, from);
    }
};

/// The triangle of the origin, a and b.
Integrals triangle(const Vec2& a, const Vec2& b) {
    const double area = 0.5 * cross(a, b);
    return {area, area / 3 * (a + b), area / 6 * (dot(a, a) + dot(a, b) + dot(b, b))};
}

/// A rectangle, about its centre.
Integrals rectangle(double width, double height) {
    const double area = width * height;
    return {area, {}, area / 12 * (width * width + height * height)};
}

/// The sector of a disk from the unit vector m to n, counter-clockwise, about the disk's centre.
Integrals sector(double radius, const Vec2& m, const Vec2& n) {
    const double angle = atan2(cross(m, n), dot(m, n)), square = radius * radius;
    // ∫ (cos φ, sin φ) dφ = (sin φ, −cos φ), taken at both ends.
    const Vec2 direction{n.y - m.y, m.x - n.x};
    return {0.5 * square * angle, square * radius / 3 * direction, 0.25 * square * square * angle};
}

}  // namespace

MassProperties2 polytope_mass(const Polygon& core, double radius) {
    const std::size_t count = core.vertices.size();
    // All lengths from a point nearby, so that nothing cancels for a polygon far from the origin.
    Vec2 middle{};
    for (const Vec2& v : core.vertices) middle += v / static_cast<double>(count);
    Integrals sum;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 a = core.vertices[i] - middle, b = core.vertices[(i + 1) % count] - middle;
        const Vec2& normal = core.normals[i];
        sum.add(triangle(a, b), {});
        // The strip along the edge and the sector around its end.
        sum.add(rectangle(length(b - a), radius), 0.5 * (a + b) + 0.5 * radius * normal);
        sum.add(sector(radius, normal, core.normals[(i + 1) % count]), b);
    }
    const Vec2 center = sum.first / sum.area;
    return {sum.area, middle + center, sum.second - sum.area * dot(center, center)};
}

}  // namespace carom::detail
