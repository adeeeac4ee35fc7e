#include <chipmunk/chipmunk.h>

#include <limits>
#include <vector>

#include "engine.hpp"

namespace carom::peers {
namespace {

cpVect to(const Vec2& v) { return {v.x, v.y}; }
Vec2 from(const cpVect& v) { return {v.x, v.y}; }

constexpr double far = 1000;  // m: half the length of what stands for a plane

class Chipmunk final : public Engine<2> {
  public:
    explicit Chipmunk(const WorldDefinition<2>& definition) : space_(cpSpaceNew()) {
        cpSpaceSetGravity(space_, to(definition.gravity));
        if (definition.sleep) cpSpaceSetSleepTimeThreshold(space_, 0.5);
    }
    Chipmunk(const Chipmunk&) = delete;
    Chipmunk& operator=(const Chipmunk&) = delete;
    ~Chipmunk() override {
        const auto free_all = [](auto& things, auto free) {
            for (auto* thing : things) free(thing);
        };
        free_all(constraints_, [this](cpConstraint* c) {
            cpSpaceRemoveConstraint(space_, c);
            cpConstraintFree(c);
        });
        free_all(shapes_, [this](cpShape* s) {
            cpSpaceRemoveShape(space_, s);
            cpShapeFree(s);
        });
        free_all(bodies_, [this](cpBody* b) {
            cpSpaceRemoveBody(space_, b);
            cpBodyFree(b);
        });
        cpSpaceFree(space_);
    }

    void set_gravity(const Vec2& gravity) override { cpSpaceSetGravity(space_, to(gravity)); }

    void add_body(const BodyDefinition<2>& definition, const MassProperties<2>& mass) override {
        if (definition.locks.x || definition.locks.y) throw Unsupported("locked translation");
        if (definition.linear_damping > 0 || definition.angular_damping > 0 || definition.gravity_scale != 1)
            throw Unsupported("damping or a scale of gravity of one body");
        cpBody* body = definition.type == BodyType::fixed       ? cpBodyNewStatic()
                       : definition.type == BodyType::kinematic ? cpBodyNewKinematic()
                                                                : dynamic_body(definition, mass);
        cpBodySetPosition(body, to(definition.position));
        cpBodySetAngle(body, definition.rotation.angle());
        cpBodySetVelocity(body, to(definition.velocity));
        cpBodySetAngularVelocity(body, definition.angular_velocity);
        bodies_.push_back(cpSpaceAddBody(space_, body));
        for (const ShapeDefinition<2>& shape : definition.shapes) add_shape(body, shape);
    }

    void add_joint(const JointDefinition<2>& definition, int a, int b) override {
        cpBody* const on_a = a < 0 ? cpSpaceGetStaticBody(space_) : at(a);
        cpBody* const on_b = at(b);
        if (const auto* hinge = std::get_if<HingeJoint<2>>(&definition.kind); hinge && !hinge->spring) {
            add(cpPivotJointNew(on_a, on_b, to(hinge->anchor)), definition);
            if (hinge->limits)
                add(cpRotaryLimitJointNew(on_a, on_b, hinge->limits->low, hinge->limits->high), definition);
            if (hinge->motor) {
                if (hinge->motor->target) throw Unsupported("a motor with a target");
                cpConstraint* motor = cpSimpleMotorNew(on_a, on_b, -hinge->motor->speed);
                cpConstraintSetMaxForce(motor, hinge->motor->max);
                add(motor, definition);
            }
            return;
        }
        if (const auto* ball = std::get_if<BallJoint<2>>(&definition.kind); ball && !ball->spring)
            return add(cpPivotJointNew(on_a, on_b, to(ball->anchor)), definition);
        if (const auto* rod = std::get_if<DistanceJoint<2>>(&definition.kind);
            rod && !rod->limits && !rod->motor && !rod->spring && !rod->length) {
            const auto local = [](cpBody* body, const std::optional<Vec2>& anchor) {
                return anchor ? cpBodyWorldToLocal(body, to(*anchor)) : cpBodyGetCenterOfGravity(body);
            };
            return add(cpPinJointNew(on_a, on_b, local(on_a, rod->anchor_a), local(on_b, rod->anchor_b)),
                       definition);
        }
        throw Unsupported("a joint of this kind");
    }

    void set_velocity(int body, const Vec2& velocity, const double& spin) override {
        cpBodySetVelocity(at(body), to(velocity));
        cpBodySetAngularVelocity(at(body), spin);
    }
    void apply_force(int body, const Vec2& force, const double& torque) override {
        cpBodySetForce(at(body), cpvadd(cpBodyGetForce(at(body)), to(force)));
        cpBodySetTorque(at(body), cpBodyGetTorque(at(body)) + torque);
    }
    void put_to_sleep(int body) override { cpBodySleep(at(body)); }
    bool awake(int body) const override { return !cpBodyIsSleeping(at(body)); }
    BodyState<2> state(int body) const override {
        return {{from(cpBodyGetPosition(at(body))), Rotation2::from_angle(cpBodyGetAngle(at(body)))},
                from(cpBodyGetVelocity(at(body))),
                cpBodyGetAngularVelocity(at(body))};
    }
    void step(double dt) override { cpSpaceStep(space_, dt); }

  private:
    cpBody* at(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

    static cpBody* dynamic_body(const BodyDefinition<2>& definition, const MassProperties<2>& mass) {
        const double inertia = definition.locks.rz ? std::numeric_limits<double>::infinity() : mass.inertia;
        cpBody* body = cpBodyNew(mass.mass, inertia);
        cpBodySetCenterOfGravity(body, to(mass.center));
        return body;
    }

    void add(cpConstraint* constraint, const JointDefinition<2>& definition) {
        cpConstraintSetCollideBodies(constraint, definition.collide);
        constraints_.push_back(cpSpaceAddConstraint(space_, constraint));
    }

    void add(cpShape* shape, const ShapeDefinition<2>& definition) {
        // Its rule for pairs is the product.
        cpShapeSetFriction(shape, std::sqrt(definition.material.friction));
        cpShapeSetElasticity(shape, std::sqrt(definition.material.restitution));
        const int group = definition.filter.group;
        cpShapeSetFilter(shape, cpShapeFilterNew(static_cast<cpGroup>(group < 0 ? -group : 0),
                                                 static_cast<cpBitmask>(definition.filter.category),
                                                 static_cast<cpBitmask>(definition.filter.mask)));
        cpShapeSetSensor(shape, definition.sensor);
        shapes_.push_back(cpSpaceAddShape(space_, shape));
    }

    void add_polygon(cpBody* body, const std::vector<Vec2>& corners, double rounding,
                     const ShapeDefinition<2>& definition) {
        std::vector<cpVect> points;
        for (const Vec2& corner : corners)
            points.push_back(to(rotate(definition.rotation, corner) + definition.center));
        add(cpPolyShapeNew(body, static_cast<int>(points.size()), points.data(), cpTransformIdentity,
                           rounding),
            definition);
    }

    void add_shape(cpBody* body, const ShapeDefinition<2>& definition) {
        const auto place = [&](const Vec2& p) {
            return to(rotate(definition.rotation, p) + definition.center);
        };
        if (const auto* ball = std::get_if<Ball>(&definition.geometry))
            return add(cpCircleShapeNew(body, ball->radius, place({})), definition);
        if (const auto* box = std::get_if<Box<2>>(&definition.geometry)) {
            const double x = box->size.x / 2 - box->rounding, y = box->size.y / 2 - box->rounding;
            return add_polygon(body, {{x, y}, {-x, y}, {-x, -y}, {x, -y}}, box->rounding, definition);
        }
        if (const auto* hull = std::get_if<Hull<2>>(&definition.geometry))
            return add_polygon(body, hull->points, hull->rounding, definition);
        if (const auto* capsule = std::get_if<Capsule<2>>(&definition.geometry))
            return add(cpSegmentShapeNew(body, place(capsule->from), place(capsule->to), capsule->radius),
                       definition);
        if (const auto* plane = std::get_if<Plane<2>>(&definition.geometry)) {
            // A segment a metre thick on either side, so that nothing slips through.
            constexpr double thickness = 1;
            const Vec2 normal = normalized(plane->normal), along{-normal.y, normal.x};
            const Vec2 middle = (plane->offset - thickness) * normal;
            return add(
                cpSegmentShapeNew(body, place(middle - far * along), place(middle + far * along), thickness),
                definition);
        }
        if (const auto* chain = std::get_if<Chain>(&definition.geometry)) {
            const std::size_t count = chain->points.size();
            for (std::size_t i = 0; i + 1 < count || (chain->loop && i < count); ++i)
                add(cpSegmentShapeNew(body, place(chain->points[i]), place(chain->points[(i + 1) % count]),
                                      0),
                    definition);
            return;
        }
        throw Unsupported("a shape of this kind");
    }

    cpSpace* space_;
    std::vector<cpBody*> bodies_;
    std::vector<cpShape*> shapes_;
    std::vector<cpConstraint*> constraints_;
};

}  // namespace

std::unique_ptr<Engine<2>> make_chipmunk(const WorldDefinition<2>& definition) {
    return std::make_unique<Chipmunk>(definition);
}

}  // namespace carom::peers
