#include "carom/parts/rope.hpp"

#include <gtest/gtest.h>

#include "carom/error.hpp"
#include "world/builders.hpp"

namespace carom {
namespace {

using test::vec;

template <class T>
class Ropes : public testing::Test {};
TYPED_TEST_SUITE(Ropes, test::BothDimensions);

template <int D>
double worst_error(const World<D>& world) {
    double worst = 0;
    for (const JointId<D> joint : world.joints()) worst = std::max(worst, world.linear_error(joint));
    return worst;
}

TYPED_TEST(Ropes, HangStraightDownAndKeepTheirLength) {
    constexpr int D = TypeParam::value;
    for (const LinkKind kind : {LinkKind::rope, LinkKind::chain}) {
        World<D> world;
        RopeDefinition<D> definition;
        definition.path = {vec<D>(0, 0), vec<D>(2, 0), vec<D>(3, 0.5)};
        definition.kind = kind;
        definition.angular_damping = 2;
        definition.linear_damping = 0.5;
        const Rope<D> rope = add_rope(world, definition);
        EXPECT_EQ(rope.links.size(), 8u + 4u);
        EXPECT_EQ(rope.joints.size(), rope.links.size());
        for (int i = 0; i < 1200; ++i) world.step(test::frame_time);
        EXPECT_LT(worst_error(world), 1e-3);
        const double length = 2 + std::sqrt(1.25);
        EXPECT_NEAR(world.position(rope.links.back()).y, -(length - 0.5 * std::sqrt(1.25) / 4), 0.03);
    }
}

TYPED_TEST(Ropes, ABridgeCarriesWhatCrossesIt) {
    constexpr int D = TypeParam::value;
    World<D> world;
    RopeDefinition<D> definition;
    definition.path = {vec<D>(-3, 0), vec<D>(3, 0)};
    definition.kind = LinkKind::bridge;
    definition.link_length = 0.5;
    definition.thickness = 0.15;
    definition.width = 2;
    definition.hold_end = true;
    const Rope<D> bridge = add_rope(world, definition);
    EXPECT_EQ(bridge.links.size(), 12u);
    EXPECT_EQ(bridge.joints.size(), 13u);
    BodyDefinition<D> crate;
    crate.position = vec<D>(0, 0.5);
    crate.shapes.push_back({Box<D>{vec<D>(0.5, 0.5, 0.5)}});
    const BodyId<D> load = world.add_body(crate);
    for (int i = 0; i < 600; ++i) world.step(test::frame_time);
    EXPECT_GT(world.position(load).y, -1);
    EXPECT_LT(worst_error(world), 5e-3);
}

TYPED_TEST(Ropes, TieBodiesTogether) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> post;
    post.type = BodyType::fixed;
    BodyDefinition<D> ball;
    ball.position = vec<D>(2.2, 0);
    ball.shapes.push_back({Ball{0.2}});
    RopeDefinition<D> definition;
    definition.path = {vec<D>(0, 0), vec<D>(2, 0)};
    definition.start = world.add_body(post);
    definition.end = world.add_body(ball);
    definition.hold_end = true;
    add_rope(world, definition);
    for (int i = 0; i < 300; ++i) world.step(test::frame_time);
    EXPECT_LT(length(world.position(*definition.end)), 2.25);
}

TYPED_TEST(Ropes, RefuseWhatCannotBe) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const auto refused = [&](auto change, const std::string& message) {
        RopeDefinition<D> definition;
        definition.path = {vec<D>(0, 0), vec<D>(2, 0)};
        change(definition);
        try {
            add_rope(world, definition);
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).substr(0, message.size()), message);
        }
    };
    refused([](auto& rope) { rope.path.pop_back(); }, "path: 1 points are fewer than 2");
    refused([](auto& rope) { rope.path[1] = rope.path[0]; }, "path[1]: is the same point");
    refused([](auto& rope) { rope.link_length = 0; }, "link_length: 0 is not positive");
    refused([](auto& rope) { rope.thickness = 1; }, "thickness: 1 is not less than link_length, 0.25");
    refused([](auto& rope) { rope.break_force = 0; }, "break_force: 0 is not positive");
    refused([](auto& rope) { rope.end = BodyId<D>{7, 7}; }, "body: the handle names nothing");
    EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace carom
