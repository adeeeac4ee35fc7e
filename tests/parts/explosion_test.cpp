#include "carom/parts/explosion.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::vec;

template <class T>
class Explosions : public testing::Test {};
TYPED_TEST_SUITE(Explosions, test::BothDimensions);

template <int D>
BodyId<D> add_ball(World<D>& world, const Vec<D>& position, double radius = 0.5) {
    BodyDefinition<D> ball;
    ball.position = position;
    ball.shapes.push_back({Ball{radius}});
    return world.add_body(ball);
}

template <int D>
WorldDefinition<D> weightless() {
    WorldDefinition<D> definition;
    definition.gravity = {};
    return definition;
}

TYPED_TEST(Explosions, PushAwayByTheCrossSectionAndTheFalloff) {
    constexpr int D = TypeParam::value;
    constexpr double pi = 3.14159265358979323846;
    World<D> world(weightless<D>());
    const BodyId<D> near = add_ball<D>(world, vec<D>(1.5, 0)), far = add_ball<D>(world, vec<D>(0, 3.5));
    const BodyId<D> beyond = add_ball<D>(world, vec<D>(-6, 0));
    const std::vector<BodyId<D>> pushed =
        explode(world, {.center = {}, .radius = 4, .pressure = 100, .falloff = Falloff::linear});
    ASSERT_EQ(pushed.size(), 2u);
    EXPECT_EQ(pushed[0], near);
    EXPECT_EQ(pushed[1], far);
    const double section = D == 2 ? 1 : pi / 4;
    const double mass = world.mass_properties(near).mass;
    EXPECT_NEAR(world.velocity(near).x, 0.75 * 100 * section / mass, 1e-12);
    EXPECT_NEAR(world.velocity(far).y, 0.25 * 100 * section / mass, 1e-12);
    EXPECT_EQ(world.velocity(beyond), Vec<D>{});
    explode(world, {.center = {}, .radius = 4, .pressure = 100, .falloff = Falloff::quadratic});
    EXPECT_NEAR(world.velocity(far).y, (0.25 + 0.0625) * 100 * section / mass, 1e-12);
    explode(world, {.center = {}, .radius = 4, .pressure = 100, .falloff = Falloff::none});
    EXPECT_NEAR(world.velocity(far).y, (1.25 + 0.0625) * 100 * section / mass, 1e-12);
}

TYPED_TEST(Explosions, AWallShields) {
    constexpr int D = TypeParam::value;
    World<D> world(weightless<D>());
    const BodyId<D> behind = add_ball<D>(world, vec<D>(3, 0)), beside = add_ball<D>(world, vec<D>(0, 3));
    BodyDefinition<D> wall;
    wall.type = BodyType::fixed;
    wall.position = vec<D>(1.5, 0);
    Box<D> box;
    for (int i = 0; i < D; ++i) box.size[i] = i == 0 ? 0.2 : 3;
    wall.shapes.push_back({box});
    world.add_body(wall);
    EXPECT_EQ(explode(world, {.center = {}}), std::vector<BodyId<D>>{beside});
    EXPECT_EQ(world.velocity(behind), Vec<D>{});
    EXPECT_EQ(explode(world, Explosion<D>{.center = {}, .shielded = false}).size(), 2u);
    EXPECT_GT(world.velocity(behind).x, 0);
}

TYPED_TEST(Explosions, WakeAndTurnWhatTheyHitAside) {
    constexpr int D = TypeParam::value;
    World<D> world(weightless<D>());
    BodyDefinition<D> plank;
    plank.position = vec<D>(2, 0);
    plank.shapes.push_back({Box<D>{vec<D>(0.2, 4, 0.2)}});
    const BodyId<D> body = world.add_body(plank);
    world.put_to_sleep(body);
    explode(world, {.center = vec<D>(0, 1.5)});
    EXPECT_TRUE(world.awake(body));
    EXPECT_LT(test::spin_speed<D>(world.angular_velocity(body)), 1e3);
    EXPECT_GT(test::spin_speed<D>(world.angular_velocity(body)), 1e-3);
}

TYPED_TEST(Explosions, RefuseWhatIsNone) {
    constexpr int D = TypeParam::value;
    World<D> world;
    EXPECT_THROW(explode(world, Explosion<D>{.radius = 0}), Error);
    EXPECT_THROW(explode(world, Explosion<D>{.pressure = -1}), Error);
    Explosion<D> nowhere;
    nowhere.center.x = std::nan("");
    EXPECT_THROW(explode(world, nowhere), Error);
}

}  // namespace
}  // namespace carom
