#include "core/hash.hpp"

#include <concepts>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "world/state.hpp"

namespace carom {

using namespace detail;

namespace {

/// Folds any value of the engine into a hash: numbers, vectors, rotations, and what is made of them.
struct Folder {
    Hash hash;

    template <class T>
    requires std::integral<T> || std::is_enum_v<T>
    void operator()(T value) { hash.add(static_cast<std::uint64_t>(value)); }
    void operator()(double value) { hash.add(value); }
    void operator()(float value) { hash.add(value); }
    template <int D, class T>
    void operator()(const Vec<D, T>& v) {
        for (int i = 0; i < D; ++i) (*this)(v[i]);
    }
    void operator()(const Rotation2& q) { all(q.c, q.s); }
    void operator()(const Rotation3& q) { all(q.x, q.y, q.z, q.w); }
    void operator()(const Symmetric3<double>& m) { all(m.xx, m.yy, m.zz, m.xy, m.xz, m.yz); }
    template <int D>
    void operator()(const Transform<D>& t) {
        all(t.position, t.rotation);
    }
    template <class T>
    void operator()(const std::vector<T>& list) {
        (*this)(list.size());
        for (const T& item : list) (*this)(item);
    }
    template <class T>
    void operator()(const std::optional<T>& value) {
        (*this)(value.has_value());
        if (value) (*this)(*value);
    }
    template <class... Kinds>
    void operator()(const std::variant<Kinds...>& kind) {
        (*this)(kind.index());
        std::visit(*this, kind);
    }
    template <int D, class Tag>
    void operator()(const Id<D, Tag>& id) {
        all(id.index, id.generation);
    }

    void operator()(const Ball& s) { (*this)(s.radius); }
    template <int D>
    void operator()(const Box<D>& s) {
        all(s.size, s.rounding);
    }
    template <int D>
    void operator()(const Capsule<D>& s) {
        all(s.from, s.to, s.radius);
    }
    template <int D>
    void operator()(const Hull<D>& s) {
        all(s.points, s.rounding);
    }
    template <int D>
    void operator()(const Plane<D>& s) {
        all(s.normal, s.offset);
    }
    void operator()(const Cylinder& s) { all(s.radius, s.height); }
    void operator()(const Cone& s) { all(s.radius, s.height); }
    template <class T, std::size_t size>
    void operator()(const std::array<T, size>& list) {
        for (const T& item : list) (*this)(item);
    }
    void operator()(const Material& m) { all(m.density, m.friction, m.restitution, m.rolling_resistance); }
    void operator()(const Chain& s) { all(s.points, s.loop, s.two_sided, s.materials, s.material_of); }
    void operator()(const Mesh& s) { all(s.vertices, s.triangles, s.two_sided, s.materials, s.material_of); }
    template <int D>
    void operator()(const HeightField<D>& s) {
        all(s.heights, s.spacing, s.materials, s.material_of);
    }
    template <int D>
    void operator()(const ShapeDefinition<D>& s) {
        all(s.geometry, s.center, s.rotation, s.material, s.filter.category, s.filter.mask, s.filter.group,
            s.sensor, s.one_way, s.surface_velocity);
    }

    template <int D>
    void operator()(const ConstantForce<D>& f) {
        all(f.body, f.value, f.point, f.local);
    }
    template <int D>
    void operator()(const ConstantTorque<D>& f) {
        all(f.body, f.value);
    }
    template <int D>
    void operator()(const TimedImpulse<D>& f) {
        all(f.body, f.value, f.point, f.at);
    }
    template <int D>
    void operator()(const Drag<D>& f) {
        all(f.body, f.linear, f.quadratic);
    }
    template <int D>
    void operator()(const Wind<D>& f) {
        all(f.velocity, f.density);
    }
    template <int D>
    void operator()(const PointGravity<D>& f) {
        all(f.center, f.gm);
    }
    template <int D>
    void operator()(const Spring<D>& f) {
        all(f.a, f.b, f.anchor_a, f.anchor_b, f.stiffness, f.damping, f.length);
    }

    template <int D>
    void operator()(const Buoyancy<D>& f) {
        all(f.up, f.surface, f.density, f.linear_drag, f.quadratic_drag, f.flow);
    }

    template <int D>
    void operator()(const BodyState<D>& s) {
        all(s.position, s.rotation, s.velocity, s.angular_velocity, s.turns);
    }
    template <int D>
    void operator()(const BodyMass<D>& m) {
        all(m.mass, m.center, m.inertia, m.gravity_scale, m.linear_damping, m.angular_damping, m.locks.x,
            m.locks.y, m.locks.z, m.locks.rx, m.locks.ry, m.locks.rz);
    }
    template <int D>
    void operator()(const ContactRecord<D>& c) {
        all(c.shape_a, c.shape_b, c.facet, c.count, c.friction_impulse, c.spin_impulse, c.twist_impulse,
            c.touching, c.passing, c.merged, c.place.colour);
        if (c.place.colour == Colours::overflow) all(c.place.index);
        for (int i = 0; i < c.count; ++i) all(c.points[i].impulse, c.points[i].feature, c.points[i].arm_a);
    }
    template <int D>
    void operator()(const ContactCache<D>& c) {
        all(c.pose.position, c.pose.rotation, c.normal, c.gap, c.way, c.count);
        for (int i = 0; i < c.count; ++i) all(c.points[i].on_a, c.points[i].on_b, c.points[i].separation);
    }
    void operator()(const SpringSettings& s) { all(s.frequency, s.damping_ratio, s.rest, s.most); }
    void operator()(const DriveSettings& d) {
        all(d.measure, d.low, d.high, d.spring, d.motor_speed, d.motor_most, d.zero, d.coordinate, d.pawl,
            d.pitch);
    }
    template <int D>
    void operator()(const JointRecord<D>& j) {
        all(j.body_a, j.body_b, j.layout, j.anchor_a, j.anchor_b, j.frame_a, j.frame_b, j.drives,
            j.held.linear, j.held.angular, j.held.friction, j.wrench.force, j.wrench.on_a, j.wrench.on_b,
            j.before.force, j.before.on_a, j.before.on_b, j.kept, j.path.place, j.path.rounds, j.path.normal);
    }
    void operator()(const SensorPair& p) { all(p.sensor, p.visitor, p.inside, p.placed_anew); }
    template <int D>
    void operator()(const WorldDefinition<D>& w) {
        all(w.gravity, w.substeps, w.integrator, w.impacts, w.joints, w.sleep, w.continuous,
            w.restitution_threshold);
    }

    template <class... Parts>
    void all(const Parts&... parts) {
        ((*this)(parts), ...);
    }
};

}  // namespace

template <int D>
std::uint64_t World<D>::hash() const {
    const WorldState<D>& w = *state_;
    Folder fold;
    fold.all(w.definition, w.time, w.last_step, w.to_wake);
    for (const BodyId<D>& id : w.body_ids) {
        const BodyInfo<D>& info = w.infos[id.index];
        fold.all(id, w.types[id.index], w.states[id.index], w.masses[id.index], w.applied[id.index].force,
                 w.applied[id.index].torque);
        fold(info.seen().ignored);
        fold.all(info.awake, info.disabled, info.can_sleep, info.bullet, info.rest_time, info.rest);
        for (const ShapeId<D>& shape : info.shapes) fold.all(shape, w.shapes[shape.index].definition());
    }
    w.forces.each([&](const ForceDefinition<D>& force, bool fired) {
        fold.all(force.kind, force.from, force.to, fired);
    });
    for (const JointId<D>& id : w.joint_ids) {
        const JointDefinition<D>& joint = w.joint_definitions[id.index];
        JointRecord<D> record = w.joints[id.index];
        w.solver.read_joint(id.index, record);
        fold.all(id, record, joint.collide, joint.break_force, joint.break_torque);
    }
    for (const CouplingRecord<D>& c : w.couplings)
        fold.all(c.joint, c.ends[0], c.ends[1], c.factors, c.sum, c.is_rope, c.kept, c.before);
    ContactCache<D> cache;
    for (std::uint32_t i = 0; i < w.contacts.size(); ++i) fold.all(w.current(i, cache), cache);
    fold(w.sensor_pairs);
    return fold.hash.value();
}

template std::uint64_t World<2>::hash() const;
template std::uint64_t World<3>::hash() const;

}  // namespace carom
