#include "collision/ray.hpp"

#include <algorithm>
#include <limits>

#include "collision/point.hpp"

// A line and a convex solid have a stretch in common, or nothing. Each routine finds that stretch; a shape
// that is the union or the intersection of simpler ones joins or cuts theirs. The way along the line is
// counted in metres from a point near the shape, so that a ray from far away loses nothing.

namespace carom::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <int D>
struct Line {
    Vec<D> point;
    Vec<D> direction;  ///< unit vector

    Vec<D> at(double way) const { return point + way * direction; }
};

/// What a line and a solid have in common; nothing when it leaves before it enters.
template <int D>
struct Stretch {
    double enter = -infinity, leave = infinity;
    Vec<D> normal{};  ///< of the surface where the line enters

    bool empty() const { return !(enter <= leave); }
};
template <int D>
constexpr Stretch<D> nothing{infinity, -infinity, {}};

template <int D>
Stretch<D> joined(const Stretch<D>& a, const Stretch<D>& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.enter, b.enter), std::max(a.leave, b.leave), a.enter <= b.enter ? a.normal : b.normal};
}

/// Cuts the stretch down to the half-space normal · x ≤ offset.
template <int D>
void cut(Stretch<D>& stretch, const Line<D>& line, const Vec<D>& normal, double offset) {
    const double gap = dot(normal, line.point) - offset, speed = dot(normal, line.direction);
    if (speed > 0) {
        stretch.leave = std::min(stretch.leave, -gap / speed);
    } else if (speed < 0) {
        const double way = -gap / speed;
        if (way > stretch.enter) {
            stretch.enter = way;
            stretch.normal = normal;
        }
    } else if (gap > 0) {
        stretch = nothing<D>;
    }
}

template <int D>
Stretch<D> through_ball(const Line<D>& line, const Vec<D>& center, double radius) {
    const Vec<D> arm = line.point - center;
    const double middle = -dot(arm, line.direction);
    const Vec<D> nearest = arm + middle * line.direction;
    const double square = radius * radius - length_squared(nearest);
    if (square < 0) return nothing<D>;
    const double half = std::sqrt(square);
    return {middle - half, middle + half, (nearest - half * line.direction) / radius};
}

/// All that is within `radius` of the segment: two balls, and between them a cylinder (a strip in the plane).
template <int D>
Stretch<D> through_capsule(const Line<D>& line, const Vec<D>& from, const Vec<D>& to, double radius) {
    Stretch<D> result = joined(through_ball(line, from, radius), through_ball(line, to, radius));
    const Vec<D> axis = normalized(to - from);
    if (axis == Vec<D>{}) return result;
    const Vec<D> arm = line.point - from;
    const Vec<D> across = arm - dot(arm, axis) * axis;
    const Vec<D> direction = line.direction - dot(line.direction, axis) * axis;
    const double square = length_squared(direction);
    Stretch<D> between;
    if (square > 0) {
        const double middle = -dot(across, direction) / square;
        const Vec<D> nearest = across + middle * direction;
        const double rest = radius * radius - length_squared(nearest);
        if (rest < 0) return nothing<D>;
        const double half = std::sqrt(rest / square);
        between = {middle - half, middle + half, (nearest - half * direction) / radius};
    } else if (length_squared(across) > radius * radius) {
        return nothing<D>;
    }
    // Where it enters through an end it is in a ball already, so the side's normal stands.
    const Vec<D> side = between.normal;
    cut(between, line, axis, dot(axis, to));
    cut(between, line, -axis, -dot(axis, from));
    between.normal = side;
    return joined(result, between);
}

double offset_of(const Polygon& core, std::size_t face) {
    return dot(core.normals[face], core.vertices[face]);
}
double offset_of(const Polyhedron& core, std::size_t face) { return core.offsets[face]; }

/// The polytope, its faces moved outwards by `radius`.
template <int D>
Stretch<D> through_faces(const Line<D>& line, const Polytope<D>& core, double radius) {
    Stretch<D> result;
    for (std::size_t i = 0; i < core.normals.size() && !result.empty(); ++i)
        cut(result, line, core.normals[i], offset_of(core, i) + radius);
    return result;
}

/// The faces of the polytope made `radius` thick outwards, and the capsules along its edges.
Stretch<2> through_rim(const Line<2>& line, const Polygon& core, double radius) {
    Stretch<2> result = nothing<2>;
    for (std::size_t i = 0; i < core.vertices.size(); ++i) {
        const Vec2& next = core.vertices[i + 1 < core.vertices.size() ? i + 1 : 0];
        result = joined(result, through_capsule(line, core.vertices[i], next, radius));
    }
    return result;
}
Stretch<3> through_rim(const Line<3>& line, const Polyhedron& core, double radius) {
    Stretch<3> result = nothing<3>;
    for (const Polyhedron::Edge& edge : core.edges) {
        result =
            joined(result, through_capsule(line, core.vertices[edge.from], core.vertices[edge.to], radius));
    }
    for (std::size_t face = 0; face < core.normals.size(); ++face) {
        const Vec3& normal = core.normals[face];
        Stretch<3> prism;
        cut(prism, line, normal, core.offsets[face] + radius);
        cut(prism, line, -normal, -core.offsets[face]);
        for (std::uint32_t i = core.first[face]; i < core.first[face + 1] && !prism.empty(); ++i) {
            const std::uint32_t next = i + 1 < core.first[face + 1] ? i + 1 : core.first[face];
            const Vec3& corner = core.vertices[core.indices[i]];
            const Vec3 outward = cross(core.vertices[core.indices[next]] - corner, normal);
            cut(prism, line, outward, dot(outward, corner));
        }
        prism.normal = normal;  // from elsewhere it is entered out of the core or a capsule
        result = joined(result, prism);
    }
    return result;
}

template <int D>
Stretch<D> through_hull(const Line<D>& line, const Shape<D>& shape) {
    const Stretch<D> sharp = through_faces(line, *shape.core, shape.radius);
    if (shape.radius == 0 || sharp.empty()) return sharp;
    return joined(through_faces(line, *shape.core, 0.0), through_rim(line, *shape.core, shape.radius));
}

template <int D>
Stretch<D> through_box(const Line<D>& line, const Shape<D>& box) {
    const Line<D> local{unrotate(box.rotation, line.point - box.a), unrotate(box.rotation, line.direction)};
    Stretch<D> result;
    for (int i = 0; i < D && !result.empty(); ++i) {
        Vec<D> normal{};
        normal[i] = 1;
        cut(result, local, normal, box.b[i] + box.radius);
        cut(result, local, -normal, box.b[i] + box.radius);
    }
    if (result.empty()) return nothing<D>;
    // Where it passes through the flat part of two faces, the rounding does not matter.
    const auto on_flat = [&](double way) {
        int beside = 0;
        for (int i = 0; i < D; ++i) beside += std::fabs(local.at(way)[i]) > box.b[i];
        return beside <= 1;
    };
    if (box.radius > 0 && !(on_flat(result.enter) && on_flat(result.leave))) return through_hull(line, box);
    result.normal = rotate(box.rotation, result.normal);
    return result;
}

/// A line and a quadric a s² + 2 b s + c ≤ 0: the roots, the smaller first; false when there are none.
bool roots(double a, double b, double c, double& first, double& second) {
    const double square = b * b - a * c;
    if (square < 0 || (a == 0 && b == 0 && c > 0)) return false;
    // The sum without cancellation gives one root, the product of both the other.
    const double sum = -(b + std::copysign(std::sqrt(square), b));
    first = c / sum;
    second = sum / a;
    if (sum == 0) first = second = 0;
    if (first > second) std::swap(first, second);
    return true;
}

Stretch<3> through_cylinder(const Line<3>& line, const Shape<3>& shape) {
    const Vec3 arm = line.point - shape.a;
    const Vec3 across = arm - dot(arm, shape.b) * shape.b;
    const Vec3 direction = line.direction - dot(line.direction, shape.b) * shape.b;
    const double square = length_squared(direction);
    Stretch<3> result;
    if (square > 0) {
        const double middle = -dot(across, direction) / square;
        const Vec3 nearest = across + middle * direction;
        const double rest = shape.radius * shape.radius - length_squared(nearest);
        if (rest < 0) return nothing<3>;
        const double half = std::sqrt(rest / square);
        result = {middle - half, middle + half, (nearest - half * direction) / shape.radius};
    } else if (length_squared(across) > shape.radius * shape.radius) {
        return nothing<3>;
    }
    const double middle = dot(shape.b, shape.a);
    cut(result, line, shape.b, middle + shape.half_height);
    cut(result, line, -shape.b, shape.half_height - middle);
    return result;
}

/// With x across the axis and y below the tip, the slant is |x|² = k² y²; the line is within it between the
/// two roots, or, if it is steeper, beyond one of them.
Stretch<3> through_cone(const Line<3>& line, const Shape<3>& shape) {
    const double h = shape.half_height, k = shape.radius / (2 * h);
    const Vec3 arm = line.point - shape.a;
    const double y = h - dot(arm, shape.b), down = -dot(line.direction, shape.b);
    const Vec3 x = arm - dot(arm, shape.b) * shape.b, outward = line.direction + down * shape.b;
    const double a = length_squared(outward) - k * k * down * down;
    Stretch<3> result;
    double first, second;
    if (!roots(a, dot(x, outward) - k * k * y * down, length_squared(x) - k * k * y * y, first, second))
        return nothing<3>;
    const auto below_tip = [&](double way) { return y + way * down >= 0; };
    if (a > 0) {
        if (!below_tip(0.5 * (first + second))) return nothing<3>;
        result.enter = first;
        result.leave = second;
    } else if (down > 0) {
        result.enter = below_tip(first) ? first : second;
    } else {
        result.leave = below_tip(second) ? second : first;
    }
    if (result.enter > -infinity) {
        const Vec3 p = x + result.enter * outward;
        const Vec3 slope = p + k * k * (y + result.enter * down) * shape.b;
        result.normal = length_squared(slope) > 0 ? normalized(slope) : shape.b;
    }
    const double middle = dot(shape.b, shape.a);
    cut(result, line, shape.b, middle + h);
    cut(result, line, -shape.b, h - middle);
    return result;
}

template <int D>
Stretch<D> through(const Line<D>& line, const Shape<D>& shape) {
    switch (shape.kind) {
        case ShapeKind::ball:
            return through_ball(line, shape.a, shape.radius);
        case ShapeKind::capsule:
            return through_capsule(line, shape.a, shape.b, shape.radius);
        case ShapeKind::box:
            return through_box(line, shape);
        case ShapeKind::hull:
            return through_hull(line, shape);
        case ShapeKind::plane: {
            Stretch<D> result;
            cut(result, line, shape.a, shape.offset);
            return result;
        }
        case ShapeKind::cylinder:
            if constexpr (D == 3) return through_cylinder(line, shape);
            break;
        case ShapeKind::cone:
            if constexpr (D == 3) return through_cone(line, shape);
            break;
    }
    return nothing<D>;
}

/// A point in the shape.
template <int D>
Vec<D> middle_of(const Shape<D>& shape) {
    if (shape.kind == ShapeKind::capsule) return 0.5 * (shape.a + shape.b);
    return shape.kind == ShapeKind::hull ? shape.core->vertices.front() : shape.a;
}

}  // namespace

template <int D>
std::optional<CastHit<D>> cast_ray(const Shape<D>& shape, const Vec<D>& origin, const Vec<D>& translation) {
    const double whole = length(translation);
    if (!(whole > 0)) {
        if (!holds(shape, origin)) return std::nullopt;
        return CastHit<D>{0, origin, {}};
    }
    const Vec<D> direction = translation / whole;
    // The point of the ray nearest to the shape; a plane is as near everywhere.
    const double ahead = shape.kind == ShapeKind::plane
                             ? 0.0
                             : std::clamp(dot(middle_of(shape) - origin, direction), 0.0, whole);
    const Stretch<D> found = through(Line<D>{origin + ahead * direction, direction}, shape);
    const double enter = ahead + found.enter, leave = ahead + found.leave;
    if (found.empty() || enter > whole || leave < 0) return std::nullopt;
    if (enter < 0) return CastHit<D>{0, origin, -direction};
    return CastHit<D>{enter / whole, origin + enter * direction, found.normal};
}

template std::optional<CastHit<2>> cast_ray(const Shape<2>&, const Vec<2>&, const Vec<2>&);
template std::optional<CastHit<3>> cast_ray(const Shape<3>&, const Vec<3>&, const Vec<3>&);

}  // namespace carom::detail
