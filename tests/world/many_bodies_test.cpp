#include "builders.hpp"
#include "collision/random.hpp"

// Bodies that are added many at a time.

namespace carom::test {
namespace {

template <class T>
struct ManyBodies : testing::Test {};
TYPED_TEST_SUITE(ManyBodies, BothDimensions);

template <int D>
BodyDefinition<D> stone() {
    BodyDefinition<D> body = body_of<D>(cube<D>(0.5));
    body.shapes.push_back(shape_of<D>(Ball{0.3}));
    body.shapes[1].center = vec<D>(0.4, 0.1);
    body.velocity = vec<D>(1, 2);
    body.name = "stone";
    body.user_data = 7;
    return body;
}

template <int D>
std::vector<Transform<D>> random_places(int count) {
    Random random(51);
    std::vector<Transform<D>> places;
    for (int i = 0; i < count; ++i) places.push_back(random.placement<D>(8));
    return places;
}

/// Two worlds that are added to in the two ways go the same way, bit by bit.
TYPED_TEST(ManyBodies, are_what_they_would_be_one_by_one) {
    constexpr int D = TypeParam::value;
    for (const BodyType type : {BodyType::dynamic, BodyType::fixed}) {
        World<D> at_once, one_by_one;
        for (World<D>* world : {&at_once, &one_by_one}) {
            const auto gone = world->add_body(unit_body<D>());
            world->add_body(unit_body<D>(vec<D>(50, 0)));
            world->remove_body(gone);  // its place is used again
        }
        BodyDefinition<D> body = stone<D>();
        body.type = type;
        if (type == BodyType::fixed) body.velocity = {};
        const auto places = random_places<D>(150);
        const auto added = at_once.add_bodies(body, places);
        ASSERT_EQ(added.size(), places.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            body.position = places[i].position;
            body.rotation = places[i].rotation;
            ASSERT_EQ(one_by_one.add_body(body), added[i]);
            ASSERT_EQ(at_once.name(added[i]), "stone");
            ASSERT_EQ(at_once.user_data(added[i]), 7u);
            ASSERT_TRUE(std::ranges::equal(at_once.shapes(added[i]), one_by_one.shapes(added[i])));
        }
        ASSERT_EQ(at_once.hash(), one_by_one.hash());
        run(at_once, 30);
        run(one_by_one, 30);
        EXPECT_EQ(at_once.hash(), one_by_one.hash());
    }
}

TYPED_TEST(ManyBodies, are_none_where_one_cannot_be) {
    constexpr int D = TypeParam::value;
    World<D> world;
    auto places = random_places<D>(5);
    places[3].position.y = std::nan("");
    try {
        world.add_bodies(stone<D>(), places);
        ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("places[3].position")) << error.what();
    }
    EXPECT_EQ(world.counts().bodies, 0);
    EXPECT_TRUE(world.add_bodies(stone<D>(), {}).empty());
    BodyDefinition<D> wrong = stone<D>();
    wrong.mass = -1;
    EXPECT_THROW(world.add_bodies(wrong, random_places<D>(2)), Error);
    EXPECT_EQ(world.counts().bodies, 0);
}

/// Bodies share one terrain, which is not kept when they are gone.
TYPED_TEST(ManyBodies, may_stand_on_copies_of_one_ground) {
    constexpr int D = TypeParam::value;
    HeightField<D> field;
    if constexpr (D == 2)
        field = {.heights = {0, 0, 0}, .spacing = {1}};
    else
        field = {.heights = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, .spacing = {1, 1}};
    World<D> world;
    std::vector<Transform<D>> places(3);
    for (int i = 0; i < 3; ++i) places[std::size_t(i)].position = vec<D>(10 * i, i);
    const auto grounds = world.add_bodies(fixed_of<D>(field), places);
    for (int i = 0; i < 3; ++i) {
        const Ray<D> down{vec<D>(10 * i + 0.5, 10, 0.5), vec<D>(0, -20)};
        const auto hit = world.cast_ray(down);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->point.y, i, 1e-9);
        EXPECT_EQ(hit->body, grounds[std::size_t(i)]);
    }
}

}  // namespace
}  // namespace carom::test
