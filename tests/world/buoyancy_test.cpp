#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "builders.hpp"

// Bodies in water whose surface is y = 0, unless a test says otherwise.

namespace carom {
namespace {

using test::spin;
using test::vec;

template <class T>
class Water : public testing::Test {};
TYPED_TEST_SUITE(Water, test::BothDimensions);

template <int D>
Box<D> box(double side) {
    Box<D> result;
    for (int i = 0; i < D; ++i) result.size[i] = side;
    return result;
}

template <int D>
BodyDefinition<D> floater(const Geometry<D>& geometry, double density, double height) {
    BodyDefinition<D> body;
    body.position.y = height;
    body.shapes.push_back({geometry});
    body.shapes.back().material.density = density;
    return body;
}

template <int D>
void run(World<D>& world, double seconds) {
    for (int i = 0; i < seconds * 60; ++i) world.step(test::frame_time);
}

TYPED_TEST(Water, CarriesAndDragsEveryKindOfBody) {
    constexpr int D = TypeParam::value;
    std::vector<Geometry<D>> kinds{Ball{0.5}, box<D>(1), Capsule<D>{vec<D>(-0.3, 0), vec<D>(0.3, 0), 0.3}};
    Box<D> rounded = box<D>(1);
    rounded.rounding = 0.2;
    kinds.push_back(rounded);
    if constexpr (D == 3) {
        kinds.push_back(Cylinder{0.4, 0.8});
        kinds.push_back(Cone{0.5, 1});
    }
    World<D> world;
    Buoyancy<D> river;
    river.linear_drag = 2;
    river.flow = vec<D>(1.5, 0);
    world.add_force({river});
    std::vector<BodyId<D>> bodies;
    for (const Geometry<D>& kind : kinds) {
        BodyDefinition<D> body = floater<D>(kind, 400, 1);
        body.position.x = 10.0 * double(bodies.size());
        bodies.push_back(world.add_body(body));
    }
    run(world, 20);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        EXPECT_NEAR(world.velocity(bodies[i]).x, 1.5, 1e-3) << i;
        EXPECT_NEAR(world.velocity(bodies[i]).y, 0, 1e-3) << i;
        EXPECT_LT(std::fabs(world.position(bodies[i]).y), 0.5) << i;
    }
}

TYPED_TEST(Water, OverlapCountsTwiceAndSensorsNotAtAllAsForMass) {
    constexpr int D = TypeParam::value;
    World<D> world;
    Buoyancy<D> lake;
    lake.linear_drag = 3;
    world.add_force({lake});
    // Two equal boxes in one place have the mass of two and displace as much: they float as one does.
    BodyDefinition<D> twice = floater<D>(box<D>(1), 300, 0);
    twice.locks.rx = twice.locks.ry = twice.locks.rz = true;
    twice.shapes.push_back(twice.shapes[0]);
    twice.shapes.push_back(twice.shapes[0]);
    twice.shapes.back().sensor = true;
    const BodyId<D> body = world.add_body(twice);
    run(world, 20);
    EXPECT_NEAR(world.position(body).y, 0.2, 1e-4);
}

TYPED_TEST(Water, ABodyThatFloatsFallsAsleepAndSinksWhenTheWaterIsGone) {
    constexpr int D = TypeParam::value;
    World<D> world;
    Buoyancy<D> lake;
    lake.linear_drag = 2;
    const ForceId<D> force = world.add_force({lake});
    const BodyId<D> body = world.add_body(floater<D>(Ball{0.5}, 500, 0.1));
    run(world, 20);
    EXPECT_FALSE(world.awake(body));
    EXPECT_NEAR(world.position(body).y, 0, 2e-3);
    world.remove_force(force);
    run(world, 1);
    EXPECT_TRUE(world.awake(body));
    EXPECT_LT(world.position(body).y, -4);
}

// Joints send bodies through the solver, which adds the forces in sub-steps of its own.
TYPED_TEST(Water, BobbingKeepsItsHeightInTheSolverToo) {
    constexpr int D = TypeParam::value;
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    world.add_force({Buoyancy<D>{}});
    BodyDefinition<D> half = floater<D>(box<D>(1), 500, 0.2);
    half.locks.rx = half.locks.ry = half.locks.rz = true;
    const BodyId<D> a = world.add_body(half);
    half.position.x = 2;
    const BodyId<D> b = world.add_body(half);
    JointDefinition<D> joint;
    joint.kind = DistanceJoint<D>{};
    joint.a = a;
    joint.b = b;
    world.add_joint(joint);
    double first = 0, last = 0;
    for (int i = 0; i < 3600; ++i) {
        world.step(test::frame_time);
        (i < 600 ? first : last) = std::max(i < 600 ? first : last, world.position(a).y);
        if (i == 2999) last = 0;
    }
    EXPECT_NEAR(first, 0.2, 2e-3);
    EXPECT_NEAR(last, 0.2, 4e-3);
}

TYPED_TEST(Water, NoDragIsTooStrong) {
    constexpr int D = TypeParam::value;
    for (const double strength : {1e3, 1e9}) {
        World<D> world;
        Buoyancy<D> tar;
        tar.linear_drag = tar.quadratic_drag = strength;
        world.add_force({tar});
        BodyDefinition<D> body = floater<D>(box<D>(1), 900, -3);
        body.velocity = vec<D>(30, -20);
        body.angular_velocity = spin<D>(10);
        const BodyId<D> id = world.add_body(body);
        double energy = world.energy().kinetic;
        for (int i = 0; i < 60; ++i) {
            world.step(test::frame_time);
            // What a step of buoyancy alone may add to a body at rest.
            EXPECT_LT(world.energy().kinetic, energy + 20);
            energy = world.energy().kinetic;
        }
        EXPECT_LT(length(world.velocity(id)), 0.1);
    }
}

// Of a half-space at any slope the pressure grows along its normal, so energy is kept.
TYPED_TEST(Water, EnergyIsKeptByEveryIntegratorAndWithATiltedSurface) {
    constexpr int D = TypeParam::value;
    for (const Integrator integrator :
         {Integrator::semi_implicit_euler, Integrator::verlet, Integrator::rk4}) {
        WorldDefinition<D> definition;
        definition.integrator = integrator;
        World<D> world(definition);
        Buoyancy<D> slope;
        slope.up = vec<D>(0.2, 1);
        world.add_force({slope});
        BodyDefinition<D> body = floater<D>(box<D>(1), 500, 0.1);
        body.shapes[0].center = vec<D>(0.1, 0);
        const BodyId<D> id = world.add_body(body);
        const double start = world.energy().total(), scale = world.mass_properties(id).mass * 9.81;
        for (int i = 0; i < 600; ++i) {
            world.step(test::frame_time);
            ASSERT_NEAR((world.energy().total() - start) / scale, 0, 2e-3) << int(integrator) << " " << i;
        }
    }
}

TYPED_TEST(Water, TheSameTwice) {
    constexpr int D = TypeParam::value;
    const auto play = [] {
        World<D> world;
        Buoyancy<D> lake;
        lake.linear_drag = 0.5;
        lake.quadratic_drag = 0.5;
        world.add_force({lake});
        for (int i = 0; i < 10; ++i) {
            BodyDefinition<D> body = floater<D>(box<D>(1), 100.0 + 80 * i, 1 + i);
            body.position.x = 0.3 * (i % 3);
            world.add_body(body);
        }
        run(world, 5);
        return world.hash();
    };
    EXPECT_EQ(play(), play());
}

TYPED_TEST(Water, RefusesWhatCannotBe) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const auto refused = [&](const Buoyancy<D>& water, const std::string& message) {
        try {
            world.add_force({water});
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
        }
    };
    Buoyancy<D> water;
    water.up = {};
    refused(water, "up: a direction has a length");
    water = {};
    water.density = -1;
    refused(water, "density: -1 is negative");
    water = {};
    water.linear_drag = -1;
    refused(water, "linear_drag: -1 is negative");
    water = {};
    water.quadratic_drag = -1;
    refused(water, "quadratic_drag: -1 is negative");
    water = {};
    water.flow.y = std::nan("");
    refused(water, "flow[1]: nan is not finite");
    EXPECT_EQ(world.counts().forces, 0);
}

}  // namespace
}  // namespace carom
