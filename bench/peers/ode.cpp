#include <ode/ode.h>

#include <array>
#include <vector>

#include "engine.hpp"

namespace carom::peers {
namespace {

Vec3 vec(const dReal* v) { return {v[0], v[1], v[2]}; }
using Quaternion = std::array<dReal, 4>;
Quaternion to(const Rotation3& q) { return {q.w, q.x, q.y, q.z}; }
Rotation3 rotation(const dReal* q) { return normalized(Rotation3{q[1], q[2], q[3], q[0]}); }

/// The shortest rotation that takes z, its axis of round things, to `direction`, which has unit length.
Rotation3 from_z_to(const Vec3& direction) {
    const Vec3 z{0, 0, 1};
    if (dot(z, direction) < -0.999999) return {1, 0, 0, 0};
    const Vec3 axis = cross(z, direction);
    return normalized(Rotation3{axis.x, axis.y, axis.z, 1 + dot(z, direction)});
}

/// The library is set up once and left to the end of the program.
void set_up() {
    static const bool done = dInitODE2(0) != 0;
    if (!done) throw std::runtime_error("ODE cannot be set up");
}

class Ode final : public Engine<3> {
  public:
    explicit Ode(const WorldDefinition<3>& definition) : threshold_(definition.restitution_threshold) {
        set_up();
        world_ = dWorldCreate();
        space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
        contacts_ = dJointGroupCreate(0);
        set_gravity(definition.gravity);
        dWorldSetAutoDisableFlag(world_, definition.sleep);
    }
    Ode(const Ode&) = delete;
    Ode& operator=(const Ode&) = delete;
    ~Ode() override {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
        for (const dTriMeshDataID mesh : meshes_) dGeomTriMeshDataDestroy(mesh);
    }

    void set_gravity(const Vec3& gravity) override {
        dWorldSetGravity(world_, gravity.x, gravity.y, gravity.z);
    }

    void add_body(const BodyDefinition<3>& definition, const MassProperties<3>& mass) override {
        const Locks& locks = definition.locks;
        if (locks.x || locks.y || locks.z || locks.rx != locks.ry || locks.ry != locks.rz)
            throw Unsupported("locks of single directions");
        if (definition.gravity_scale != 1) throw Unsupported("a scale of gravity of one body");
        if (definition.type == BodyType::kinematic) throw Unsupported("kinematic bodies");
        Body body;
        body.start = {definition.position, definition.rotation};
        if (definition.type == BodyType::dynamic) {
            body.center = mass.center;
            body.id = dBodyCreate(world_);
            dMass masses;
            const Symmetric3<double>& i = mass.inertia;
            dMassSetParameters(&masses, mass.mass, 0, 0, 0, i.xx, i.yy, i.zz, i.xy, i.xz, i.yz);
            dBodySetMass(body.id, &masses);
            const Vec3 place = apply(body.start, body.center);
            dBodySetPosition(body.id, place.x, place.y, place.z);
            dBodySetQuaternion(body.id, to(definition.rotation).data());
            const Vec3 &v = definition.velocity, &w = definition.angular_velocity;
            dBodySetLinearVel(body.id, v.x, v.y, v.z);
            dBodySetAngularVel(body.id, w.x, w.y, w.z);
            if (!definition.can_sleep) dBodySetAutoDisableFlag(body.id, 0);
            if (locks.rx) dBodySetMaxAngularSpeed(body.id, 0);
            damp(body.id, definition);
        }
        for (const ShapeDefinition<3>& shape : definition.shapes) add_shape(body, shape);
        bodies_.push_back(body);
    }

    void add_joint(const JointDefinition<3>& definition, int a, int b) override {
        const dBodyID on_a = a < 0 ? nullptr : at(a).id, on_b = at(b).id;
        const auto attach = [&](dJointID joint) {
            dJointAttach(joint, on_b, on_a);
            return joint;
        };
        if (const auto* ball = std::get_if<BallJoint<3>>(&definition.kind);
            ball && !ball->spring && !ball->swing_limit && !ball->twist_limits) {
            dJointSetBallAnchor(attach(dJointCreateBall(world_, nullptr)), ball->anchor.x, ball->anchor.y,
                                ball->anchor.z);
            return;
        }
        if (const auto* hinge = std::get_if<HingeJoint<3>>(&definition.kind);
            hinge && !hinge->spring && !hinge->limits && !hinge->motor) {
            const dJointID joint = attach(dJointCreateHinge(world_, nullptr));
            dJointSetHingeAnchor(joint, hinge->anchor.x, hinge->anchor.y, hinge->anchor.z);
            dJointSetHingeAxis(joint, hinge->axis.x, hinge->axis.y, hinge->axis.z);
            return;
        }
        if (const auto* slider = std::get_if<SliderJoint<3>>(&definition.kind);
            slider && !slider->spring && !slider->limits && !slider->motor) {
            dJointSetSliderAxis(attach(dJointCreateSlider(world_, nullptr)), slider->axis.x, slider->axis.y,
                                slider->axis.z);
            return;
        }
        if (const auto* rod = std::get_if<DistanceJoint<3>>(&definition.kind);
            rod && !rod->limits && !rod->motor && !rod->spring && !rod->length && rod->anchor_a &&
            rod->anchor_b) {
            const dJointID joint = attach(dJointCreateDBall(world_, nullptr));
            dJointSetDBallAnchor1(joint, rod->anchor_b->x, rod->anchor_b->y, rod->anchor_b->z);
            dJointSetDBallAnchor2(joint, rod->anchor_a->x, rod->anchor_a->y, rod->anchor_a->z);
            return;
        }
        throw Unsupported("a joint of this kind");
    }

    void set_velocity(int body, const Vec3& velocity, const Vec3& spin) override {
        dBodySetLinearVel(at(body).id, velocity.x, velocity.y, velocity.z);
        dBodySetAngularVel(at(body).id, spin.x, spin.y, spin.z);
    }
    void apply_force(int body, const Vec3& force, const Vec3& torque) override {
        dBodyAddForce(at(body).id, force.x, force.y, force.z);
        dBodyAddTorque(at(body).id, torque.x, torque.y, torque.z);
    }
    void put_to_sleep(int body) override { dBodyDisable(at(body).id); }
    bool awake(int body) const override { return at(body).id && dBodyIsEnabled(at(body).id); }
    BodyState<3> state(int body) const override {
        const Body& b = at(body);
        if (!b.id) return {b.start, {}, {}};
        const Rotation3 turned = rotation(dBodyGetQuaternion(b.id));
        return {{vec(dBodyGetPosition(b.id)) - rotate(turned, b.center), turned},
                vec(dBodyGetLinearVel(b.id)),
                vec(dBodyGetAngularVel(b.id))};
    }
    void step(double dt) override {
        dSpaceCollide(space_, this, meet);
        dWorldQuickStep(world_, dt);
        dJointGroupEmpty(contacts_);
    }

  private:
    struct Body {
        dBodyID id = nullptr;  ///< none for what is fixed
        Vec3 center{};         ///< its origin in the frame of our body
        Transform3 start{};
    };
    const Body& at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

    /// Its damping takes a share of the velocity at each step; scenes damp at steps of 1/60 s.
    static void damp(dBodyID id, const BodyDefinition<3>& definition) {
        if (definition.linear_damping > 0) dBodySetLinearDamping(id, definition.linear_damping / 60);
        if (definition.angular_damping > 0) dBodySetAngularDamping(id, definition.angular_damping / 60);
        dBodySetLinearDampingThreshold(id, 0);
        dBodySetAngularDampingThreshold(id, 0);
    }

    void add_shape(const Body& body, const ShapeDefinition<3>& definition) {
        Transform3 placed{definition.center, definition.rotation};
        dGeomID geom = nullptr;
        if (const auto* plane = std::get_if<Plane<3>>(&definition.geometry)) {
            const Transform3 t = body.start * placed;
            const Vec3 normal = rotate(t.rotation, plane->normal / length(plane->normal));
            geom =
                dCreatePlane(space_, normal.x, normal.y, normal.z, plane->offset + dot(normal, t.position));
        } else {
            geom = make_geom(definition.geometry, placed);
            if (body.id) {
                dGeomSetBody(geom, body.id);
                const Vec3 p = placed.position - body.center;
                dGeomSetOffsetPosition(geom, p.x, p.y, p.z);
                dGeomSetOffsetQuaternion(geom, to(placed.rotation).data());
            } else {
                const Transform3 t = body.start * placed;
                dGeomSetPosition(geom, t.position.x, t.position.y, t.position.z);
                dGeomSetQuaternion(geom, to(t.rotation).data());
            }
        }
        dGeomSetCategoryBits(geom, definition.filter.category);
        dGeomSetCollideBits(geom, definition.filter.mask);
        // Its geometries carry a pointer of the user's: here the number of their material.
        materials_.push_back(definition.material);
        dGeomSetData(geom, reinterpret_cast<void*>(materials_.size() - 1));
    }

    dGeomID make_geom(const Geometry<3>& geometry, Transform3& placed) {
        if (const auto* ball = std::get_if<Ball>(&geometry)) return dCreateSphere(space_, ball->radius);
        if (const auto* box = std::get_if<Box<3>>(&geometry))
            return dCreateBox(space_, box->size.x, box->size.y, box->size.z);
        if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) {
            placed.rotation = placed.rotation * from_z_to({0, 1, 0});
            return dCreateCylinder(space_, cylinder->radius, cylinder->height);
        }
        if (const auto* capsule = std::get_if<Capsule<3>>(&geometry)) {
            const Vec3 way = capsule->to - capsule->from;
            const double extent = length(way);
            const Rotation3 turned = extent > 0 ? from_z_to(way / extent) : Rotation3{};
            placed = placed * Transform3{capsule->from + 0.5 * way, turned};
            return dCreateCapsule(space_, capsule->radius, extent);
        }
        if (const auto* mesh = std::get_if<Mesh>(&geometry)) {
            std::vector<double>& vertices = *vertices_.emplace_back(std::make_unique<std::vector<double>>());
            std::vector<dTriIndex>& corners =
                *corners_.emplace_back(std::make_unique<std::vector<dTriIndex>>());
            for (const Vec3& v : mesh->vertices) vertices.insert(vertices.end(), {v.x, v.y, v.z});
            for (const auto& t : mesh->triangles) corners.insert(corners.end(), t.begin(), t.end());
            const dTriMeshDataID data = meshes_.emplace_back(dGeomTriMeshDataCreate());
            dGeomTriMeshDataBuildDouble(data, vertices.data(), 3 * sizeof(double),
                                        static_cast<int>(mesh->vertices.size()), corners.data(),
                                        static_cast<int>(corners.size()), 3 * sizeof(dTriIndex));
            return dCreateTriMesh(space_, data, nullptr, nullptr, nullptr);
        }
        throw Unsupported("a shape of this kind");
    }

    const Material& material(dGeomID geom) const {
        return materials_[reinterpret_cast<std::size_t>(dGeomGetData(geom))];
    }

    /// Two geometries are near each other.
    static void meet(void* self, dGeomID a, dGeomID b) { static_cast<Ode*>(self)->meet(a, b); }
    void meet(dGeomID a, dGeomID b) {
        const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
        if ((!body_a && !body_b) || body_a == body_b) return;
        if (body_a && body_b && dAreConnectedExcluding(body_a, body_b, dJointTypeContact)) return;
        constexpr int most = 8;
        std::array<dContact, most> points{};
        const int count = dCollide(a, b, most, &points[0].geom, sizeof(dContact));
        const Material &on_a = material(a), &on_b = material(b);
        const double restitution = shared_restitution(on_a.restitution, on_b.restitution);
        for (int i = 0; i < count; ++i) {
            dContact& point = points[static_cast<std::size_t>(i)];
            // Friction in proportion to the normal force, as its manual advises.
            point.surface.mode = dContactApprox1 | (restitution > 0 ? dContactBounce : 0);
            point.surface.mu = shared_friction(on_a.friction, on_b.friction);
            point.surface.bounce = restitution;
            point.surface.bounce_vel = threshold_;
            dJointAttach(dJointCreateContact(world_, contacts_, &point), body_a, body_b);
        }
    }

    double threshold_;
    dWorldID world_;
    dSpaceID space_;
    dJointGroupID contacts_;
    std::vector<dTriMeshDataID> meshes_;
    std::vector<std::unique_ptr<std::vector<double>>> vertices_;
    std::vector<std::unique_ptr<std::vector<dTriIndex>>> corners_;
    std::vector<Material> materials_;
    std::vector<Body> bodies_;
};

}  // namespace

std::unique_ptr<Engine<3>> make_ode(const WorldDefinition<3>& definition) {
    return std::make_unique<Ode>(definition);
}

}  // namespace carom::peers
