#include <box2d/box2d.h>

#include <algorithm>
#include <vector>

#include "engine.hpp"

namespace carom::peers {
namespace {

b2Vec2 to(const Vec2& v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }
Vec2 from(const b2Vec2& v) { return {v.x, v.y}; }
float single(double x) { return static_cast<float>(std::min(x, double{b2_maxFloat})); }

constexpr double far = 1000;  // m: half the length of what stands for a plane

class Box2d final : public Engine<2> {
  public:
    explicit Box2d(const WorldDefinition<2>& definition)
        : definition_(definition), world_(to(definition.gravity)) {
        world_.SetAllowSleeping(definition.sleep);
        world_.SetContinuousPhysics(definition.continuous);
        const b2BodyDef nothing;
        ground_ = world_.CreateBody(&nothing);
    }

    void set_gravity(const Vec2& gravity) override { world_.SetGravity(to(gravity)); }

    void add_body(const BodyDefinition<2>& definition, const MassProperties<2>& mass) override {
        if (definition.locks.x || definition.locks.y) throw Unsupported("locked translation");
        b2BodyDef body;
        body.type = definition.type == BodyType::dynamic ? b2_dynamicBody
                    : definition.type == BodyType::fixed ? b2_staticBody
                                                         : b2_kinematicBody;
        body.position = to(definition.position);
        body.angle = single(definition.rotation.angle());
        body.linearVelocity = to(definition.velocity);
        body.angularVelocity = single(definition.angular_velocity);
        body.linearDamping = single(definition.linear_damping);
        body.angularDamping = single(definition.angular_damping);
        body.gravityScale = single(definition.gravity_scale);
        body.fixedRotation = definition.locks.rz;
        body.allowSleep = definition.can_sleep;
        body.bullet = definition.bullet;
        b2Body* made = world_.CreateBody(&body);
        for (const ShapeDefinition<2>& shape : definition.shapes) add_shape(*made, shape);
        if (definition.type == BodyType::dynamic) {
            const double about_origin = mass.inertia + mass.mass * dot(mass.center, mass.center);
            const b2MassData data{single(mass.mass), to(mass.center), single(about_origin)};
            made->SetMassData(&data);
        }
        bodies_.push_back(made);
    }

    void add_joint(const JointDefinition<2>& definition, int a, int b) override {
        b2Body* const on_a = a < 0 ? ground_ : bodies_[static_cast<std::size_t>(a)];
        b2Body* const on_b = bodies_[static_cast<std::size_t>(b)];
        const auto make = [&](auto& joint) {
            joint.collideConnected = definition.collide;
            world_.CreateJoint(&joint);
        };
        if (const auto* hinge = std::get_if<HingeJoint<2>>(&definition.kind); hinge && !hinge->spring) {
            b2RevoluteJointDef joint;
            joint.Initialize(on_a, on_b, to(hinge->anchor));
            set_limits_and_motor(joint, *hinge, joint.lowerAngle, joint.upperAngle, joint.maxMotorTorque);
            return make(joint);
        }
        if (const auto* slider = std::get_if<SliderJoint<2>>(&definition.kind); slider && !slider->spring) {
            b2PrismaticJointDef joint;
            joint.Initialize(on_a, on_b, to(slider->anchor), to(normalized(slider->axis)));
            set_limits_and_motor(joint, *slider, joint.lowerTranslation, joint.upperTranslation,
                                 joint.maxMotorForce);
            return make(joint);
        }
        if (const auto* ball = std::get_if<BallJoint<2>>(&definition.kind); ball && !ball->spring) {
            b2RevoluteJointDef joint;
            joint.Initialize(on_a, on_b, to(ball->anchor));
            return make(joint);
        }
        if (const auto* weld = std::get_if<WeldJoint<2>>(&definition.kind);
            weld && !weld->spring && !weld->angular_spring) {
            b2WeldJointDef joint;
            joint.Initialize(on_a, on_b, weld->anchor ? to(*weld->anchor) : on_b->GetWorldCenter());
            return make(joint);
        }
        if (const auto* rod = std::get_if<DistanceJoint<2>>(&definition.kind);
            rod && !rod->limits && !rod->motor && !rod->spring && !rod->length) {
            b2DistanceJointDef joint;
            joint.Initialize(on_a, on_b, rod->anchor_a ? to(*rod->anchor_a) : on_a->GetWorldCenter(),
                             rod->anchor_b ? to(*rod->anchor_b) : on_b->GetWorldCenter());
            return make(joint);
        }
        throw Unsupported("a joint of this kind");
    }

    void set_velocity(int body, const Vec2& velocity, const double& spin) override {
        at(body)->SetLinearVelocity(to(velocity));
        at(body)->SetAngularVelocity(single(spin));
    }
    void apply_force(int body, const Vec2& force, const double& torque) override {
        at(body)->ApplyForceToCenter(to(force), true);
        at(body)->ApplyTorque(single(torque), true);
    }
    void put_to_sleep(int body) override { at(body)->SetAwake(false); }
    bool awake(int body) const override { return at(body)->IsAwake(); }
    BodyState<2> state(int body) const override {
        const b2Body* b = at(body);
        return {{from(b->GetPosition()), Rotation2::from_angle(b->GetAngle())},
                from(b->GetLinearVelocity()),
                b->GetAngularVelocity()};
    }
    void step(double dt) override { world_.Step(single(dt), 8, 3); }  // as its manual advises

  private:
    b2Body* at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

    template <class Definition, class Joint>
    static void set_limits_and_motor(Definition& definition, const Joint& joint, float& low, float& high,
                                     float& most) {
        if (joint.limits) {
            definition.enableLimit = true;
            low = single(joint.limits->low);
            high = single(joint.limits->high);
        }
        if (joint.motor) {
            if (joint.motor->target) throw Unsupported("a motor with a target");
            definition.enableMotor = true;
            definition.motorSpeed = single(joint.motor->speed);
            most = single(joint.motor->max);
        }
    }

    void add_fixture(b2Body& body, const b2Shape& shape, const ShapeDefinition<2>& definition) const {
        b2FixtureDef fixture;
        fixture.shape = &shape;
        fixture.density = 0;  // masses are given with the body
        fixture.friction = single(definition.material.friction);
        fixture.restitution = single(definition.material.restitution);
        fixture.restitutionThreshold = single(definition_.restitution_threshold);
        fixture.filter.categoryBits = static_cast<std::uint16_t>(definition.filter.category);
        fixture.filter.maskBits = static_cast<std::uint16_t>(definition.filter.mask);
        fixture.filter.groupIndex = static_cast<std::int16_t>(definition.filter.group);
        fixture.isSensor = definition.sensor;
        body.CreateFixture(&fixture);
    }

    void add_polygon(b2Body& body, std::vector<Vec2> corners, double rounding,
                     const ShapeDefinition<2>& definition) const {
        if (corners.size() > b2_maxPolygonVertices) throw Unsupported("a polygon of more than 8 corners");
        std::vector<b2Vec2> points;
        for (const Vec2& corner : corners)
            points.push_back(to(rotate(definition.rotation, corner) + definition.center));
        b2PolygonShape polygon;
        polygon.Set(points.data(), static_cast<int>(points.size()));
        if (rounding > 0) polygon.m_radius = single(rounding);
        add_fixture(body, polygon, definition);
    }

    void add_circle(b2Body& body, const Vec2& center, double radius,
                    const ShapeDefinition<2>& definition) const {
        b2CircleShape circle;
        circle.m_p = to(rotate(definition.rotation, center) + definition.center);
        circle.m_radius = single(radius);
        add_fixture(body, circle, definition);
    }

    void add_shape(b2Body& body, const ShapeDefinition<2>& definition) const {
        const auto place = [&](const Vec2& p) {
            return to(rotate(definition.rotation, p) + definition.center);
        };
        if (const auto* ball = std::get_if<Ball>(&definition.geometry))
            return add_circle(body, {}, ball->radius, definition);
        if (const auto* box = std::get_if<Box<2>>(&definition.geometry)) {
            const double x = box->size.x / 2 - box->rounding, y = box->size.y / 2 - box->rounding;
            return add_polygon(body, {{x, y}, {-x, y}, {-x, -y}, {x, -y}}, box->rounding, definition);
        }
        if (const auto* hull = std::get_if<Hull<2>>(&definition.geometry))
            return add_polygon(body, hull->points, hull->rounding, definition);
        if (const auto* capsule = std::get_if<Capsule<2>>(&definition.geometry)) {
            // It has no capsules: a box between two circles.
            const Vec2 along = normalized(capsule->to - capsule->from);
            const Vec2 side = capsule->radius * Vec2{-along.y, along.x};
            add_polygon(body,
                        {capsule->from + side, capsule->from - side, capsule->to - side, capsule->to + side},
                        0, definition);
            add_circle(body, capsule->from, capsule->radius, definition);
            return add_circle(body, capsule->to, capsule->radius, definition);
        }
        if (const auto* plane = std::get_if<Plane<2>>(&definition.geometry)) {
            const Vec2 normal = normalized(plane->normal), along{-normal.y, normal.x};
            const Vec2 middle = plane->offset * normal;
            b2EdgeShape edge;
            edge.SetTwoSided(place(middle - far * along), place(middle + far * along));
            return add_fixture(body, edge, definition);
        }
        if (const auto* chain = std::get_if<Chain>(&definition.geometry); chain && chain->loop) {
            // Its free side is on the right of the direction of travel.
            std::vector<b2Vec2> points;
            for (auto p = chain->points.rbegin(); p != chain->points.rend(); ++p) points.push_back(place(*p));
            b2ChainShape ring;
            ring.CreateLoop(points.data(), static_cast<int>(points.size()));
            return add_fixture(body, ring, definition);
        }
        throw Unsupported("a shape of this kind");
    }

    WorldDefinition<2> definition_;
    b2World world_;
    b2Body* ground_ = nullptr;
    std::vector<b2Body*> bodies_;
};

}  // namespace

std::unique_ptr<Engine<2>> make_box2d(const WorldDefinition<2>& definition) {
    return std::make_unique<Box2d>(definition);
}

}  // namespace carom::peers
