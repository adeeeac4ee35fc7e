#include <algorithm>
#include <cmath>

#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

namespace {

/// A point near another: along the line between them, or along `otherwise` where they coincide.
Nearest3 between(const Vec3& p, const Vec3& q, const Vec3& otherwise) {
    const double distance = length(q - p);
    return distance > 0 ? Nearest3{(q - p) / distance, distance, p, q} : Nearest3{otherwise, 0, p, q};
}

Vec3 closest_on_segment(const Vec3& from, const Vec3& to, const Vec3& p) {
    const Vec3 along = to - from;
    const double whole = length_squared(along);
    return whole > 0 ? from + std::clamp(dot(p - from, along) / whole, 0.0, 1.0) * along : from;
}

/// A shape's normal and gap at a point inside or over it, as the pair sees it: from the point's side.
Nearest3 against(const Vec3& point, const Vec3& outward, double gap) {
    return {-outward, gap, point, point - gap * outward};
}

bool over_face(const Polyhedron& core, std::size_t face, const Vec3& p) {
    const std::uint32_t begin = core.first[face], end = core.first[face + 1];
    for (std::uint32_t i = begin; i < end; ++i) {
        const Vec3& from = core.vertices[core.indices[i]];
        const Vec3& to = core.vertices[core.indices[i + 1 < end ? i + 1 : begin]];
        if (dot(cross(to - from, core.normals[face]), p - from) > 0) return false;
    }
    return true;
}

}  // namespace

Nearest3 point_point(const Pair3& pair, const Search3&) {
    return between(pair.a.a, apply(pair.b_in_a, pair.b.a), {0, 1, 0});
}

Nearest3 point_segment(const Pair3& pair, const Search3&) {
    const Vec3 from = apply(pair.b_in_a, pair.b.a), to = apply(pair.b_in_a, pair.b.b);
    const Vec3 across = any_perpendicular(length(to - from) > 0 ? normalized(to - from) : Vec3{0, 1, 0});
    return between(pair.a.a, closest_on_segment(from, to, pair.a.a), across);
}

Nearest3 point_box(const Pair3& pair, const Search3&) {
    const Shape<3>& box = pair.b;
    const Vec3 center = apply(pair.b_in_a, box.a);
    const Rotation3 turn = pair.b_in_a.rotation * box.rotation;
    const Vec3 p = unrotate(turn, pair.a.a - center);
    const Vec3& half = box.b;
    const Vec3 clamped{std::clamp(p.x, -half.x, half.x), std::clamp(p.y, -half.y, half.y),
                       std::clamp(p.z, -half.z, half.z)};
    if (clamped != p) return between(pair.a.a, center + rotate(turn, clamped), rotate(turn, {0, 1, 0}));

    int axis = 0;
    double gap = std::fabs(p.x) - half.x;
    for (int i = 1; i < 3; ++i) {
        const double candidate = std::fabs(p[i]) - half[i];
        if (candidate > gap) {
            gap = candidate;
            axis = i;
        }
    }
    Vec3 outward{};
    outward[axis] = p[axis] < 0 ? -1 : 1;
    return against(pair.a.a, rotate(turn, outward), gap);
}

Nearest3 point_polyhedron(const Pair3& pair, const Search3& search) {
    const Polyhedron& core = *pair.b.core;
    const Vec3 p = apply_inverse(pair.b_in_a, pair.a.a);
    double gap = -1e300;
    std::size_t face = 0;
    for (std::size_t f = 0; f < core.normals.size(); ++f) {
        const double candidate = dot(core.normals[f], p) - core.offsets[f];
        if (candidate > gap) {
            gap = candidate;
            face = f;
        }
    }
    const Vec3 outward = rotate(pair.b_in_a.rotation, core.normals[face]);
    if (gap <= 0 || gap > search.limit || over_face(core, face, p)) return against(pair.a.a, outward, gap);

    // Outside, and not over the face that is furthest below: then the closest point lies on an edge. Or on
    // another face, where several are furthest below but for the unevenness of the hull.
    Vec3 closest{};
    double least = 1e300;
    for (std::size_t f = 0; f < core.normals.size(); ++f) {
        const double height = dot(core.normals[f], p) - core.offsets[f];
        if (height < gap - 2 * core.unevenness || !over_face(core, f, p)) continue;
        closest = p - height * core.normals[f];
        least = height * height;
    }
    for (const Polyhedron::Edge& edge : core.edges) {
        const Vec3 q = closest_on_segment(core.vertices[edge.from], core.vertices[edge.to], p);
        if (length_squared(p - q) < least) {
            least = length_squared(p - q);
            closest = q;
        }
    }
    return between(pair.a.a, apply(pair.b_in_a, closest), -outward);
}

Nearest3 point_revolved(const Pair3& pair, const Search3&) {
    const Shape<3>& shape = pair.b;
    const Vec3 center = apply(pair.b_in_a, shape.a);
    const Vec3 axis = rotate(pair.b_in_a.rotation, shape.b);
    const Vec3 from_center = pair.a.a - center;
    const double y = dot(from_center, axis);
    const Vec3 across = from_center - y * axis;
    const double r = length(across);
    const Vec3 radial = r > 1e-12 * shape.radius ? across / r : any_perpendicular(axis);

    // In the half-plane through the axis and the point the body is a convex polygon against the axis.
    const double top = shape.kind == ShapeKind::cone ? 0 : shape.radius;
    const Vec2 profile[4] = {{0, -shape.half_height},
                             {shape.radius, -shape.half_height},
                             {top, shape.half_height},
                             {0, shape.half_height}};
    const Vec2 p{r, y};
    double gap = -1e300, least = 1e300;
    Vec2 outward{}, closest{};
    for (int i = 0; i < 3; ++i) {
        const Vec2 along = profile[i + 1] - profile[i];
        const double whole = length_squared(along);
        if (whole == 0) continue;
        const Vec2 normal = Vec2{along.y, -along.x} / std::sqrt(whole);
        const double candidate = dot(normal, p - profile[i]);
        if (candidate > gap) {
            gap = candidate;
            outward = normal;
        }
        const Vec2 q = profile[i] + std::clamp(dot(p - profile[i], along) / whole, 0.0, 1.0) * along;
        if (length_squared(p - q) < least) {
            least = length_squared(p - q);
            closest = q;
        }
    }
    const auto in_space = [&](const Vec2& v) { return v.x * radial + v.y * axis; };
    if (gap <= 0) return against(pair.a.a, in_space(outward), gap);
    return between(pair.a.a, center + in_space(closest), -in_space(outward));
}

}  // namespace carom::detail
