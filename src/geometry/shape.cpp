#include "geometry/shape.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "geometry/hull.hpp"
#include "geometry/terrain.hpp"
#include "geometry/turned_box.hpp"
#include "math/check.hpp"

namespace carom::detail {
namespace {

/// A rounded box keeps a core of at least this share of its size, so that opposite faces stay two.
constexpr double thinnest_core = 1e-3;

constexpr double fastest_surface = 1e6;  // m/s

void require_length(double value, std::string_view field) {
    require_positive(value, field);
    require_in(value, shortest_length, longest_length, field);
}

template <int D>
void require_place(const Vec<D>& value, std::string_view field) {
    require_in(value, -longest_length, longest_length, field);
}

template <int D>
Vec<D> unit(int axis) {
    Vec<D> e{};
    e[axis] = 1;
    return e;
}

Polygon box_core(const Transform2& placed, const Vec2& half) {
    Polygon polygon;
    for (const Vec2& corner :
         {Vec2{-half.x, -half.y}, {half.x, -half.y}, {half.x, half.y}, {-half.x, half.y}}) {
        polygon.vertices.push_back(apply(placed, corner));
    }
    for (const Vec2& normal : {Vec2{0, -1}, {1, 0}, {0, 1}, {-1, 0}}) {
        polygon.normals.push_back(rotate(placed.rotation, normal));
    }
    return polygon;
}

/// What all boxes have in common: which corners make which faces and edges.
const Polyhedron& any_box() {
    static const Polyhedron common = [] {
        Polyhedron box;
        // Faces −x, +x, −y, +y, −z, +z.
        box.indices = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
        box.first = {0, 4, 8, 12, 16, 20, 24};
        connect(box);
        return box;
    }();
    return common;
}

Polyhedron box_core(const Transform3& placed, const Vec3& half) {
    Polyhedron box = any_box();
    box.vertices.reserve(8);
    box.normals.reserve(6);
    box.offsets.reserve(6);
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner{i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z};
        box.vertices.push_back(apply(placed, corner));
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const Vec3 normal = rotate(placed.rotation, side * unit<3>(axis));
            box.normals.push_back(normal);
            box.offsets.push_back(dot(normal, placed.position) + half[axis]);
        }
    }
    measure(box);
    return box;
}

/// Worlds are full of equal shapes, mostly added one after the other: those share what they are made of, as
/// long as one of them exists, and keep it in the cache. `points` and `placed` say what `make` makes.
template <int D, class Make>
std::shared_ptr<const Polytope<D>> shared_core(std::span<const Vec<D>> points, const Transform<D>& placed,
                                               const Make& make) {
    struct Recent {
        std::vector<Vec<D>> points;
        Transform<D> placed;
        std::weak_ptr<const Polytope<D>> core;
    };
    thread_local std::array<Recent, 8> recent;
    thread_local std::size_t oldest = 0;
    const auto same_bits = [](const auto& a, const auto& b) {
        return std::ranges::equal(std::as_bytes(a), std::as_bytes(b));
    };
    for (const Recent& r : recent) {
        if (!same_bits(std::span(r.points), points) ||
            !same_bits(std::span(&r.placed, 1), std::span(&placed, 1)))
            continue;
        if (auto core = r.core.lock()) return core;
    }
    const auto core = std::make_shared<const Polytope<D>>(make());
    recent[oldest] = {{points.begin(), points.end()}, placed, core};
    oldest = (oldest + 1) % recent.size();
    return core;
}

template <int D>
void fill(Shape<D>& shape, const Ball& ball, const Transform<D>& placed) {
    require_length(ball.radius, "radius");
    shape.kind = ShapeKind::ball;
    shape.radius = ball.radius;
    shape.a = placed.position;
}

template <int D>
void fill(Shape<D>& shape, const Capsule<D>& capsule, const Transform<D>& placed) {
    require_place(capsule.from, "from");
    require_place(capsule.to, "to");
    require_length(capsule.radius, "radius");
    shape.kind = ShapeKind::capsule;
    shape.radius = capsule.radius;
    shape.a = apply(placed, capsule.from);
    shape.b = apply(placed, capsule.to);
}

template <int D>
void fill(Shape<D>& shape, const Box<D>& box, const Transform<D>& placed) {
    double smallest = longest_length;
    for (int i = 0; i < D; ++i) {
        require_length(box.size[i], component("size", i));
        smallest = std::min(smallest, box.size[i]);
    }
    require_not_negative(box.rounding, "rounding");
    if (box.rounding > 0.5 * smallest) {
        refuse("rounding", box.rounding, "is more than half of the smallest length, " + to_text(smallest));
    }
    shape.kind = ShapeKind::box;
    shape.radius = std::min(box.rounding, 0.5 * (1 - thinnest_core) * smallest);
    shape.a = placed.position;
    for (int i = 0; i < D; ++i) shape.b[i] = 0.5 * box.size[i] - shape.radius;
    shape.rotation = placed.rotation;
    shape.core = shared_core<D>(std::span(&shape.b, 1), placed, [&] { return box_core(placed, shape.b); });
}

template <int D>
Polytope<D> hull_core(const std::vector<Vec<D>>& points, const Transform<D>& placed) {
    Polytope<D> core;
    if constexpr (D == 2) {
        core = convex_polygon(points);
    } else {
        core = convex_polyhedron(points);
        for (std::size_t i = 0; i < core.normals.size(); ++i)
            core.offsets[i] += dot(rotate(placed.rotation, core.normals[i]), placed.position);
    }
    for (Vec<D>& normal : core.normals) normal = rotate(placed.rotation, normal);
    for (Vec<D>& vertex : core.vertices) vertex = apply(placed, vertex);
    if constexpr (D == 3) {
        measure(core);
        core.corners = Columns(core.vertices);
        core.faces = Columns(core.normals);
    }
    return core;
}

template <int D>
void fill(Shape<D>& shape, const Hull<D>& hull, const Transform<D>& placed) {
    require_not_negative(hull.rounding, "rounding");
    require_in(hull.rounding, 0, longest_length, "rounding");
    shape.kind = ShapeKind::hull;
    shape.radius = hull.rounding;
    shape.core =
        shared_core<D>(std::span(hull.points), placed, [&] { return hull_core<D>(hull.points, placed); });
}

template <int D>
void fill(Shape<D>& shape, const Plane<D>& plane, const Transform<D>& placed) {
    require_place(plane.normal, "normal");
    require_in(plane.offset, -longest_length, longest_length, "offset");
    double largest = 0;
    for (int i = 0; i < D; ++i) largest = std::max(largest, std::fabs(plane.normal[i]));
    if (!(largest > 0)) throw Error("normal: all components are zero");
    shape.kind = ShapeKind::plane;
    shape.a = rotate(placed.rotation, normalized(plane.normal / largest));
    shape.offset = plane.offset + dot(shape.a, placed.position);
}

/// Cylinder and cone stand along the y axis.
template <class Round>
void fill_round(Shape<3>& shape, ShapeKind kind, const Round& round, const Transform3& placed) {
    require_length(round.radius, "radius");
    require_length(round.height, "height");
    shape.kind = kind;
    shape.radius = round.radius;
    shape.half_height = 0.5 * round.height;
    shape.a = placed.position;
    shape.b = rotate(placed.rotation, Vec3{0, 1, 0});
}
void fill(Shape<3>& shape, const Cylinder& cylinder, const Transform3& placed) {
    fill_round(shape, ShapeKind::cylinder, cylinder, placed);
}
void fill(Shape<3>& shape, const Cone& cone, const Transform3& placed) {
    fill_round(shape, ShapeKind::cone, cone, placed);
}

template <int D>
std::size_t furthest_of(const std::vector<Vec<D>>& points, const Vec<D>& direction) {
    std::size_t best = 0;
    double furthest = dot(points[0], direction);
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double distance = dot(points[i], direction);
        if (distance > furthest) {
            furthest = distance;
            best = i;
        }
    }
    return best;
}

/// The least and the greatest product of a corner with the axis.
template <int D>
std::array<double, 2> range_of(const Polytope<D>& core, const Vec<D>& axis) {
    if constexpr (D == 3)
        if (!core.corners.empty()) return core.corners.range(axis);
    double lowest = 1e300, highest = -1e300;
    for (const Vec<D>& vertex : core.vertices) {
        const double distance = dot(axis, vertex);
        lowest = std::min(lowest, distance);
        highest = std::max(highest, distance);
    }
    return {lowest, highest};
}

Vec3 round_support(const Shape<3>& shape, const Vec3& direction) {
    const double along = dot(direction, shape.b);
    // Taken twice: near the axis, rounding of the first difference may leave more along it than across it.
    Vec3 outward = direction - along * shape.b;
    outward -= dot(outward, shape.b) * shape.b;
    const double outward_length = length(outward);
    const Vec3 rim = outward_length > 0 ? outward * (shape.radius / outward_length) : Vec3{};
    const Vec3 up = shape.half_height * shape.b;
    if (shape.kind == ShapeKind::cylinder) return shape.a + (along < 0 ? rim - up : rim + up);
    // A cone: the tip, or the rim of its base.
    const bool tip = 2 * shape.half_height * along > shape.radius * outward_length;
    return shape.a + (tip ? up : rim - up);
}

/// How far the shape reaches along the unit vector of an axis and against it, in the body's frame.
template <int D>
std::array<double, 2> reach(const Shape<D>& shape, const Vec<D>& axis) {
    switch (shape.kind) {
        case ShapeKind::ball: {
            const double middle = dot(axis, shape.a);
            return {middle - shape.radius, middle + shape.radius};
        }
        case ShapeKind::capsule: {
            const double a = dot(axis, shape.a), b = dot(axis, shape.b);
            return {std::min(a, b) - shape.radius, std::max(a, b) + shape.radius};
        }
        case ShapeKind::hull:
        case ShapeKind::facet: {
            const auto [lowest, highest] = range_of<D>(*shape.core, axis);
            return {lowest - shape.radius, highest + shape.radius};
        }
        case ShapeKind::terrain: {
            // The box that it has, seen from another frame.
            const Aabb<D>& box = shape.terrain->bounds();
            double lowest = 0, highest = 0;
            for (int i = 0; i < D; ++i) {
                lowest += axis[i] * (axis[i] < 0 ? box.upper[i] : box.lower[i]);
                highest += axis[i] * (axis[i] < 0 ? box.lower[i] : box.upper[i]);
            }
            return {lowest, highest};
        }
        case ShapeKind::plane: {
            // Finite only across the plane: n · x ≤ offset.
            const double across = dot(axis, shape.a);
            return {across == -1 ? -shape.offset : -1e300, across == 1 ? shape.offset : 1e300};
        }
        case ShapeKind::box:  // see `bounds`
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            break;
    }
    if constexpr (D == 3) {
        // A disk about the unit axis b with radius r reaches r √(1 − (axis · b)²) from its centre.
        const double middle = dot(axis, shape.a), along = dot(axis, shape.b);
        const double rim = shape.radius * std::sqrt(std::max(0.0, 1 - along * along));
        const double top = middle + along * shape.half_height, bottom = middle - along * shape.half_height;
        const double top_rim = shape.kind == ShapeKind::cone ? 0 : rim;
        return {std::min(top - top_rim, bottom - rim), std::max(top + top_rim, bottom + rim)};
    }
    return {};
}

}  // namespace

void check_material(const Material& material) {
    require_not_negative(material.density, "density");
    require_not_negative(material.friction, "friction");
    require_in(material.restitution, 0, 1, "restitution");
    require_not_negative(material.rolling_resistance, "rolling_resistance");
}

template <int D>
Shape<D> make_shape(const ShapeDefinition<D>& definition, Scheduler* scheduler) {
    check_material(definition.material);
    require_place(definition.center, "center");
    require_unit(definition.rotation, "rotation");
    require_in(definition.surface_velocity, -fastest_surface, fastest_surface, "surface_velocity");
    if (definition.one_way) {
        require_place(*definition.one_way, "one_way");
        if (length(*definition.one_way) < shortest_length) throw Error("one_way: a direction has a length");
    }
    const Transform<D> placed{definition.center, normalized(definition.rotation)};
    Shape<D> shape;
    std::visit(
        [&]<class Kind>(const Kind& geometry) {
            if constexpr (is_terrain_type<Kind>) {
                shape.kind = ShapeKind::terrain;
                shape.terrain = std::make_shared<const Terrain<D>>(geometry, placed, scheduler);
            } else {
                fill(shape, geometry, placed);
            }
        },
        definition.geometry);
    return shape;
}

template <int D>
Aabb<D> bounds(const Shape<D>& shape, const Transform<D>& placed) {
    if (shape.kind == ShapeKind::box) {
        const Vec<D> middle = apply(placed, shape.a);
        Vec<D> half = reach_of(placed.rotation * shape.rotation, shape.b);
        for (int i = 0; i < D; ++i) half[i] += shape.radius;
        return {middle - half, middle + half};
    }
    Aabb<D> box;
    for (int i = 0; i < D; ++i) {
        const auto [lowest, highest] = reach(shape, unrotate(placed.rotation, unit<D>(i)));
        box.lower[i] = placed.position[i] + lowest;
        box.upper[i] = placed.position[i] + highest;
    }
    return box;
}

template <int D>
Vec<D> core_support(const Shape<D>& shape, const Vec<D>& direction) {
    switch (shape.kind) {
        case ShapeKind::ball:
            return shape.a;
        case ShapeKind::capsule:
            return dot(shape.b - shape.a, direction) > 0 ? shape.b : shape.a;
        case ShapeKind::hull:
        case ShapeKind::facet:
            return shape.core->vertices[furthest_corner(*shape.core, direction)];
        case ShapeKind::box: {
            const Vec<D> local = unrotate(shape.rotation, direction);
            Vec<D> corner = shape.b;
            for (int i = 0; i < D; ++i) corner[i] = local[i] < 0 ? -corner[i] : corner[i];
            return shape.a + rotate(shape.rotation, corner);
        }
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            if constexpr (D == 3) return round_support(shape, direction);
            break;
        case ShapeKind::plane:
        case ShapeKind::terrain:
            break;
    }
    return {};
}

std::size_t furthest_corner(const Polygon& core, const Vec2& direction) {
    return furthest_of<2>(core.vertices, direction);
}
std::size_t furthest_corner(const Polyhedron& core, const Vec3& direction) {
    return core.corners.empty() ? furthest_of<3>(core.vertices, direction) : core.corners.furthest(direction);
}

template <int D>
Vec<D> middle_of(const Shape<D>& convex) {
    if (convex.kind == ShapeKind::capsule) return 0.5 * (convex.a + convex.b);
    if (convex.kind != ShapeKind::hull) return convex.a;
    Vec<D> sum{};
    for (const Vec<D>& corner : convex.core->vertices) sum += corner;
    return sum / double(convex.core->vertices.size());
}

template <int D>
Shape<D> inner_ball(const Shape<D>& convex) {
    Shape<D> ball;
    ball.a = middle_of(convex);
    ball.radius = convex.radius;
    if (convex.kind == ShapeKind::box) {
        double smallest = convex.b.x;
        for (int i = 1; i < D; ++i) smallest = std::min(smallest, convex.b[i]);
        ball.radius += smallest;
    } else if (convex.kind == ShapeKind::hull) {
        double least = longest_length;
        for (std::size_t i = 0; i < convex.core->normals.size(); ++i) {
            const Vec<D>& normal = convex.core->normals[i];
            double offset;
            if constexpr (D == 2)
                offset = dot(normal, convex.core->vertices[i]);
            else
                offset = convex.core->offsets[i];
            least = std::min(least, offset - dot(normal, ball.a));
        }
        ball.radius += least;
    } else if (convex.kind == ShapeKind::cylinder) {
        ball.radius = std::min(convex.radius, convex.half_height);
    } else if (convex.kind == ShapeKind::cone) {
        // The centre of mass lies a quarter up the axis, where the radius is three quarters of the base's;
        // the side is nearer than that by its slope.
        const double height = 2 * convex.half_height;
        const double slope = height / std::sqrt(height * height + convex.radius * convex.radius);
        ball.a -= 0.25 * height * convex.b;
        ball.radius = std::min(0.25 * height, 0.75 * convex.radius * slope);
    }
    return ball;
}

template <int D>
std::optional<FacePlane<D>> facing_plane(const Shape<D>& shape, const Vec<D>& direction) {
    constexpr double facing_cosine = 0.999;
    FacePlane<D> best;
    double most = facing_cosine;
    const auto offer = [&](const Vec<D>& normal, double offset) {
        const double cosine = dot(normal, direction);
        if (cosine <= most) return;
        most = cosine;
        best = {normal, offset};
    };
    if (shape.kind == ShapeKind::plane) offer(shape.a, shape.offset);
    if constexpr (D == 3) {
        if (shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone) {
            offer(-shape.b, shape.half_height - dot(shape.b, shape.a));
            if (shape.kind == ShapeKind::cylinder) offer(shape.b, shape.half_height + dot(shape.b, shape.a));
        }
    }
    if (shape.core) {
        for (std::size_t i = 0; i < shape.core->normals.size(); ++i) {
            const Vec<D>& normal = shape.core->normals[i];
            if constexpr (D == 2)
                offer(normal, dot(normal, shape.core->vertices[i]) + shape.radius);
            else
                offer(normal, shape.core->offsets[i] + shape.radius);
        }
    }
    return most > facing_cosine ? std::optional(best) : std::nullopt;
}

template Shape<2> make_shape(const ShapeDefinition<2>&, Scheduler*);
template Shape<3> make_shape(const ShapeDefinition<3>&, Scheduler*);
template Vec<2> middle_of(const Shape<2>&);
template Vec<3> middle_of(const Shape<3>&);
template Shape<2> inner_ball(const Shape<2>&);
template Shape<3> inner_ball(const Shape<3>&);
template std::optional<FacePlane<2>> facing_plane(const Shape<2>&, const Vec<2>&);
template std::optional<FacePlane<3>> facing_plane(const Shape<3>&, const Vec<3>&);
template Aabb<2> bounds(const Shape<2>&, const Transform<2>&);
template Aabb<3> bounds(const Shape<3>&, const Transform<3>&);
template Vec<2> core_support(const Shape<2>&, const Vec<2>&);
template Vec<3> core_support(const Shape<3>&, const Vec<3>&);

}  // namespace carom::detail
