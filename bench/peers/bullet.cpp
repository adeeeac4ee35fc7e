#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <vector>

#include "engine.hpp"

namespace carom::peers {
namespace {

btScalar single(double x) { return static_cast<btScalar>(x); }
btVector3 to(const Vec3& v) { return {single(v.x), single(v.y), single(v.z)}; }
Vec3 from(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
btQuaternion to(const Rotation3& q) { return {single(q.x), single(q.y), single(q.z), single(q.w)}; }
Rotation3 from(const btQuaternion& q) { return normalized(Rotation3{q.x(), q.y(), q.z(), q.w()}); }
btTransform to(const Transform3& t) { return btTransform(to(t.rotation), to(t.position)); }

btScalar friction_of_pair(const btCollisionObject* a, const btCollisionObject* b) {
    return single(shared_friction(a->getFriction(), b->getFriction()));
}
btScalar restitution_of_pair(const btCollisionObject* a, const btCollisionObject* b) {
    return single(shared_restitution(a->getRestitution(), b->getRestitution()));
}

/// The shortest rotation that takes y to `direction`, which has unit length.
Rotation3 from_y_to(const Vec3& direction) {
    const Vec3 y{0, 1, 0};
    if (dot(y, direction) < -0.999999) return {1, 0, 0, 0};
    const Vec3 axis = cross(y, direction);
    return normalized(Rotation3{axis.x, axis.y, axis.z, 1 + dot(y, direction)});
}

class Bullet final : public Engine<3> {
  public:
    explicit Bullet(const WorldDefinition<3>& definition) : sleeps_(definition.sleep) {
        world_.setGravity(to(definition.gravity));
        world_.getSolverInfo().m_restitutionVelocityThreshold = single(definition.restitution_threshold);
        gCalculateCombinedFrictionCallback = friction_of_pair;
        gCalculateCombinedRestitutionCallback = restitution_of_pair;
    }
    ~Bullet() override {
        for (const auto& joint : joints_) world_.removeConstraint(joint.get());
        for (const Body& body : bodies_) world_.removeRigidBody(body.rigid.get());
    }

    void set_gravity(const Vec3& gravity) override {
        world_.setGravity(to(gravity));
        for (const Body& body : bodies_) body.rigid->setGravity(to(gravity));
    }

    void add_body(const BodyDefinition<3>& definition, const MassProperties<3>& mass) override {
        const bool moves = definition.type == BodyType::dynamic;
        Body body;
        body.center = moves ? mass.center : Vec3{};
        btCollisionShape* shape = make_shape(definition, body.center);
        btVector3 inertia{0, 0, 0};
        if (moves) {
            const Symmetric3<double>& i = mass.inertia;
            if (std::fabs(i.xy) + std::fabs(i.xz) + std::fabs(i.yz) > 1e-6 * (i.xx + i.yy + i.zz))
                throw Unsupported("an inertia that is not along the axes of the body");
            inertia = to(Vec3{i.xx, i.yy, i.zz});
        }
        btRigidBody::btRigidBodyConstructionInfo info(moves ? single(mass.mass) : 0, nullptr, shape, inertia);
        const Transform3 frame{definition.position, definition.rotation};
        info.m_startWorldTransform = to(Transform3{apply(frame, body.center), definition.rotation});
        info.m_linearDamping = single(definition.linear_damping);
        info.m_angularDamping = single(definition.angular_damping);
        if (!definition.shapes.empty()) {
            info.m_friction = single(definition.shapes.front().material.friction);
            info.m_restitution = single(definition.shapes.front().material.restitution);
        }
        body.rigid = std::make_unique<btRigidBody>(info);
        const Locks& locks = definition.locks;
        body.rigid->setLinearFactor({locks.x ? 0.0f : 1, locks.y ? 0.0f : 1, locks.z ? 0.0f : 1});
        body.rigid->setAngularFactor({locks.rx ? 0.0f : 1, locks.ry ? 0.0f : 1, locks.rz ? 0.0f : 1});
        if (definition.type == BodyType::kinematic)
            throw Unsupported("kinematic bodies, which it asks to be placed at each step");
        body.rigid->setLinearVelocity(to(definition.velocity));
        body.rigid->setAngularVelocity(to(definition.angular_velocity));
        if (!sleeps_ || !definition.can_sleep) body.rigid->setActivationState(DISABLE_DEACTIVATION);
        const Filter filter = definition.shapes.empty() ? Filter{} : definition.shapes.front().filter;
        world_.addRigidBody(body.rigid.get(), static_cast<int>(filter.category),
                            static_cast<int>(filter.mask));
        if (definition.gravity_scale != 1)
            body.rigid->setGravity(single(definition.gravity_scale) * world_.getGravity());
        bodies_.push_back(std::move(body));
    }

    void add_joint(const JointDefinition<3>& definition, int a, int b) override {
        btRigidBody& on_a = a < 0 ? ground_ : *at(a).rigid;
        btRigidBody& on_b = *at(b).rigid;
        // Places and directions of the world in the frames of the two.
        const auto point = [](const btRigidBody& body, const Vec3& p) {
            return body.getCenterOfMassTransform().inverse() * to(p);
        };
        const auto frame = [&](const btRigidBody& body, const Vec3& p, const Rotation3& turned) {
            return body.getCenterOfMassTransform().inverse() * to(Transform3{p, turned});
        };
        const auto add = [&](auto joint) {
            world_.addConstraint(joint.get(), !definition.collide);
            joints_.push_back(std::move(joint));
        };
        if (const auto* ball = std::get_if<BallJoint<3>>(&definition.kind);
            ball && !ball->spring && !ball->swing_limit && !ball->twist_limits)
            return add(std::make_unique<btPoint2PointConstraint>(on_a, on_b, point(on_a, ball->anchor),
                                                                 point(on_b, ball->anchor)));
        if (const auto* hinge = std::get_if<HingeJoint<3>>(&definition.kind);
            hinge && !hinge->spring && !hinge->limits && !hinge->motor) {
            const btVector3 axis = to(normalized(hinge->axis));
            const auto direction = [&](const btRigidBody& body) {
                return body.getCenterOfMassTransform().getBasis().transpose() * axis;
            };
            return add(std::make_unique<btHingeConstraint>(on_a, on_b, point(on_a, hinge->anchor),
                                                           point(on_b, hinge->anchor), direction(on_a),
                                                           direction(on_b)));
        }
        if (const auto* slider = std::get_if<SliderJoint<3>>(&definition.kind);
            slider && !slider->spring && !slider->limits && !slider->motor) {
            // It slides along x of its frames.
            const Vec3 axis = normalized(slider->axis);
            const Rotation3 turned =
                from_y_to(axis) * Rotation3::from_axis_angle({0, 0, 1}, 1.5707963267948966);
            auto joint = std::make_unique<btSliderConstraint>(on_a, on_b, frame(on_a, slider->anchor, turned),
                                                              frame(on_b, slider->anchor, turned), true);
            joint->setLowerLinLimit(1);
            joint->setUpperLinLimit(-1);
            joint->setLowerAngLimit(0);
            joint->setUpperAngLimit(0);
            return add(std::move(joint));
        }
        throw Unsupported("a joint of this kind");
    }

    void set_velocity(int body, const Vec3& velocity, const Vec3& spin) override {
        at(body).rigid->setLinearVelocity(to(velocity));
        at(body).rigid->setAngularVelocity(to(spin));
    }
    void apply_force(int body, const Vec3& force, const Vec3& torque) override {
        at(body).rigid->applyCentralForce(to(force));
        at(body).rigid->applyTorque(to(torque));
    }
    void put_to_sleep(int body) override { at(body).rigid->setActivationState(ISLAND_SLEEPING); }
    bool awake(int body) const override { return at(body).rigid->isActive(); }
    BodyState<3> state(int body) const override {
        const Body& b = at(body);
        const btTransform& t = b.rigid->getCenterOfMassTransform();
        const Rotation3 rotation = from(t.getRotation());
        return {{from(t.getOrigin()) - rotate(rotation, b.center), rotation},
                from(b.rigid->getLinearVelocity()),
                from(b.rigid->getAngularVelocity())};
    }
    void step(double dt) override { world_.stepSimulation(single(dt), 0); }

  private:
    struct Body {
        std::unique_ptr<btRigidBody> rigid{};
        Vec3 center{};  ///< its origin in the frame of our body
    };
    const Body& at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

    template <class Shape, class... Arguments>
    Shape* keep(Arguments&&... arguments) {
        auto shape = std::make_unique<Shape>(std::forward<Arguments>(arguments)...);
        Shape* made = shape.get();
        shapes_.push_back(std::move(shape));
        return made;
    }

    /// The shape of a body whose origin is its centre of mass: one alone where that can be, which is faster.
    btCollisionShape* make_shape(const BodyDefinition<3>& definition, const Vec3& center) {
        std::vector<std::pair<btCollisionShape*, Transform3>> parts;
        for (const ShapeDefinition<3>& shape : definition.shapes) {
            auto [part, placed] = make_part(shape);
            parts.push_back({part, {placed.position - center, placed.rotation}});
        }
        if (parts.empty()) return keep<btEmptyShape>();
        if (parts.size() == 1 && length(parts[0].second.position) < 1e-12 &&
            parts[0].second.rotation == Rotation3{})
            return parts[0].first;
        auto* compound = keep<btCompoundShape>();
        for (const auto& [part, placed] : parts) compound->addChildShape(to(placed), part);
        return compound;
    }

    std::pair<btCollisionShape*, Transform3> make_part(const ShapeDefinition<3>& definition) {
        const Transform3 placed{definition.center, definition.rotation};
        if (const auto* ball = std::get_if<Ball>(&definition.geometry))
            return {keep<btSphereShape>(single(ball->radius)), placed};
        if (const auto* box = std::get_if<Box<3>>(&definition.geometry))
            return {keep<btBoxShape>(to(0.5 * box->size)), placed};
        if (const auto* cylinder = std::get_if<Cylinder>(&definition.geometry))
            return {keep<btCylinderShape>(to(Vec3{cylinder->radius, cylinder->height / 2, cylinder->radius})),
                    placed};
        if (const auto* capsule = std::get_if<Capsule<3>>(&definition.geometry)) {
            const Vec3 way = capsule->to - capsule->from;
            const double extent = length(way);
            const Rotation3 turned = extent > 0 ? from_y_to(way / extent) : Rotation3{};
            return {keep<btCapsuleShape>(single(capsule->radius), single(extent)),
                    placed * Transform3{capsule->from + 0.5 * way, turned}};
        }
        if (const auto* hull = std::get_if<Hull<3>>(&definition.geometry)) {
            auto* convex = keep<btConvexHullShape>();
            for (const Vec3& p : hull->points) convex->addPoint(to(p), false);
            convex->recalcLocalAabb();
            convex->setMargin(0.01f);  // it lies around the hull; 0.04 m, the default, would show
            return {convex, placed};
        }
        if (const auto* plane = std::get_if<Plane<3>>(&definition.geometry)) {
            const double size = length(plane->normal);
            return {keep<btStaticPlaneShape>(to(plane->normal / size), single(plane->offset)), placed};
        }
        if (const auto* mesh = std::get_if<Mesh>(&definition.geometry)) {
            auto triangles = std::make_unique<btTriangleMesh>();
            for (const auto& t : mesh->triangles)
                triangles->addTriangle(to(mesh->vertices[t[0]]), to(mesh->vertices[t[1]]),
                                       to(mesh->vertices[t[2]]));
            auto* shape = keep<btBvhTriangleMeshShape>(triangles.get(), true);
            meshes_.push_back(std::move(triangles));
            return {shape, placed};
        }
        throw Unsupported("a shape of this kind");
    }

    bool sleeps_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broad_phase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btTriangleMesh>> meshes_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btTypedConstraint>> joints_;
    std::vector<Body> bodies_;
    btRigidBody ground_{{0, nullptr, nullptr}};
};

}  // namespace

std::unique_ptr<Engine<3>> make_bullet(const WorldDefinition<3>& definition) {
    return std::make_unique<Bullet>(definition);
}

}  // namespace carom::peers
