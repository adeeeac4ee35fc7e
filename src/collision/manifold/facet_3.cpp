#include "collision/manifold/facet_3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

namespace {

void set_edge(Facet3& facet, const Vec3& p, const Vec3& q) {
    facet.form = Facet3::Form::edge;
    facet.normal = {};
    facet.extent = length(q - p);
    facet.corners.assign({{p, 0}, {q, 1}});
}

void set_face(Facet3& facet, const Vec3& normal, Facet3::Form form) {
    facet.form = form;
    facet.normal = normal;
    facet.offset = dot(normal, facet.corners[0].position);
    facet.extent = 0;
    for (const FacetCorner& corner : facet.corners)
        facet.extent = std::max(facet.extent, length(corner.position - facet.corners[0].position));
}

void box_facet(const Shape<3>& box, const Vec3& direction, Facet3& facet) {
    const Vec3 local = unrotate(box.rotation, direction);
    constexpr double tie = 1e-4;  // a box that stands on its edge shows the same face in every step
    int axis = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::fabs(local[i]) > std::fabs(local[axis]) + tie) axis = i;
    }
    const double sign = local[axis] < 0 ? -1.0 : 1.0;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const Vec3& half = box.b;
    facet.id = static_cast<std::uint32_t>(2 * axis + (sign < 0 ? 1 : 0));

    const auto corner = [&](double along_u, double along_v) {
        Vec3 p{};
        p[axis] = sign * half[axis];
        p[u] = along_u * half[u];
        p[v] = along_v * half[v];
        return rotate(box.rotation, p) + box.a;
    };
    facet.corners.assign(
        {{corner(-1, -sign), 0}, {corner(1, -sign), 1}, {corner(1, sign), 2}, {corner(-1, sign), 3}});
    Vec3 normal{};
    normal[axis] = sign;
    set_face(facet, rotate(box.rotation, normal), Facet3::Form::face);
}

/// The face that looks most along the direction, the first of several, among those with a corner that lies
/// at least so far along it.
std::size_t most_aligned_face(const Polyhedron& core, const Vec3& direction, double reached) {
    const auto touches = [&](std::size_t face) {
        return std::any_of(core.indices.begin() + core.first[face],
                           core.indices.begin() + core.first[face + 1],
                           [&](std::uint32_t i) { return dot(direction, core.vertices[i]) >= reached; });
    };
    if (!core.faces.empty()) {
        const std::size_t likely = core.faces.furthest(direction);
        if (touches(likely)) return likely;
    }
    std::size_t best = 0;
    double alignment = -2;
    for (std::size_t f = 0; f < core.normals.size(); ++f) {
        const double candidate = dot(direction, core.normals[f]);
        if (candidate <= alignment || !touches(f)) continue;
        alignment = candidate;
        best = f;
    }
    return best;
}

/// The least and the greatest product of the corners with the direction.
std::array<double, 2> range_along(const Polyhedron& core, const Vec3& direction) {
    if (!core.corners.empty()) return core.corners.range(direction);
    double lowest = 1e300, highest = -1e300;
    for (const Vec3& vertex : core.vertices) {
        lowest = std::min(lowest, dot(direction, vertex));
        highest = std::max(highest, dot(direction, vertex));
    }
    return {lowest, highest};
}

void hull_facet(const Shape<3>& hull, const Vec3& direction, Facet3& facet) {
    const Polyhedron& core = *hull.core;
    const auto [lowest, highest] = range_along(core, direction);
    const std::size_t best = most_aligned_face(core, direction, highest - 1e-6 * (highest - lowest));
    facet.id = static_cast<std::uint32_t>(best);
    facet.corners.clear();
    facet.corners.reserve(core.first[best + 1] - core.first[best]);
    for (std::uint32_t i = core.first[best]; i < core.first[best + 1]; ++i)
        facet.corners.push_back({core.vertices[core.indices[i]], i - core.first[best]});
    set_face(facet, core.normals[best], Facet3::Form::face);
    // What lies within a hair's breadth of two sides may lie far from the tip of a needle, so of a narrow
    // face the width counts.
    Vec3 area{};
    for (std::size_t i = 2; i < facet.corners.size(); ++i) {
        area += cross(facet.corners[i - 1].position - facet.corners[0].position,
                      facet.corners[i].position - facet.corners[0].position);
    }
    facet.extent = std::min(facet.extent, length(area) / facet.extent);
}

/// The polygon of a disk. Its first corner is the one that lies furthest along `direction`, so that a tilted
/// disk touches with its true lowest point; a disk that lies flat keeps its corners where they are in the
/// body.
void disk_facet(const Shape<3>& shape, const Vec3& normal, const Vec3& direction, Facet3& facet) {
    // Cosines of the first quarter in steps of a sixteenth of π.
    constexpr std::array<double, disk_corners / 4 + 1> quarter{1,
                                                               0.98078528040323043,
                                                               0.92387953251128674,
                                                               0.83146961230254524,
                                                               0.70710678118654757,
                                                               0.55557023301960229,
                                                               0.38268343236508984,
                                                               0.19509032201612833,
                                                               0};
    constexpr double flat = 2e-5;
    const Vec3 slope = direction - dot(direction, normal) * normal;
    const bool tilted = length(slope) > flat;
    const Vec3 u = tilted ? normalized(slope) : any_perpendicular(shape.b);
    if (tilted) facet.id += 4;
    const Vec3 center = shape.a + shape.half_height * normal;
    facet.corners.clear();
    facet.corners.reserve(disk_corners);
    Vec3 x = shape.radius * u, y = shape.radius * cross(normal, u);
    for (std::uint32_t i = 0; i < disk_corners; ++i) {
        const std::uint32_t step = i % (disk_corners / 4);
        if (i > 0 && step == 0) std::tie(x, y) = std::pair{y, -x};
        facet.corners.push_back({center + quarter[step] * x + quarter[disk_corners / 4 - step] * y, i});
    }
    set_face(facet, normal, Facet3::Form::disk);
}

/// The unit vector across the axis of a cylinder or cone that looks most along `direction`.
Vec3 radial(const Shape<3>& shape, const Vec3& direction) {
    const Vec3 across = direction - dot(direction, shape.b) * shape.b;
    return length(across) > 1e-9 ? normalized(across) : any_perpendicular(shape.b);
}

void cylinder_facet(const Shape<3>& cylinder, const Vec3& direction, Facet3& facet) {
    constexpr double cosine_45 = 0.70710678118654752;
    const double along = dot(direction, cylinder.b);
    if (std::fabs(along) > cosine_45) {
        facet.id = along > 0 ? 0 : 1;
        return disk_facet(cylinder, along > 0 ? cylinder.b : -cylinder.b, direction, facet);
    }
    facet.id = 2;
    const Vec3 middle = cylinder.a + cylinder.radius * radial(cylinder, direction);
    const Vec3 half = cylinder.half_height * cylinder.b;
    set_edge(facet, middle - half, middle + half);
}

void cone_facet(const Shape<3>& cone, const Vec3& direction, Facet3& facet) {
    const Vec3 out = radial(cone, direction);
    const Vec3 side = normalized(cone.radius * cone.b + 2 * cone.half_height * out);
    const bool base = dot(direction, -cone.b) >= dot(direction, side);
    facet.id = base ? 0 : 1;
    if (base) return disk_facet(cone, -cone.b, direction, facet);
    const Vec3 half = cone.half_height * cone.b;
    set_edge(facet, cone.a - half + cone.radius * out, cone.a + half);
}

void plane_facet(const Shape<3>& plane, Facet3& facet) {
    facet.form = Facet3::Form::plane;
    facet.normal = plane.a;
    facet.offset = plane.offset;
    facet.extent = 1e300;
    facet.corners.clear();
}

}  // namespace

void find_facet(const Shape<3>& shape, const Vec3& direction, Facet3& facet) {
    facet.id = 0;
    switch (shape.kind) {
        case ShapeKind::ball:
            return;
        case ShapeKind::capsule:
            return set_edge(facet, shape.a, shape.b);
        case ShapeKind::box:
            return box_facet(shape, direction, facet);
        case ShapeKind::hull:
        case ShapeKind::facet:
            return hull_facet(shape, direction, facet);
        case ShapeKind::cylinder:
            return cylinder_facet(shape, direction, facet);
        case ShapeKind::cone:
            return cone_facet(shape, direction, facet);
        case ShapeKind::plane:
            return plane_facet(shape, facet);
        case ShapeKind::terrain:  // meets others facet by facet
            return;
    }
}

void move_facet(Facet3& facet, const Transform<3>& t) {
    for (FacetCorner& corner : facet.corners) corner.position = apply(t, corner.position);
    facet.normal = rotate(t.rotation, facet.normal);
    facet.offset += dot(facet.normal, t.position);
}

}  // namespace carom::detail
