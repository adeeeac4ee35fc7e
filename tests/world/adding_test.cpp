#include <atomic>
#include <thread>

#include "builders.hpp"
#include "collision/random.hpp"

// Many bodies at once, and what is asked before the first step.

namespace carom::test {
namespace {

template <class T>
struct Adding : testing::Test {};
TYPED_TEST_SUITE(Adding, BothDimensions);

template <int D>
BodyDefinition<D> random_body(Random& random) {
    BodyDefinition<D> body = body_of<D>(Ball{0.3}, random.in_cube<D>(20));
    body.shapes.push_back(shape_of<D>(cube<D>(0.5), {}));
    body.shapes[1].center = vec<D>(0.7, 0.2);
    body.rotation = random.rotation<D>();
    body.type = random.below(3) == 0 ? BodyType::fixed : BodyType::dynamic;
    switch (random.below(5)) {
        case 0:
            body.mass = 3;
            break;
        case 1:
            body.shapes[1].material.density = 50;
            break;
        case 2:
            body.shapes.pop_back();
            break;
        case 3:
            body.locks.x = body.locks.rz = true;
            break;
        default:
            break;
    }
    return body;
}

/// A body comes out the same whatever was added before it.
TYPED_TEST(Adding, what_is_like_the_last_body_is_what_it_would_be_alone) {
    constexpr int D = TypeParam::value;
    Random random(31);
    World<D> world;
    for (int i = 0; i < 300; ++i) {
        BodyDefinition<D> body = random_body<D>(random);
        for (int again = 0; again < 3; ++again) {
            body.position = random.in_cube<D>(20);
            body.velocity = body.type == BodyType::fixed ? Vec<D>{} : random.in_cube<D>(1);
            body.name = "body " + std::to_string(again);
            body.user_data = static_cast<std::uint64_t>(again);
            const BodyId<D> id = world.add_body(body);
            World<D> alone;
            const BodyId<D> single = alone.add_body(body);
            ASSERT_EQ(world.center_of_mass(id), alone.center_of_mass(single));
            ASSERT_EQ(world.velocity(id), alone.velocity(single));
            ASSERT_EQ(world.mass_properties(id).mass, alone.mass_properties(single).mass);
            ASSERT_EQ(world.mass_properties(id).inertia, alone.mass_properties(single).inertia);
            ASSERT_EQ(world.name(id), body.name);
            ASSERT_EQ(world.user_data(id), body.user_data);
            ASSERT_EQ(world.shapes(id).size(), body.shapes.size());
            for (std::size_t k = 0; k < body.shapes.size(); ++k)
                ASSERT_EQ(world.shape(world.shapes(id)[k]), body.shapes[k]);
        }
    }
    EXPECT_THROW(world.add_body({.mass = -1.0}), Error);
}

/// Shapes that were just added, moved or removed are found where they are, before any step and after.
TYPED_TEST(Adding, questions_find_what_was_just_added) {
    constexpr int D = TypeParam::value;
    Random random(32);
    World<D> world;
    std::vector<BodyId<D>> bodies;
    const auto expect_found = [&] {
        for (const BodyId<D>& id : bodies) {
            const auto found = world.at_point(world.position(id));
            for (const ShapeId<D>& shape : found) ASSERT_TRUE(world.contains(shape));
            ASSERT_TRUE(std::ranges::count(found, world.shapes(id)[0]));
        }
    };
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 40; ++i) bodies.push_back(world.add_body(random_body<D>(random)));
        for (int i = 0; i < 10; ++i) {
            const auto k = static_cast<std::size_t>(random.below(static_cast<int>(bodies.size())));
            world.remove_body(bodies[k]);
            bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(k));
            const auto m = static_cast<std::size_t>(random.below(static_cast<int>(bodies.size())));
            world.set_transform(bodies[m], {random.in_cube<D>(20), random.rotation<D>()});
        }
        expect_found();
        if (round % 4 != 3) continue;
        world.step(frame_time);
        expect_found();
    }
}

/// The first question after a body was added may come from any thread.
TYPED_TEST(Adding, several_threads_may_ask_at_once) {
    constexpr int D = TypeParam::value;
    Random random(33);
    World<D> world;
    for (int round = 0; round < 20; ++round) {
        std::vector<BodyId<D>> bodies;
        for (int i = 0; i < 50; ++i) bodies.push_back(world.add_body(random_body<D>(random)));
        std::atomic<int> missed = 0;
        std::vector<std::jthread> threads;
        for (int t = 0; t < 4; ++t) {
            threads.emplace_back([&] {
                for (const BodyId<D>& id : bodies) missed += world.at_point(world.position(id)).empty();
            });
        }
        threads.clear();
        ASSERT_EQ(missed, 0);
    }
}

/// Fixed, resting and moving shapes are kept apart; that shows in no answer.
TYPED_TEST(Adding, who_rests_moves_or_stands_is_found_alike) {
    constexpr int D = TypeParam::value;
    World<D> world({.gravity = {}});
    const BodyId<D> body = world.add_body(body_of<D>(Ball{0.5}, vec<D>(0, 0)));
    const auto expect_there = [&](double x) {
        ASSERT_EQ(world.at_point(vec<D>(x, 0)).size(), 1u);
        ASSERT_TRUE(world.cast_ray({vec<D>(x, 9), vec<D>(0, -18)}));
        ASSERT_TRUE(world.nearest_point(vec<D>(x, 3), 5));
        ASSERT_TRUE(world.at_point(vec<D>(x + 50, 0)).empty());
    };
    for (int round = 0; round < 3; ++round) {
        for (const BodyType type : {BodyType::fixed, BodyType::dynamic, BodyType::kinematic}) {
            world.set_type(body, type);
            expect_there(0);
            world.step(frame_time);
            expect_there(0);
            if (type == BodyType::fixed) continue;
            world.set_velocity(body, vec<D>(60, 0));
            world.step(frame_time);
            expect_there(1);
            world.set_velocity(body, vec<D>(-60, 0));
            world.step(frame_time);
            expect_there(0);
            world.set_velocity(body, {});
            if (type == BodyType::dynamic) world.put_to_sleep(body);
            world.step(frame_time);
            expect_there(0);
            world.wake(body);
            world.step(frame_time);
            expect_there(0);
        }
    }
}

}  // namespace
}  // namespace carom::test
