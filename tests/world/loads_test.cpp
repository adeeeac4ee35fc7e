#include <gtest/gtest.h>

#include "collision/random.hpp"
#include "world/builders.hpp"

// Forces, torques and impulses that the user gives, and the generators of forces, against closed forms.

namespace carom::test {
namespace {

template <int D>
double angular_gap(const Angular<D>& a, const Angular<D>& b) {
    return spin_speed<D>(a - b);
}

template <class T>
class Loads : public testing::Test {};
TYPED_TEST_SUITE(Loads, BothDimensions);

TYPED_TEST(Loads, AForceActsThroughOneStep) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = unit_body<D>();
    d.mass = 4;
    const BodyId<D> body = world.add_body(d);
    world.apply_force(body, vec<D>(8, -4));
    world.apply_force(body, vec<D>(0, 8));
    world.step(0.5);
    EXPECT_EQ(world.velocity(body), vec<D>(1, 0.5));
    EXPECT_EQ(world.position(body), vec<D>(0.25, 0.125)) << "½ a t²";
    world.step(0.5);
    EXPECT_EQ(world.velocity(body), vec<D>(1, 0.5));
    EXPECT_EQ(spin_speed<D>(world.angular_velocity(body)), 0);
}

/// N = (p − r) × F.
TYPED_TEST(Loads, AForceAtAPointTurns) {
    constexpr int D = TypeParam::value;
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        World<D> world(no_gravity<D>());
        BodyDefinition<D> d = unit_body<D>(random.in_cube<D>(3));
        d.rotation = random.rotation<D>();
        d.center_of_mass = random.in_cube<D>(1);
        const BodyId<D> body = world.add_body(d);
        const Vec<D> force = random.in_cube<D>(5), point = random.in_cube<D>(4);
        const Angular<D> torque = cross(point - world.center_of_mass(body), force);
        world.apply_force(body, force, point);
        world.step(0.25);
        EXPECT_LT(length(world.velocity(body) - 0.25 * force), 1e-14);
        EXPECT_LT(angular_gap<D>(world.angular_velocity(body), torque * 0.25), 1e-14);
    }
}

TYPED_TEST(Loads, ATorqueTurnsAlone) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = unit_body<D>(vec<D>(1, 2));
    d.center_of_mass = vec<D>(0.5, 0);
    const BodyId<D> body = world.add_body(d);
    const Vec<D> center = world.center_of_mass(body);
    for (int i = 0; i < 30; ++i) {
        world.apply_torque(body, spin<D>(3));
        world.step(frame_time);
    }
    EXPECT_LT(angular_gap<D>(world.angular_velocity(body), spin<D>(1.5)), 1e-13);
    EXPECT_LT(length(world.center_of_mass(body) - center), 1e-15);
    if constexpr (D == 2) {
        EXPECT_NEAR(world.angle(body), 0.5 * 3 * 0.25, 1e-13) << "½ α t²";
    }
}

TYPED_TEST(Loads, AnImpulseActsAtOnce) {
    constexpr int D = TypeParam::value;
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        World<D> world(no_gravity<D>());
        BodyDefinition<D> d = body_of<D>(cube<D>(1), random.in_cube<D>(3));
        d.rotation = random.rotation<D>();
        const BodyId<D> body = world.add_body(d);
        const MassProperties<D> m = world.mass_properties(body);
        const Vec<D> impulse = random.in_cube<D>(900), point = world.position(body) + random.in_cube<D>(1);
        world.apply_impulse(body, impulse, point);
        EXPECT_LT(length(m.mass * world.velocity(body) - impulse), 1e-12);
        const Angular<D> momentum = m.inertia * world.angular_velocity(body);  // the same about all axes
        EXPECT_LT(angular_gap<D>(momentum, cross(point - world.position(body), impulse)), 1e-11);
        world.apply_impulse(body, -impulse, point);
        EXPECT_LT(length(world.velocity(body)), 1e-14);
        EXPECT_LT(spin_speed<D>(world.angular_velocity(body)), 1e-14);
        world.apply_impulse(body, impulse);
        EXPECT_LT(spin_speed<D>(world.angular_velocity(body)), 1e-14)
            << "at the centre of mass it does not turn";
        world.apply_angular_impulse(body, spin<D>(2));
        EXPECT_LT(angular_gap<D>(m.inertia * world.angular_velocity(body), spin<D>(2)), 1e-11);
    }
}

TYPED_TEST(Loads, NothingMovesWhatIsNotDynamic) {
    constexpr int D = TypeParam::value;
    World<D> world;
    for (const BodyType type : {BodyType::fixed, BodyType::kinematic}) {
        BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(3, 4));
        d.type = type;
        const BodyId<D> body = world.add_body(d);
        world.add_force({ConstantForce<D>{body, vec<D>(100, 0), vec<D>(0, 1)}});
        world.add_force({ConstantTorque<D>{body, spin<D>(100)}});
        world.add_force({TimedImpulse<D>{body, vec<D>(100, 0)}});
        world.add_force({Wind<D>{vec<D>(9, 0), 100}});
        world.apply_force(body, vec<D>(100, 0), vec<D>(0, 0));
        world.apply_torque(body, spin<D>(100));
        world.apply_impulse(body, vec<D>(100, 0), vec<D>(0, 0));
        world.apply_angular_impulse(body, spin<D>(100));
        run(world, 30);
        EXPECT_EQ(world.position(body), vec<D>(3, 4));
        EXPECT_EQ(world.velocity(body), Vec<D>{});
        EXPECT_EQ(spin_speed<D>(world.angular_velocity(body)), 0);
    }
}

/// The force of a window of half a second has given F · ½ s, whatever the integrator.
TYPED_TEST(Loads, AConstantForceActsInItsWindow) {
    constexpr int D = TypeParam::value;
    for (const Integrator integrator :
         {Integrator::semi_implicit_euler, Integrator::explicit_euler, Integrator::verlet, Integrator::rk4}) {
        WorldDefinition<D> definition = no_gravity<D>();
        definition.integrator = integrator;
        World<D> world(definition);
        const BodyId<D> body = world.add_body(unit_body<D>());
        world.add_force({ConstantForce<D>{body, vec<D>(3, 6)}, 0.25, 0.75});
        run(world, 15);
        EXPECT_LT(length(world.velocity(body)), 0.11) << "it has hardly begun";
        run(world, 45);
        EXPECT_LT(length(world.velocity(body) - vec<D>(1.5, 3)), 1e-12) << static_cast<int>(integrator);
        const double place = 1.5 * 0.25 + 0.5 * 3 * 0.25;  // ½ a t², then v t
        // Explicit Euler is a step late, and the stages of rk4 look over the edges of the window.
        const bool exact = integrator == Integrator::semi_implicit_euler || integrator == Integrator::verlet;
        EXPECT_NEAR(world.position(body).x, place, exact ? 1e-12 : frame_time)
            << static_cast<int>(integrator);
    }
}

TYPED_TEST(Loads, ALocalForceTurnsWithTheBody) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = unit_body<D>();
    d.angular_velocity = spin<D>(2);
    const BodyId<D> body = world.add_body(d);
    ConstantForce<D> force{body, vec<D>(1, 0)};
    force.local = true;
    world.add_force({force});
    run(world, 6000, 1e-4);
    // v = ∫ (cos 2t, sin 2t) dt
    const double t = 0.6;
    EXPECT_NEAR(world.velocity(body).x, std::sin(2 * t) / 2, 1e-4);
    EXPECT_NEAR(world.velocity(body).y, (1 - std::cos(2 * t)) / 2, 1e-4);
}

TYPED_TEST(Loads, ATimedImpulseFallsAtItsTime) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = unit_body<D>();
    d.center_of_mass = vec<D>(0.5, 0);
    const BodyId<D> body = world.add_body(d);
    world.add_force({TimedImpulse<D>{body, vec<D>(0, 2), vec<D>(1.5, 0), 0.5}});
    run(world, 30);
    EXPECT_EQ(world.velocity(body), Vec<D>{});
    run(world, 1);
    EXPECT_EQ(world.velocity(body), vec<D>(0, 2));
    EXPECT_LT(angular_gap<D>(world.angular_velocity(body), spin<D>(2)), 1e-15) << "arm 1 times 2 N·s";
    run(world, 60);
    EXPECT_EQ(world.velocity(body), vec<D>(0, 2)) << "it falls once";
}

TYPED_TEST(Loads, ALateImpulseFallsInTheNextStep) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> body = world.add_body(unit_body<D>());
    run(world, 60);
    world.add_force({TimedImpulse<D>{body, vec<D>(1, 0), std::nullopt, 0.25}});
    run(world, 1);
    EXPECT_EQ(world.velocity(body), vec<D>(1, 0));
}

/// With linear drag c the speed nears m g / c, and is v∞ (1 − e^(−c t / m)) on the way.
TYPED_TEST(Loads, LinearDragHasATerminalVelocity) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = unit_body<D>();
    d.mass = 2;
    const BodyId<D> body = world.add_body(d);
    world.add_force({Drag<D>{body, 4, 0}});
    const double terminal = 2 * 9.81 / 4;
    run(world, 500, 1e-3);
    EXPECT_NEAR(-world.velocity(body).y, terminal * (1 - std::exp(-2 * 0.5)), 5e-3);
    run(world, 900);
    EXPECT_NEAR(-world.velocity(body).y, terminal, 1e-9);
}

/// With quadratic drag q the speed nears √(m g / q), and is v∞ tanh(g t / v∞) on the way.
TYPED_TEST(Loads, QuadraticDragHasATerminalVelocity) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = unit_body<D>();
    d.mass = 2;
    const BodyId<D> body = world.add_body(d), other = world.add_body(d);
    world.add_force({Drag<D>{body, 0, 0.5}});
    const double terminal = std::sqrt(2 * 9.81 / 0.5);
    run(world, 500, 1e-3);
    EXPECT_NEAR(-world.velocity(body).y, terminal * std::tanh(9.81 * 0.5 / terminal), 5e-3);
    EXPECT_NEAR(-world.velocity(other).y, 9.81 * 0.5, 1e-12) << "not its drag";
    run(world, 600);
    EXPECT_NEAR(-world.velocity(body).y, terminal, 1e-9);
}

TYPED_TEST(Loads, DragForAllBrakesAll) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    std::vector<BodyId<D>> bodies;
    for (int i = 1; i < 5; ++i) {
        BodyDefinition<D> d = unit_body<D>(vec<D>(10 * i, 0));
        d.mass = i;
        d.velocity = vec<D>(0, i);
        bodies.push_back(world.add_body(d));
    }
    world.add_force({Drag<D>{std::nullopt, 1, 0}});
    run(world, 1000, 1e-3);
    for (int i = 1; i < 5; ++i) EXPECT_NEAR(world.velocity(bodies[i - 1]).y, i * std::exp(-1.0 / i), 2e-3);
}

/// A falling ball in wind: sideways it takes the wind's speed, downwards it falls at the speed whose drag is
/// its weight: m g = ½ ρ A v².
TYPED_TEST(Loads, WindCarriesAndBrakes) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    Material foam;
    foam.density = 20;
    const BodyId<D> ball = world.add_body(body_of<D>(Ball{0.5}, {}, foam));
    world.add_force({Wind<D>{vec<D>(3, 0), 1.2}});
    run(world, 3000);
    const double area = D == 2 ? 1.0 : std::acos(-1.0) * 0.25;
    const double terminal = std::sqrt(world.mass_properties(ball).mass * 9.81 / (0.5 * 1.2 * area));
    EXPECT_NEAR(-world.velocity(ball).y, terminal, 1e-6);
    EXPECT_NEAR(world.velocity(ball).x, 3, 1e-6);
}

/// The cross-section is that of a ball of the same measure, whatever the shape.
TYPED_TEST(Loads, WindSeesTheMeasureOfAShape) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const double pi = std::acos(-1.0), side = D == 2 ? std::sqrt(pi) : std::cbrt(4 * pi / 3);
    BodyDefinition<D> box = body_of<D>(cube<D>(side)), ball = body_of<D>(Ball{1});
    box.mass = ball.mass = 1;
    const BodyId<D> a = world.add_body(box), b = world.add_body(ball);
    world.set_transform(a, {vec<D>(50, 0), {}});
    world.add_force({Wind<D>{vec<D>(3, 0), 1.2}});
    world.step(frame_time);
    EXPECT_GT(world.velocity(a).x, 0);
    EXPECT_NEAR(world.velocity(a).x, world.velocity(b).x, 1e-14);
    const double area = D == 2 ? 2.0 : pi;
    EXPECT_NEAR(world.velocity(b).x, 0.5 * 1.2 * area * 9 * frame_time, 1e-12);
}

TYPED_TEST(Loads, APointGravityHoldsACircularOrbit) {
    constexpr int D = TypeParam::value;
    WorldDefinition<D> definition = no_gravity<D>();
    definition.integrator = Integrator::verlet;
    World<D> world(definition);
    BodyDefinition<D> d = unit_body<D>(vec<D>(3, 1));
    d.mass = 7;
    d.velocity = vec<D>(0, 2);
    const BodyId<D> body = world.add_body(d);
    world.add_force({PointGravity<D>{vec<D>(1, 1), 8}});  // v² = gm / r: 4 = 8 / 2
    const double period = 2 * std::acos(-1.0) * 2 / 2;
    run(world, 2000, period / 2000);
    EXPECT_LT(length(world.position(body) - vec<D>(3, 1)), 1e-4);
    EXPECT_NEAR(length(world.position(body) - vec<D>(1, 1)), 2, 1e-4);
}

/// Case C5: m = 1, k = 100, from x = 1 at rest, after a second, by the damping ratio.
TYPED_TEST(Loads, ASpringWithADamperSwingsAsItShould) {
    constexpr int D = TypeParam::value;
    const double ratios[] = {0, 0.05, 0.2, 0.5, 1};
    const double places[] = {-0.839071529, -0.529208819, -0.136092048, -0.002170117, 0.000499399};
    for (int i = 0; i < 5; ++i) {
        WorldDefinition<D> definition = no_gravity<D>();
        definition.integrator = Integrator::rk4;
        World<D> world(definition);
        const BodyId<D> body = world.add_body(unit_body<D>(vec<D>(6, 0)));
        Spring<D> spring;
        spring.b = body;
        spring.stiffness = 100;
        spring.damping = 2 * ratios[i] * 10;
        spring.length = 5;
        world.add_force({spring});
        run(world, 240, 1.0 / 240);
        EXPECT_NEAR(world.position(body).x - 5, places[i], 1e-5) << "damping ratio " << ratios[i];
    }
}

TYPED_TEST(Loads, ASpringIsAtRestAtTheLengthThatItHadWhenItCame) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> a = world.add_body(unit_body<D>(vec<D>(0, 0))),
                    b = world.add_body(unit_body<D>(vec<D>(3, 4)));
    Spring<D> spring;
    spring.a = a;
    spring.b = b;
    spring.anchor_a = vec<D>(0, 1);
    spring.stiffness = 1000;
    world.add_force({spring});
    run(world, 60);
    EXPECT_EQ(world.position(a), vec<D>(0, 0));
    EXPECT_EQ(world.position(b), vec<D>(3, 4));
    EXPECT_EQ(world.energy().potential, 0);
}

/// Two masses on a spring swing about their common centre, which does not move.
TYPED_TEST(Loads, ASpringBetweenTwoBodiesKeepsTheirCentre) {
    constexpr int D = TypeParam::value;
    WorldDefinition<D> definition = no_gravity<D>();
    definition.integrator = Integrator::rk4;
    World<D> world(definition);
    BodyDefinition<D> heavy = unit_body<D>(vec<D>(0, 0)), light = unit_body<D>(vec<D>(3, 0));
    heavy.mass = 3;
    const BodyId<D> a = world.add_body(heavy), b = world.add_body(light);
    Spring<D> spring;
    spring.a = a;
    spring.b = b;
    spring.stiffness = 12;
    spring.length = 2;
    world.add_force({spring});
    const double start = world.energy().total();
    EXPECT_NEAR(start, 0.5 * 12, 1e-15);
    const double omega = std::sqrt(12 * (1 + 1 / 3.0));  // k over the reduced mass
    for (int i = 0; i < 240; ++i) {
        world.step(1.0 / 240);
        ASSERT_LT(length(3.0 * world.position(a) + world.position(b) - vec<D>(3, 0)), 1e-13);
    }
    EXPECT_NEAR(world.position(b).x - world.position(a).x, 2 + std::cos(omega), 1e-6);
    EXPECT_NEAR(world.energy().total(), start, 1e-6);
}

TYPED_TEST(Loads, ARemovedGeneratorActsNoMore) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> body = world.add_body(unit_body<D>());
    const ForceId<D> force = world.add_force({ConstantForce<D>{body, vec<D>(6, 0)}});
    EXPECT_EQ(world.counts().forces, 1);
    run(world, 30);
    world.remove_force(force);
    EXPECT_FALSE(world.contains(force));
    EXPECT_EQ(world.counts().forces, 0);
    run(world, 30);
    EXPECT_NEAR(world.velocity(body).x, 3, 1e-13);
}

TYPED_TEST(Loads, GeneratorsGoWithTheirBody) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> a = world.add_body(unit_body<D>()), b = world.add_body(unit_body<D>(vec<D>(2, 0)));
    Spring<D> spring;
    spring.a = a;
    spring.b = b;
    spring.stiffness = 5;
    const ForceId<D> joins = world.add_force({spring});
    const ForceId<D> pushes = world.add_force({ConstantForce<D>{b, vec<D>(1, 0)}});
    world.remove_body(a);
    EXPECT_FALSE(world.contains(joins));
    EXPECT_TRUE(world.contains(pushes));
    run(world, 10);
    EXPECT_NEAR(world.velocity(b).x, 10 * frame_time, 1e-14);
}

/// Generators act on bodies that touch something, too: a box on ice that is pulled with a constant force.
TYPED_TEST(Loads, AForceActsOnABodyInContact) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    Material ice;
    ice.friction = 0;
    world.add_body(ground<D>(ice));
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5), ice);
    d.mass = 2;
    const BodyId<D> box = world.add_body(d);
    world.add_force({ConstantForce<D>{box, vec<D>(4, 0)}});
    run(world, 60);
    EXPECT_NEAR(world.velocity(box).x, 2, 1e-5);
    EXPECT_NEAR(world.position(box).x, 1, 1e-4);
    EXPECT_NEAR(world.position(box).y, 0.5, 1e-3);
}

}  // namespace
}  // namespace carom::test
