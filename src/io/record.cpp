#include "io/record.hpp"

#include "io/record_links.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/shape.hpp"

namespace carom::io {
namespace {

ReplayVector vector_of(const Vec2& v) { return {v.x, v.y, 0}; }
ReplayVector vector_of(const Vec3& v) { return {v.x, v.y, v.z}; }

ReplayRotation rotation_of(const Rotation2& q) { return replay_rotation(q.angle()); }
ReplayRotation rotation_of(const Rotation3& q) { return {q.x, q.y, q.z, q.w}; }

std::array<float, 3> turning_of(double w) { return {0, 0, static_cast<float>(w)}; }
std::array<float, 3> turning_of(const Vec3& w) {
    return {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
}

std::array<double, 6> inertia_of(double i) { return {0, 0, i, 0, 0, 0}; }
std::array<double, 6> inertia_of(const Symmetric3<double>& i) { return {i.xx, i.yy, i.zz, i.xy, i.xz, i.yz}; }

template <std::size_t count>
std::array<float, count> narrowed(const std::array<double, count>& values) {
    std::array<float, count> result;
    std::transform(values.begin(), values.end(), result.begin(),
                   [](double v) { return static_cast<float>(v); });
    return result;
}

template <class Point>
std::vector<ReplayVector> points_of(const std::vector<Point>& points) {
    std::vector<ReplayVector> result;
    for (const Point& point : points) result.push_back(vector_of(point));
    return result;
}

ReplayHull hull_of(const Hull2& hull) {
    return {points_of(detail::convex_polygon(hull.points).vertices), {}, hull.rounding};
}

ReplayHull hull_of(const Hull3& hull) {
    const detail::Polyhedron core = detail::convex_polyhedron(hull.points);
    ReplayHull result{points_of(core.vertices), {}, hull.rounding};
    for (std::size_t face = 0; face + 1 < core.first.size(); ++face)
        result.faces.emplace_back(core.indices.begin() + core.first[face],
                                  core.indices.begin() + core.first[face + 1]);
    return result;
}

ReplayGround ground_of(const Chain& chain) {
    ReplayGround ground{points_of(chain.points), {}, chain.two_sided};
    const auto count = static_cast<std::uint32_t>(chain.points.size());
    for (std::uint32_t i = 0; i + (chain.loop ? 0 : 1) < count; ++i)
        ground.facets.push_back({i, (i + 1) % count});
    return ground;
}

ReplayGround ground_of(const Mesh& mesh) {
    ReplayGround ground{points_of(mesh.vertices), {}, mesh.two_sided};
    for (const auto& triangle : mesh.triangles) ground.facets.emplace_back(triangle.begin(), triangle.end());
    return ground;
}

/// Adds the facet unless it ends in a hole.
void add_facet(ReplayGround& ground, std::vector<std::uint32_t> corners) {
    for (const std::uint32_t corner : corners)
        if (std::isnan(ground.points[corner][1])) return;
    ground.facets.push_back(std::move(corners));
}

/// What stands for a hole lies at the height of another point, so that it does not widen the view.
ReplayGround filled(ReplayGround ground) {
    double height = 0;
    for (const ReplayVector& point : ground.points)
        if (!std::isnan(point[1])) height = point[1];
    for (ReplayVector& point : ground.points)
        if (std::isnan(point[1])) point[1] = height;
    return ground;
}

ReplayGround ground_of(const HeightField2& field) {
    ReplayGround ground;
    for (std::size_t i = 0; i < field.heights.size(); ++i)
        ground.points.push_back({static_cast<double>(i) * field.spacing[0], field.heights[i], 0});
    for (std::uint32_t i = 0; i + 1 < field.heights.size(); ++i) add_facet(ground, {i, i + 1});
    return filled(std::move(ground));
}

ReplayGround ground_of(const HeightField3& field) {
    ReplayGround ground;
    const auto columns = static_cast<std::uint32_t>(field.heights[0].size());
    for (std::size_t row = 0; row < field.heights.size(); ++row) {
        for (std::size_t column = 0; column < columns; ++column)
            ground.points.push_back({static_cast<double>(column) * field.spacing[0],
                                     field.heights[row][column],
                                     static_cast<double>(row) * field.spacing[1]});
    }
    for (std::uint32_t row = 0; row + 1 < field.heights.size(); ++row) {
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
            const std::uint32_t here = row * columns + column, below = here + columns;
            add_facet(ground, {here, below, below + 1});
            add_facet(ground, {here, below + 1, here + 1});
        }
    }
    return filled(std::move(ground));
}

template <int D>
struct GeometryOf {
    ReplayGeometry operator()(const Ball& ball) const { return ReplayBall{ball.radius}; }
    ReplayGeometry operator()(const Box<D>& box) const {
        return ReplayBox{vector_of(box.size), box.rounding};
    }
    ReplayGeometry operator()(const Capsule<D>& capsule) const {
        return ReplayCapsule{vector_of(capsule.from), vector_of(capsule.to), capsule.radius};
    }
    ReplayGeometry operator()(const Hull<D>& hull) const { return hull_of(hull); }
    ReplayGeometry operator()(const Plane<D>& plane) const {
        return ReplayPlane{vector_of(normalized(plane.normal)), plane.offset};
    }
    ReplayGeometry operator()(const Cylinder& cylinder) const {
        return ReplayCylinder{cylinder.radius, cylinder.height};
    }
    ReplayGeometry operator()(const Cone& cone) const { return ReplayCone{cone.radius, cone.height}; }
    template <class Ground>
    ReplayGeometry operator()(const Ground& ground) const {
        return ground_of(ground);
    }
};

ReplayBodyType type_of(BodyType type) {
    switch (type) {
        case BodyType::fixed:
            return ReplayBodyType::fixed;
        case BodyType::kinematic:
            return ReplayBodyType::kinematic;
        case BodyType::dynamic:
            break;
    }
    return ReplayBodyType::dynamic;
}

template <int D>
ReplayBody body_of(const World<D>& world, BodyId<D> id, const std::string& label,
                   const std::vector<std::string>& materials) {
    const MassProperties<D> mass = world.mass_properties(id);
    ReplayBody body{
        label, type_of(world.type(id)), mass.mass, inertia_of(mass.inertia), vector_of(mass.center), {}};
    std::size_t next = 0;
    for (const ShapeId<D> shape : world.shapes(id)) {
        const ShapeDefinition<D>& definition = world.shape(shape);
        ReplayShape& drawn = body.shapes.emplace_back();
        drawn.geometry = std::visit(GeometryOf<D>{}, definition.geometry);
        drawn.center = vector_of(definition.center);
        drawn.rotation = rotation_of(definition.rotation);
        drawn.material = materials[next++];
        drawn.sensor = definition.sensor;
        if (definition.one_way) drawn.one_way = vector_of(*definition.one_way);
        drawn.surface_velocity = vector_of(definition.surface_velocity);
    }
    return body;
}

/// The springs that act for the whole run, a replay's links being there from its first frame to its last. The
/// bodies that they join are indices already.
template <int D>
std::vector<ReplayLink> links_of(const SceneData<D>& data) {
    std::vector<ReplayLink> links;
    for (const ForceDefinition<D>& force : data.forces) {
        const auto* spring = std::get_if<Spring<D>>(&force.kind);
        if (!spring || force.from > 0 || force.to < std::numeric_limits<double>::infinity()) continue;
        links.push_back({"spring", spring->a ? static_cast<std::int32_t>(spring->a->index) : -1,
                         static_cast<std::int32_t>(spring->b.index), vector_of(spring->anchor_a),
                         vector_of(spring->anchor_b)});
    }
    return links;
}

}  // namespace

template <int D>
Recorder<D>::Recorder(const Scene& scene, const SceneWorld<D>& built) : bodies_(built.bodies) {
    const auto& data = std::get<SceneData<D>>(scene.data);
    replay_.dimension = D;
    replay_.name = scene.name;
    replay_.step = scene.step;
    replay_.gravity = vector_of(data.world.gravity);
    replay_.links = links_of(data);
    const std::vector<ReplayLink> of_joints = joint_links(built);
    replay_.links.insert(replay_.links.end(), of_joints.begin(), of_joints.end());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyId<D> id = bodies_[i];
        replay_.bodies.push_back(
            body_of(built.world, id, body_label(built.world.name(id), i), data.materials[i]));
        auto& sensors = sensors_.emplace_back();
        for (const ShapeId<D> shape : built.world.shapes(id))
            if (built.world.shape(shape).sensor) sensors.push_back(shape);
        if (id.index >= index_of_.size()) index_of_.resize(id.index + 1, -1);
        index_of_[id.index] = static_cast<std::int32_t>(i);
    }
}

template <int D>
void Recorder<D>::record_frame(const World<D>& world) {
    ReplayFrame& frame = replay_.frames.emplace_back();
    const Energy energy = world.energy();
    frame.kinetic = energy.kinetic;
    frame.potential = energy.potential;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyId<D> body = bodies_[i];
        const bool sensing = std::ranges::any_of(
            sensors_[i], [&](const ShapeId<D> sensor) { return !world.inside(sensor).empty(); });
        frame.states.push_back(
            {vector_of(world.center_of_mass(body)), narrowed(rotation_of(world.rotation(body))),
             narrowed(vector_of(world.velocity(body))), turning_of(world.angular_velocity(body)), true,
             world.awake(body), false, sensing});
    }
    for (const Contact<D>& contact : world.contacts())
        for (int i = 0; i < contact.count; ++i) {
            const ContactPoint<D>& point = contact.points[static_cast<std::size_t>(i)];
            // A point that bears nothing and is apart is a contact to come; there is nothing to see yet.
            if (point.impulse == 0 && point.separation > 0) continue;
            frame.contacts.push_back({index_of_[contact.body_a.index], index_of_[contact.body_b.index],
                                      vector_of(point.position), narrowed(vector_of(contact.normal)),
                                      static_cast<float>(point.impulse)});
        }
}

template class Recorder<2>;
template class Recorder<3>;

}  // namespace carom::io
