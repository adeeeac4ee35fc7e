#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/quadrature.hpp"
#include "geometry/submerged.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

/// Integrals over the part of a solid below the plane z = 0, by what flows through its surface: with the
/// normal n, ∫ 1 = ∮ z n_z, ∫ x = ∮ x z n_z for what runs along the plane and half of that for z. On the
/// plane itself all of them vanish, so the surface of the whole solid, cut off at the plane, is all that is
/// needed. Points count from one in the plane.
struct Flow {
    double volume = 0;  ///< ∮ z n_z
    Vec3 first{};       ///< ∮ x z n_z
    double square = 0;  ///< ∮ z² n_z
};

/// The surface that a shape is cut off at.
struct Water {
    Vec3 up, origin;  ///< unit vector, and a point of the surface

    Vec3 seen(const Vec3& p) const { return p - origin; }
    double height(const Vec3& p) const { return dot(up, p); }
};

/// ∫ z, ∫ x z and ∫ z² over the part of a triangle below the water, times n_z.
void add_triangle(Flow& flow, double rise, const Vec3& normal, const Water& water,
                  const std::array<Vec3, 3>& p) {
    const double area = 0.5 * dot(normal, cross(p[1] - p[0], p[2] - p[0])) * rise;
    const std::array<double, 3> z{water.height(p[0]), water.height(p[1]), water.height(p[2])};
    const double sum = z[0] + z[1] + z[2];
    flow.volume += area / 3 * sum;
    flow.first += area / 12 * (sum * (p[0] + p[1] + p[2]) + z[0] * p[0] + z[1] * p[1] + z[2] * p[2]);
    flow.square += area / 12 * (sum * sum + z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
}

/// A flat face, shifted by `radius` along its normal.
void add_face(Flow& flow, const Polyhedron& core, std::size_t face, double radius, const Water& water) {
    const Vec3& normal = core.normals[face];
    const double rise = dot(water.up, normal);
    const std::size_t begin = core.first[face], end = core.first[face + 1];
    const auto corner = [&](std::size_t i) {
        return water.seen(core.vertices[core.indices[i]] + radius * normal);
    };
    // A fan over the corners of what is left below, as they come; the first of them is its middle.
    std::array<Vec3, 3> fan;
    int count = 0;
    const auto take = [&](const Vec3& p) {
        if (count >= 2) {
            fan[2] = p;
            add_triangle(flow, rise, normal, water, fan);
            fan[1] = p;
        } else {
            fan[static_cast<std::size_t>(count)] = p;
        }
        ++count;
    };
    Vec3 before = corner(end - 1);
    double before_height = water.height(before);
    for (std::size_t i = begin; i < end; ++i) {
        const Vec3 p = corner(i);
        const double height = water.height(p);
        if ((height < 0) != (before_height < 0))
            take(before + (p - before) * (before_height / (before_height - height)));
        if (height < 0) take(p);
        before = p;
        before_height = height;
    }
}

/// The angles φ between 0 and `end` where a cos φ + b sin φ = c, with both limits: there and back.
struct Cuts {
    std::array<double, 6> at{};
    std::size_t count = 1;
    double end;

    explicit Cuts(double limit) : end(limit) {}
    void add(double a, double b, double c) {
        const double size = std::sqrt(a * a + b * b);
        if (!(std::fabs(c) < size)) return;
        const double middle = atan2(b, a), half = acos(c / size);
        for (double angle : {middle - half, middle + half}) {
            if (angle < 0) angle += 2 * pi;
            if (angle > 0 && angle < end) insert(angle);
        }
    }
    /// In order, after the zero at the front.
    void insert(double angle) {
        std::size_t i = count++;
        for (; i > 1 && at[i - 1] > angle; --i) at[i] = at[i - 1];
        at[i] = angle;
    }
    template <class Visit>
    void each_piece(const Visit& visit) {
        at[count++] = end;
        for (std::size_t i = 0; i + 1 < count; ++i) each_node(at[i], at[i + 1], visit);
    }
};

/// The directions from m on, turning about the unit vector `axis` by `angle`.
struct Arc {
    Vec3 m, axis, across;
    double angle;
};

/// The part of a cylinder around the edge from a to b whose normals are on the arc. For each normal the line
/// along the edge is cut off at the water.
void add_edge(Flow& flow, const Arc& arc, const Vec3& a, const Vec3& b, double radius, const Water& water) {
    const double za = water.height(a), zb = water.height(b), edge = length(b - a);
    const double up_m = dot(water.up, arc.m), up_across = dot(water.up, arc.across);
    Cuts cuts(arc.angle);
    cuts.add(radius * up_m, radius * up_across, -za);
    cuts.add(radius * up_m, radius * up_across, -zb);
    cuts.each_piece([&](double angle, double weight) {
        const auto [sine, cosine] = sin_cos(angle);
        const Vec3 normal = cosine * arc.m + sine * arc.across;
        const double rise = cosine * up_m + sine * up_across;
        double z0 = za + radius * rise, z1 = zb + radius * rise;
        if (z0 >= 0 && z1 >= 0) return;
        double from = 0, to = 1;
        if (z0 > 0) from = z0 / (z0 - z1);
        if (z1 > 0) to = z0 / (z0 - z1);
        const Vec3 p0 = a + from * (b - a) + radius * normal, p1 = a + to * (b - a) + radius * normal;
        z0 = std::min(z0, 0.0);
        z1 = std::min(z1, 0.0);
        const double area = weight * radius * edge * (to - from) * rise;
        flow.volume += area * 0.5 * (z0 + z1);
        flow.first += area / 6 * ((2 * z0 + z1) * p0 + (z0 + 2 * z1) * p1);
        flow.square += area / 3 * (z0 * z0 + z0 * z1 + z1 * z1);
    });
}

/// Integrals over directions n below a height: those with ζ = up · n < level, of a spherical polygon.
/// With the angle ψ about `up` the area is dζ dψ. Towards the inside of an arc about the axis e:
/// ∫ n ζᵏ along the surface = ∮ (n × up) ζᵏ dζ (Stokes), and ∫ ζᵏ = −∮ F dψ + ½ C Ω, where F' = ζᵏ − ½ C
/// below the level and −½ C above it, C = ∫ ζᵏ dζ up to the level, so that F vanishes at both poles, where ψ
/// has no meaning, and dψ = e · up dφ / (1 − ζ²).
struct Directions {
    double solid_angle = 2 * pi;     ///< less the angles of the faces that meet (Descartes)
    std::array<double, 4> powers{};  ///< ∫ ζᵏ, but for the share of the solid angle; k = 1, 2, 3
    std::array<Vec3, 3> sideways{};  ///< ∫ n ζᵏ along the surface; k = 1, 2
};

/// F / (1 + ζ) below the level without its C, for F' = ζᵏ and F(−1) = 0.
double quotient(int k, double zeta) {
    switch (k) {
        case 1:
            return 0.5 * (zeta - 1);
        case 2:
            return (zeta * zeta - zeta + 1) / 3;
        default:
            return 0.25 * (zeta - 1) * (zeta * zeta + 1);
    }
}
double power_up_to(int k, double level) { return (1 + level) * quotient(k, level); }

/// The arc as a side of the polygon that lies where `axis` · `sign` points.
void add_side(Directions& directions, const Arc& arc, double sign, double level, const Vec3& up) {
    if (level <= -1) return;
    level = std::min(level, 1.0);
    const double up_m = dot(up, arc.m), up_across = dot(up, arc.across);
    const double winding = sign * dot(up, arc.axis);
    Cuts cuts(arc.angle);
    cuts.add(up_m, up_across, level);
    cuts.each_piece([&](double angle, double weight) {
        const auto [sine, cosine] = sin_cos(angle);
        const double zeta = cosine * up_m + sine * up_across;
        const bool below = zeta < level;
        for (int k = 1; k <= 3; ++k) {
            const double c = 0.5 * power_up_to(k, level);
            const double f =
                below ? (quotient(k, zeta) - c) / std::max(1 - zeta, 1e-12) : c / std::max(1 + zeta, 1e-12);
            directions.powers[static_cast<std::size_t>(k)] -= weight * winding * f;
        }
        if (!below) return;
        const Vec3 n = cosine * arc.m + sine * arc.across;
        const double change = cosine * up_across - sine * up_m;  // dζ / dφ
        const Vec3 flow = (sign * weight * change * zeta) * cross(n, up);
        directions.sideways[1] += flow;
        directions.sideways[2] += zeta * flow;
    });
}

/// The part of a ball around the corner whose normals are in the directions.
void add_corner(Flow& flow, const Directions& d, const Vec3& corner, double radius, const Water& water) {
    const double level = -water.height(corner) / radius, clamped = std::clamp(level, -1.0, 1.0);
    if (level <= -1) return;
    const auto power = [&](int k) {
        return d.powers[static_cast<std::size_t>(k)] + 0.5 * power_up_to(k, clamped) * d.solid_angle;
    };
    // z = radius (ζ − level) and x = corner + radius n.
    const double cube = radius * radius * radius;
    const double volume = cube * (power(2) - level * power(1));
    flow.volume += volume;
    flow.first +=
        volume * corner +
        cube * radius * (d.sideways[2] - level * d.sideways[1] + (power(3) - level * power(2)) * water.up);
    flow.square += cube * radius * (power(3) - 2 * level * power(2) + level * level * power(1));
}

/// Edges and corners of a polyhedron that is grown by the radius.
void add_rounding(Flow& flow, const Polyhedron& core, double radius, const Water& water) {
    std::vector<Directions> corners(core.vertices.size());
    for (std::size_t f = 0; f < core.normals.size(); ++f) {
        const std::size_t first = core.first[f], count = core.first[f + 1] - first;
        for (std::size_t i = 0; i < count; ++i) {
            const auto vertex = [&](std::size_t k) { return core.indices[first + (i + k) % count]; };
            const Vec3& at = core.vertices[vertex(1)];
            const Vec3 u = core.vertices[vertex(2)] - at, v = core.vertices[vertex(0)] - at;
            corners[vertex(1)].solid_angle -= atan2(length(cross(u, v)), dot(u, v));
        }
    }
    for (const Polyhedron::Edge& edge : core.edges) {
        const Vec3 a = water.seen(core.vertices[edge.from]), b = water.seen(core.vertices[edge.to]);
        const Vec3 &m = core.normals[edge.left], &n = core.normals[edge.right];
        const Vec3 axis = normalized(b - a);
        const Arc arc{m, axis, cross(axis, m), atan2(dot(cross(m, n), axis), dot(m, n))};
        add_edge(flow, arc, a, b, radius, water);
        add_side(corners[edge.from], arc, -1, -water.height(a) / radius, water.up);
        add_side(corners[edge.to], arc, 1, -water.height(b) / radius, water.up);
    }
    for (std::size_t i = 0; i < corners.size(); ++i)
        add_corner(flow, corners[i], water.seen(core.vertices[i]), radius, water);
}

/// With q the height of the surface over the centre in radii, ∫ π (1 − z²) dz from −1 to q, and the same of
/// z.
Submerged<3> submerged_ball(const Vec3& center, double radius, const Vec3& up, double surface) {
    const double q = std::clamp((surface - dot(up, center)) / radius, -1.0, 1.0);
    const double unit = pi * (2 + q * (3 - q * q)) / 3, rest = 1 - q * q;
    if (!(unit > 0)) return {};
    return {unit * radius * radius * radius, center - (0.25 * pi * rest * rest / unit * radius) * up};
}

}  // namespace

template <>
Submerged<3> submerged(const Shape<3>& shape, const Vec3& up, double surface) {
    switch (shape.kind) {
        case ShapeKind::ball:
            return submerged_ball(shape.a, shape.radius, up, surface);
        case ShapeKind::capsule:
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return submerged_revolved(shape, up, surface);
        case ShapeKind::plane:
        case ShapeKind::terrain:
            return {};
        default:
            break;
    }
    const Vec3 middle = middle_of(shape);
    const Water water{up, middle + (surface - dot(up, middle)) * up};
    Flow flow;
    for (std::size_t f = 0; f < shape.core->normals.size(); ++f)
        add_face(flow, *shape.core, f, shape.radius, water);
    if (shape.radius > 0) add_rounding(flow, *shape.core, shape.radius, water);
    if (!(flow.volume > 0)) return {};
    return {flow.volume, water.origin + (flow.first - 0.5 * flow.square * up) / flow.volume};
}

}  // namespace carom::detail
