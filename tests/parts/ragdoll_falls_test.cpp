#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "carom/parts/ragdoll.hpp"
#include "collision/random.hpp"
#include "world/builders.hpp"

// Figures of random bones fall into pits and onto one another. Nothing drives them, so they may gain no
// energy, and they hold together.

// GCC 12 takes the values of empty optionals, which a variant moves along, for uninitialised reads.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace carom::test {
namespace {

std::optional<JointLimits> sometimes_limits(Random& random) {
    if (random.below(3) == 0) return {};
    return JointLimits{-random.between(0.05, 2), random.between(0.05, 2)};
}

template <int D>
decltype(JointDefinition<D>::kind) random_joint(Random& random, const Vec<D>& anchor, const Vec<D>& limb) {
    std::optional<JointSpring> spring;
    if (random.below(3) == 0)
        spring = JointSpring{.frequency = random.between(0.5, 10), .damping_ratio = random.between(0, 1)};
    const double friction = random.below(3) == 0 ? random.between(0, 20) : 0;
    if constexpr (D == 3) {
        if (random.below(2) == 0) {
            BallJoint<3> ball{.anchor = anchor, .axis = limb, .spring = spring, .friction = friction};
            if (random.below(3) != 0) ball.swing_limit = random.between(0.2, 3);
            if (random.below(2) == 0) ball.twist_limits = sometimes_limits(random);
            return ball;
        }
    }
    HingeJoint<D> hinge{.anchor = anchor, .limits = sometimes_limits(random), .spring = spring};
    if constexpr (D == 3) hinge.axis = random.direction<3>();
    if (friction > 0) hinge.motor = JointMotor{.speed = 0, .max = friction};
    return hinge;
}

template <int D>
RagdollDefinition<D> random_figure(Random& random) {
    RagdollDefinition<D> figure;
    std::vector<Vec<D>> ends;
    const int count = 3 + random.below(5);
    for (int i = 0; i < count; ++i) {
        Bone<D> bone;
        bone.parent = i == 0 ? -1 : std::max(0, i - 1 - random.below(4));
        const Vec<D> from = i == 0 ? Vec<D>{} : ends[static_cast<std::size_t>(bone.parent)];
        const Vec<D> limb = random.direction<D>(), to = from + random.between(0.15, 0.35) * limb;
        ends.push_back(to);
        bone.body = body_of<D>(Capsule<D>{0.5 * (from - to), 0.5 * (to - from), random.between(0.04, 0.15)},
                               0.5 * (from + to), {.friction = random.between(0, 1)});
        bone.body.shapes[0].filter.group = -1;
        if (i > 0) bone.joint = random_joint<D>(random, from, limb);
        figure.bones.push_back(bone);
    }
    return figure;
}

/// One that fits between the walls of the pits as it starts.
template <int D>
RagdollDefinition<D> small_figure(Random& random) {
    for (;;) {
        const RagdollDefinition<D> figure = random_figure<D>(random);
        const auto is_near = [](const Bone<D>& bone) { return length(bone.body.position) < 0.7; };
        if (std::ranges::all_of(figure.bones, is_near)) return figure;
    }
}

/// A shaft so wide, open above.
template <int D>
BodyDefinition<D> shaft(double width) {
    BodyDefinition<D> pit;
    pit.type = BodyType::fixed;
    const auto wall = [&](const Vec<D>& center, const Vec<D>& size) {
        pit.shapes.push_back(shape_of<D>(Box<D>{size}));
        pit.shapes.back().center = center;
    };
    const double height = 300, off = width / 2 + 2;
    wall(vec<D>(0, -2), vec<D>(width + 8, 4, width + 8));
    for (const double side : {-1.0, 1.0}) {
        wall(vec<D>(side * off, height / 2), vec<D>(4, height, width + 8));
        if (D == 3) wall(vec<D>(0, height / 2, side * off), vec<D>(width + 8, height, 4));
    }
    return pit;
}

struct Course {
    double growth = 0;   ///< the most energy that a step gave, in parts of that of the start
    double fastest = 0;  ///< m/s
    double torn = 0;     ///< how far a joint is apart at the end, m
    bool lost = false;   ///< was anything quarantined?
};

template <int D>
Course fall(std::uint64_t seed, bool into_pit) {
    Random random(seed);
    World<D> world;
    const double width = into_pit ? random.between(2, 2.4) : random.between(4, 6);
    const double height = into_pit ? random.between(10, 40) : random.between(3, 10), spread = width - 2;
    world.add_body(shaft<D>(width));
    const int count = 8;
    for (int i = 0; i < count; ++i) {
        RagdollPlace<D> place;
        place.placed.position =
            vec<D>(spread * random.between(-0.5, 0.5), height + 2.0 * i, spread * random.between(-0.5, 0.5));
        if (random.below(2) == 0) place.placed.rotation = random.rotation<D>();
        place.group = -(i + 1);
        add_ragdoll(world, small_figure<D>(random), place);
    }
    const double start = world.energy().total();
    Course course;
    double before = start;
    const int steps = static_cast<int>(60 * std::sqrt(2 * (height + 2.0 * count) / 9.81)) + 180;
    for (int i = 0; i < steps; ++i) {
        world.step(frame_time);
        const double now = world.energy().total();
        course.growth = std::max(course.growth, (now - before) / start);
        before = now;
        for (const BodyId<D> body : world.bodies())
            course.fastest = std::max(
                course.fastest, length(world.velocity(body)) / std::sqrt(2 * 9.81 * (height + 2.0 * count)));
        course.lost = course.lost || !world.quarantined().empty();
    }
    for (const JointId<D> joint : world.joints())
        course.torn = std::max(course.torn, world.linear_error(joint));
    return course;
}

template <class T>
class FallingFigures : public testing::Test {};
TYPED_TEST_SUITE(FallingFigures, BothDimensions);

TYPED_TEST(FallingFigures, GainNoEnergyAndHoldTogether) {
    constexpr int D = TypeParam::value;
    // A fall takes as long as many a case of other tests.
    const int falls = std::max(1, trials(60) / 20);
    for (int i = 0; i < falls; ++i) {
        for (const bool into_pit : {true, false}) {
            const Course course = fall<D>(static_cast<std::uint64_t>(i), into_pit);
            EXPECT_FALSE(course.lost) << i;
            EXPECT_LT(course.growth, 0.02) << i << (into_pit ? " pit" : " pile");
            EXPECT_LT(course.fastest, 1.5) << i << (into_pit ? " pit" : " pile");
            EXPECT_LT(course.torn, 0.02) << i << (into_pit ? " pit" : " pile");
        }
    }
}

}  // namespace
}  // namespace carom::test
