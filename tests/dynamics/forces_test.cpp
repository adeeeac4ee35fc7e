#include "dynamics/forces.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "carom/error.hpp"
#include "collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

/// A few bodies in random motion.
template <int D>
struct Bodies {
    std::vector<BodyState<D>> states;
    std::vector<BodyMass<D>> masses;
    std::vector<Load<D>> loads;

    Bodies(Random& random, int count) {
        for (int i = 0; i < count; ++i) {
            BodyState<D>& s = states.emplace_back();
            s.position = random.in_cube<D>(3);
            s.rotation = random.rotation<D>();
            s.velocity = random.in_cube<D>(2);
            if constexpr (D == 2)
                s.angular_velocity = random.between(-2, 2);
            else
                s.angular_velocity = random.in_cube<3>(2);
            BodyMass<D>& m = masses.emplace_back();
            m.mass = random.between(0.5, 3);
            m.inverse_mass = 1 / m.mass;
            m.center = random.in_cube<D>(0.5);
            m.cross_section = random.between(0.1, 2);
        }
        loads.resize(states.size());
    }
    BodyView<D> view() const { return {states, masses}; }
    std::vector<Load<D>> loads_of(const Forces<D>& forces, double time) {
        loads.assign(states.size(), {});
        std::vector<std::uint32_t> all(states.size());
        std::iota(all.begin(), all.end(), 0u);
        forces.add_loads(view(), all, time, loads);
        return loads;
    }
    static BodyId<D> id(std::uint32_t index) { return {index, 1}; }
};

template <class T>
class ForcesIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ForcesIn, Dimensions);

TYPED_TEST(ForcesIn, ActInTheirWindowAlone) {
    constexpr int D = TypeParam::value;
    Random random(1);
    Bodies<D> bodies(random, 2);
    Forces<D> forces;
    forces.add({ConstantForce<D>{Bodies<D>::id(1), random.direction<D>()}, 0.5, 1.5});
    const auto acts = [&](double time) {
        const std::vector<Load<D>> loads = bodies.loads_of(forces, time);
        EXPECT_EQ(loads[0].force, Vec<D>{});
        return loads[1].force != Vec<D>{};
    };
    EXPECT_FALSE(acts(0));
    EXPECT_FALSE(acts(0.499));
    EXPECT_TRUE(acts(0.5));
    EXPECT_TRUE(acts(0.5 - 1e-9)) << "a sum of steps may be a little short";
    EXPECT_TRUE(acts(1.499));
    EXPECT_FALSE(acts(1.5));
    EXPECT_FALSE(acts(1.5 - 1e-9));
    EXPECT_FALSE(acts(9));
}

TYPED_TEST(ForcesIn, ChangesAreToldOnce) {
    constexpr int D = TypeParam::value;
    Forces<D> forces;
    forces.add({ConstantForce<D>{Bodies<D>::id(3), {}}, 1, 2});
    int visits = 0, all = 0;
    for (int i = 0; i < 300; ++i) {
        forces.each_change(
            0.01 * i, 0.01 * (i + 1), [&](std::uint32_t body) { visits += body == 3; }, [&] { ++all; });
    }
    EXPECT_EQ(visits, 2);
    EXPECT_EQ(all, 0);
    forces.add({Wind<D>{}, 1, 2});
    for (int i = 0; i < 300; ++i) {
        forces.each_change(
            0.01 * i, 0.01 * (i + 1), [](std::uint32_t) {}, [&] { ++all; });
    }
    EXPECT_EQ(all, 2);
}

TYPED_TEST(ForcesIn, AForceAtAPointHasATorque) {
    constexpr int D = TypeParam::value;
    Random random(2);
    Bodies<D> bodies(random, 1);
    const Vec<D> value = random.in_cube<D>(5), point = random.in_cube<D>(1);
    for (const bool local : {false, true}) {
        Forces<D> forces;
        forces.add({ConstantForce<D>{Bodies<D>::id(0), value, point, local}});
        const Load<D> load = bodies.loads_of(forces, 0)[0];
        const BodyState<D>& s = bodies.states[0];
        const Vec<D> force = local ? rotate(s.rotation, value) : value;
        const Vec<D> place = apply(frame(s, bodies.masses[0]), point);
        const Angular<D> off = load.torque - cross(place - s.position, force);
        EXPECT_LT(length(load.force - force), 1e-14);
        EXPECT_LT(angular_dot(off, off), 1e-26);
    }
}

TYPED_TEST(ForcesIn, ASpringPullsBothEndsAlike) {
    constexpr int D = TypeParam::value;
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        Bodies<D> bodies(random, 2);
        Forces<D> forces;
        Spring<D> spring;
        spring.a = Bodies<D>::id(0);
        spring.b = Bodies<D>::id(1);
        spring.anchor_a = random.in_cube<D>(1);
        spring.anchor_b = random.in_cube<D>(1);
        spring.stiffness = random.between(0, 50);
        spring.damping = random.between(0, 5);
        spring.length = random.between(0, 2);
        forces.add({spring});
        const std::vector<Load<D>> loads = bodies.loads_of(forces, 0);
        EXPECT_LT(length(loads[0].force + loads[1].force), 1e-13);
        Angular<D> about_origin{};
        for (std::size_t k = 0; k < 2; ++k)
            about_origin = about_origin + loads[k].torque + cross(bodies.states[k].position, loads[k].force);
        EXPECT_LT(std::sqrt(angular_dot(about_origin, about_origin)), 1e-11);

        // Along the line between the anchors: k (d − l) + c d'.
        const Vec<D> a = apply(frame(bodies.states[0], bodies.masses[0]), spring.anchor_a);
        const Vec<D> b = apply(frame(bodies.states[1], bodies.masses[1]), spring.anchor_b);
        const auto velocity = [&](std::size_t k, const Vec<D>& p) {
            return bodies.states[k].velocity +
                   cross(bodies.states[k].angular_velocity, p - bodies.states[k].position);
        };
        const Vec<D> along = normalized(b - a);
        const double pull = spring.stiffness * (length(b - a) - *spring.length) +
                            spring.damping * dot(along, velocity(1, b) - velocity(0, a));
        EXPECT_LT(length(loads[0].force - pull * along), 1e-11);
    }
}

/// The work of a conservative force is the loss of potential energy: force = −d potential / d position.
TYPED_TEST(ForcesIn, PotentialIsTheIntegralOfTheForce) {
    constexpr int D = TypeParam::value;
    Random random(4);
    Bodies<D> bodies(random, 3);
    Forces<D> forces;
    Spring<D> between, to_world;
    between.a = Bodies<D>::id(0);
    between.b = to_world.b = Bodies<D>::id(1);
    between.anchor_a = random.in_cube<D>(1);
    between.anchor_b = random.in_cube<D>(1);
    to_world.anchor_a = random.in_cube<D>(9);
    between.stiffness = to_world.stiffness = 30;
    between.length = 0.7;
    to_world.length = 2;
    forces.add({between});
    forces.add({to_world});
    forces.add({PointGravity<D>{random.in_cube<D>(9), 40}});
    const std::vector<Load<D>> loads = bodies.loads_of(forces, 0);
    constexpr double h = 1e-5;
    for (std::size_t i = 0; i < 3; ++i) {
        for (int axis = 0; axis < D; ++axis) {
            const auto potential_at = [&](double offset) {
                Bodies<D> moved = bodies;
                moved.states[i].position[axis] += offset;
                return forces.potential(moved.view(), 0);
            };
            const double slope = (potential_at(h) - potential_at(-h)) / (2 * h);
            EXPECT_NEAR(loads[i].force[axis], -slope, 1e-6);
        }
    }
}

TYPED_TEST(ForcesIn, DragAndWindFollowTheirFormulas) {
    constexpr int D = TypeParam::value;
    Random random(5);
    Bodies<D> bodies(random, 3);
    bodies.masses[2].mass = bodies.masses[2].inverse_mass = 0;
    const Vec<D> air = random.in_cube<D>(5);
    Forces<D> one, all, wind;
    one.add({Drag<D>{Bodies<D>::id(1), 0.3, 0.7}});
    all.add({Drag<D>{std::nullopt, 0.3, 0.7}});
    wind.add({Wind<D>{air, 1.1}});
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec<D> v = bodies.states[i].velocity, u = air - v;
        const double moves = i < 2 ? 1 : 0;
        const Vec<D> drag = -moves * (0.3 + 0.7 * length(v)) * v;
        const Vec<D> push = moves * 0.5 * 1.1 * bodies.masses[i].cross_section * length(u) * u;
        EXPECT_LT(length(bodies.loads_of(one, 0)[i].force - (i == 1 ? 1.0 : 0.0) * drag), 1e-13);
        EXPECT_LT(length(bodies.loads_of(all, 0)[i].force - drag), 1e-13);
        EXPECT_LT(length(bodies.loads_of(wind, 0)[i].force - push), 1e-13);
    }
}

TYPED_TEST(ForcesIn, ABlowFallsOnce) {
    constexpr int D = TypeParam::value;
    Forces<D> forces;
    const Vec<D> value = Random(6).direction<D>();
    forces.add({TimedImpulse<D>{Bodies<D>::id(2), value, std::nullopt, 0.1}});
    int blows = 0;
    double when = -1;
    for (int i = 0; i < 60; ++i) {
        forces.take_impulses(i / 60.0, [&](BodyId<D> body, const Vec<D>& impulse, const auto& point) {
            ++blows;
            when = i / 60.0;
            EXPECT_EQ(body, Bodies<D>::id(2));
            EXPECT_EQ(impulse, value);
            EXPECT_FALSE(point.has_value());
        });
    }
    EXPECT_EQ(blows, 1);
    EXPECT_NEAR(when, 0.1, 1e-12) << "the step that begins at 6/60 s";
}

TYPED_TEST(ForcesIn, GoWithTheBodiesThatTheyName) {
    constexpr int D = TypeParam::value;
    Forces<D> forces;
    Spring<D> spring;
    spring.a = Bodies<D>::id(0);
    spring.b = Bodies<D>::id(1);
    spring.length = 1;
    const ForceId<D> joins = forces.add({spring});
    const ForceId<D> pulls = forces.add({ConstantForce<D>{Bodies<D>::id(0), {}}});
    const ForceId<D> brakes = forces.add({Drag<D>{Bodies<D>::id(1), 1, 0}});
    const ForceId<D> brakes_all = forces.add({Drag<D>{std::nullopt, 1, 0}});
    const ForceId<D> blows = forces.add({Wind<D>{}});
    EXPECT_EQ(forces.count(), 5);
    forces.remove_all_of(Bodies<D>::id(0));
    EXPECT_EQ(forces.count(), 3);
    EXPECT_FALSE(forces.contains(joins));
    EXPECT_FALSE(forces.contains(pulls));
    for (const ForceId<D>& id : {brakes, brakes_all, blows}) EXPECT_TRUE(forces.contains(id));
    forces.remove_all_of(Bodies<D>::id(1));
    EXPECT_EQ(forces.count(), 2);
    EXPECT_FALSE(forces.contains(brakes));
}

TYPED_TEST(ForcesIn, MarkTheBodiesWhoseLoadVaries) {
    constexpr int D = TypeParam::value;
    const auto marked = [](const ForceDefinition<D>& definition) {
        Forces<D> forces;
        forces.add(definition);
        std::vector<std::uint8_t> varies(3, 0);
        forces.mark_fields(0, std::array{0u, 1u, 2u}, varies);
        return varies;
    };
    using Marks = std::vector<std::uint8_t>;
    const auto id = &Bodies<D>::id;
    Spring<D> spring;
    spring.b = id(1);
    EXPECT_EQ(marked({ConstantForce<D>{id(1), {}}}), (Marks{0, 0, 0}));
    EXPECT_EQ(marked({ConstantTorque<D>{id(1), {}}}), (Marks{0, 0, 0}));
    EXPECT_EQ(marked({ConstantForce<D>{id(1), {}, std::nullopt, true}}), (Marks{0, 1, 0}));
    EXPECT_EQ(marked({ConstantForce<D>{id(1), {}, Vec<D>{}}}), (Marks{0, 1, 0}));
    EXPECT_EQ(marked({Drag<D>{id(2), 1, 0}}), (Marks{0, 0, 1}));
    EXPECT_EQ(marked({Drag<D>{std::nullopt, 1, 0}}), (Marks{1, 1, 1}));
    EXPECT_EQ(marked({Wind<D>{}}), (Marks{1, 1, 1}));
    EXPECT_EQ(marked({PointGravity<D>{}}), (Marks{1, 1, 1}));
    EXPECT_EQ(marked({spring}), (Marks{0, 1, 0}));
    EXPECT_EQ(marked({PointGravity<D>{}, 5, 6}), (Marks{0, 0, 0})) << "it does not act yet";
}

}  // namespace
}  // namespace carom::detail
