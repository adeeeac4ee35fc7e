#include "carom/parts/character.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::frame_time;
using test::vec;

template <class T>
class Characters : public testing::Test {};
TYPED_TEST_SUITE(Characters, test::BothDimensions);

template <int D>
BodyId<D> add_box(World<D>& world, const Vec<D>& center, const Vec<D>& size,
                  BodyType type = BodyType::fixed) {
    BodyDefinition<D> body;
    body.type = type;
    body.position = center;
    body.shapes.push_back({Box<D>{size}});
    return world.add_body(body);
}

/// A floor of which the top is y = 0.
template <int D>
void add_floor(World<D>& world) {
    add_box<D>(world, vec<D>(0, -0.5), vec<D>(200, 1, 20));
}

template <int D>
Character<D> character_at(World<D>& world, const Vec<D>& position) {
    CharacterDefinition<D> definition;
    definition.position = position;
    return Character<D>(world, definition);
}

template <int D>
void walk(World<D>& world, Character<D>& character, const Vec<D>& velocity, double seconds) {
    for (int i = 0; i < seconds / frame_time; ++i) {
        character.move(world, velocity, frame_time);
        world.step(frame_time);
    }
}

TYPED_TEST(Characters, FallOntoTheGroundAndWalk) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_floor(world);
    Character<D> hero = character_at<D>(world, vec<D>(0, 1));
    EXPECT_FALSE(hero.on_ground());
    walk(world, hero, {}, 0.4);
    // Free fall, to rounding.
    EXPECT_NEAR(hero.position(world).y, 1 - 0.5 * 9.81 * 0.4 * 0.4, 1e-9);
    walk(world, hero, {}, 1);
    EXPECT_TRUE(hero.on_ground());
    EXPECT_NEAR(hero.position(world).y, 0.01, 2e-3);
    walk(world, hero, vec<D>(4, 0), 2);
    EXPECT_NEAR(hero.position(world).x, 8, 1e-6);
    EXPECT_TRUE(hero.on_ground());
}

TYPED_TEST(Characters, JumpAsHighAsTheirSpeedCarries) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_floor(world);
    Character<D> hero = character_at<D>(world, vec<D>(0, 0.02));
    walk(world, hero, {}, 0.5);
    const double ground = hero.position(world).y;
    hero.jump(5);
    double highest = 0;
    for (int i = 0; i < 60; ++i) {
        walk(world, hero, vec<D>(1, 0), frame_time);
        highest = std::max(highest, hero.position(world).y);
    }
    EXPECT_NEAR(highest - ground, 25 / (2 * 9.81), 0.01);
    walk(world, hero, {}, 0.5);
    EXPECT_TRUE(hero.on_ground());
    // In the air it cannot jump again.
    hero.jump(5);
    walk(world, hero, {}, 0.1);
    hero.jump(50);
    walk(world, hero, {}, frame_time);
    EXPECT_LT(hero.vertical_speed(), 5);
}

TYPED_TEST(Characters, ClimbStairsAndComeDownOnThem) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_floor(world);
    for (int i = 0; i < 8; ++i)
        add_box<D>(world, vec<D>(2 + 0.15 + 0.3 * i, 0.1 * (i + 1)), vec<D>(0.3, 0.2 * (i + 1), 4));
    add_box<D>(world, vec<D>(6.4, 0.8), vec<D>(4, 1.6, 4));
    Character<D> hero = character_at<D>(world, vec<D>(0, 0.02));
    walk(world, hero, {}, 0.3);
    walk(world, hero, vec<D>(2, 0), 3);
    EXPECT_NEAR(hero.position(world).y, 1.6, 0.02);
    EXPECT_NEAR(hero.position(world).x, 6, 0.5);  // steps take some of the way
    // On the way down it never leaves the ground.
    for (int i = 0; i < 180; ++i) {
        walk(world, hero, vec<D>(-2, 0), frame_time);
        EXPECT_TRUE(hero.on_ground()) << i;
    }
    EXPECT_NEAR(hero.position(world).y, 0.01, 0.01);
}

TYPED_TEST(Characters, AStepThatIsTooHighIsAWall) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_floor(world);
    add_box<D>(world, vec<D>(4, 0.25), vec<D>(2, 0.5, 4));
    Character<D> hero = character_at<D>(world, vec<D>(0, 0.02));
    walk(world, hero, {}, 0.3);
    walk(world, hero, vec<D>(3, 0), 3);
    EXPECT_LT(hero.position(world).x, 2.75);
    EXPECT_GT(hero.position(world).x, 2.6);
    EXPECT_NEAR(hero.position(world).y, 0.01, 5e-3);
}

TYPED_TEST(Characters, ThinWallsStopThemAtAnySpeed) {
    constexpr int D = TypeParam::value;
    for (const double speed : {1.0, 3.7, 10.0, 60.0, 100.0, 333.0, 1000.0}) {
        World<D> world;
        add_floor(world);
        add_box<D>(world, vec<D>(5, 1), vec<D>(0.002, 2, 10));
        Character<D> hero = character_at<D>(world, vec<D>(0, 0.02));
        walk(world, hero, {}, 0.3);
        for (int i = 0; i < 400; ++i) {
            walk(world, hero, vec<D>(speed, 0), frame_time);
            ASSERT_LT(hero.position(world).x, 5 - 0.3) << speed;
        }
        EXPECT_GT(hero.position(world).x, 5 - 0.3 - 0.03) << speed;
        // From above it does not pass through a thin floor either.
        add_box<D>(world, vec<D>(-20, 50), vec<D>(4, 0.002, 4));
        hero.place(world, vec<D>(-20, 300));
        CharacterDefinition<D> heavy;
        heavy.position = vec<D>(-20, 53);
        heavy.gravity = 100 * speed;
        Character<D> stone(world, heavy);
        walk(world, stone, {}, 2);
        EXPECT_NEAR(stone.position(world).y, 50.011, 5e-3) << speed;
    }
}

TYPED_TEST(Characters, WalkUpSlopesAndSlideOffSteepOnes) {
    constexpr int D = TypeParam::value;
    for (const double slope : {0.5, 0.75, 0.9, 1.2}) {
        World<D> world;
        add_floor(world);
        BodyDefinition<D> ramp;
        ramp.type = BodyType::fixed;
        ramp.shapes.push_back({Plane<D>{vec<D>(-std::sin(slope), std::cos(slope)), 0}});
        world.add_body(ramp);
        Character<D> hero = character_at<D>(world, vec<D>(-3, 0.02));
        walk(world, hero, {}, 0.2);
        walk(world, hero, vec<D>(2, 0), 4);
        if (slope < 0.8) {
            EXPECT_GT(hero.position(world).y, 1) << slope;
            const double height = hero.position(world).y;
            walk(world, hero, {}, 1);  // and stands there
            EXPECT_NEAR(hero.position(world).y, height, 1e-6) << slope;
        } else {
            EXPECT_LT(hero.position(world).y, 0.15) << slope;
            hero.place(world, vec<D>(3 * std::cos(slope) - 1, 3 * std::sin(slope) + 1));
            walk(world, hero, {}, 4);
            EXPECT_LT(hero.position(world).y, 0.2) << slope;
            EXPECT_LT(hero.position(world).x, 0.3) << slope;
        }
    }
}

TYPED_TEST(Characters, RideOnPlatforms) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_floor(world);
    const BodyId<D> lift = add_box<D>(world, vec<D>(0, 1), vec<D>(3, 0.2, 3), BodyType::kinematic);
    Character<D> hero = character_at<D>(world, vec<D>(0.5, 1.15));
    walk(world, hero, {}, 0.3);
    ASSERT_EQ(hero.ground(), lift);
    for (const Vec<D>& speed : {vec<D>(2, 0), vec<D>(0, 3), vec<D>(-1, -2), vec<D>(4, 1)}) {
        world.set_velocity(lift, speed);
        const Vec<D> before = hero.position(world) - world.position(lift);
        walk(world, hero, {}, 1);
        EXPECT_EQ(hero.ground(), lift);
        EXPECT_LT(length(hero.position(world) - world.position(lift) - before), 5e-3);
    }
}

TYPED_TEST(Characters, PushWhatIsLightEnough) {
    constexpr int D = TypeParam::value;
    for (const double mass : {20.0, 5000.0}) {
        World<D> world;
        add_floor(world);
        BodyDefinition<D> crate;
        crate.position = vec<D>(2, 0.4);
        crate.mass = mass;
        crate.shapes.push_back({Box<D>{vec<D>(0.8, 0.8, 0.8)}});
        const BodyId<D> body = world.add_body(crate);
        Character<D> hero = character_at<D>(world, vec<D>(0, 0.02));
        walk(world, hero, {}, 0.3);
        walk(world, hero, vec<D>(1.5, 0), 4);
        if (mass < 100) {
            EXPECT_GT(world.position(body).x, 4);
            EXPECT_LT(std::fabs(world.position(body).y - 0.4), 0.1);
        } else {
            EXPECT_NEAR(world.position(body).x, 2, 0.01);
            EXPECT_LT(hero.position(world).x, 1.31);
        }
    }
}

TEST(CharactersInSpace, SlideAlongWallsAndStopInCorners) {
    World3 world;
    add_floor(world);
    add_box<3>(world, {5, 2, 0}, {1, 4, 10});
    add_box<3>(world, {0, 2, 5}, {10, 4, 1});
    Character3 hero = character_at<3>(world, {3, 0.02, 0});
    walk(world, hero, {}, 0.3);
    walk(world, hero, {2, 0, 1}, 2);
    EXPECT_NEAR(hero.position(world).x, 4.5 - 0.31, 5e-3);
    EXPECT_GT(hero.position(world).z, 1.8);
    walk(world, hero, {2, 0, 1}, 5);
    EXPECT_NEAR(hero.position(world).x, 4.5 - 0.31, 5e-3);
    EXPECT_NEAR(hero.position(world).z, 4.5 - 0.31, 5e-3);
}

TEST(CharactersInSpace, WalkOnHeightFieldsAndMeshes) {
    World3 world;
    HeightField3 hills;
    for (int row = 0; row < 40; ++row) {
        hills.heights.emplace_back();
        for (int column = 0; column < 40; ++column)
            hills.heights.back().push_back(0.5 * std::sin(0.4 * row) * std::cos(0.3 * column));
    }
    hills.spacing = {0.5, 0.5};
    BodyDefinition3 ground;
    ground.type = BodyType::fixed;
    ground.position = {-10, 0, -10};
    ground.shapes.push_back({hills});
    world.add_body(ground);
    Character3 hero = character_at<3>(world, {-8, 2, -8});
    walk(world, hero, {}, 1);
    for (int i = 0; i < 300; ++i) {
        walk(world, hero, {3, 0, 2.5}, frame_time);
        EXPECT_TRUE(hero.on_ground()) << i;
        const Vec3 at = hero.position(world);
        const auto below = world.cast_ray({at + Vec3{0, 1, 0}, {0, -3, 0}}, {.ignored = hero.body()});
        ASSERT_TRUE(below) << i;
        EXPECT_NEAR(below->point.y, at.y, 0.12) << i;
    }
    EXPECT_GT(hero.position(world).x, 5);
}

TYPED_TEST(Characters, RefuseWhatCannotBe) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const auto refused = [&](auto change, const std::string& message) {
        CharacterDefinition<D> definition;
        change(definition);
        try {
            Character<D>(world, definition);
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
        }
    };
    refused([](auto& c) { c.height = 0.5; }, "height: 0.5 is not more than twice the radius, 0.3");
    refused([](auto& c) { c.radius = -1; }, "radius: -1 is not positive");
    refused([](auto& c) { c.max_slope = 2; }, "max_slope: 2 is not between");
    refused([](auto& c) { c.margin = 1; }, "margin: 1 is not less than the radius, 0.3");
    refused([](auto& c) { c.mass = 0; }, "mass: 0 is not positive");
    refused([](auto& c) { c.up = {}; }, "up: a direction has a length");
    EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace carom
