#include <gtest/gtest.h>

#include <map>

#include "world/builders.hpp"

// What the world tells of contacts and of movement after a step.

namespace carom::test {
namespace {

template <class T>
class Contacts : public testing::Test {};
TYPED_TEST_SUITE(Contacts, BothDimensions);

template <int D>
double normal_impulse(const Contact<D>& contact) {
    double sum = 0;
    for (int i = 0; i < contact.count; ++i) sum += contact.points[i].impulse;
    return sum;
}

TYPED_TEST(Contacts, SayWhoTouchesWhere) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    const BodyId<D> floor = world.add_body(ground<D>());
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(2, 0.52)));
    run(world, 120);
    const std::vector<Contact<D>> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1u);
    const Contact<D>& c = contacts[0];
    EXPECT_EQ(c.body_a, floor);
    EXPECT_EQ(c.body_b, box);
    EXPECT_EQ(c.shape_a, world.shapes(floor)[0]);
    EXPECT_EQ(c.shape_b, world.shapes(box)[0]);
    EXPECT_LT(length(c.normal - vec<D>(0, 1)), 1e-6) << "from a towards b";
    ASSERT_EQ(c.count, D == 2 ? 2 : 4);
    for (int i = 0; i < c.count; ++i) {
        const Vec<D> p = c.points[i].position;
        EXPECT_NEAR(std::fabs(p.x - 2), 0.5, 1e-3);
        EXPECT_NEAR(p.y, 0, 1e-3);
        EXPECT_NEAR(c.points[i].separation, 0, 1e-3);
        for (int k = 0; k < i; ++k) EXPECT_NE(c.points[i].feature, c.points[k].feature);
    }
}

/// At rest the floor's impulse carries the weight through the step.
TYPED_TEST(Contacts, CarryTheWeight) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5));
    d.mass = 12;
    world.add_body(d);
    run(world, 120);
    EXPECT_NEAR(normal_impulse(world.contacts().at(0)), 12 * 9.81 * frame_time, 1e-4);
    EXPECT_LT(length(world.contacts().at(0).friction_impulse), 1e-4);
}

/// Case B12 in small: under the k-th box from the top lies the weight of k.
TYPED_TEST(Contacts, CarryAColumn) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    constexpr int boxes = 8;
    for (int i = 0; i < boxes; ++i) {
        BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5 + i));
        d.mass = 1;
        world.add_body(d);
    }
    run(world, 300);
    std::map<std::uint32_t, double> under;
    for (const Contact<D>& c : world.contacts())
        under[std::max(c.body_a.index, c.body_b.index)] = normal_impulse(c);
    ASSERT_EQ(under.size(), static_cast<std::size_t>(boxes));
    for (int i = 1; i <= boxes; ++i) {
        const double weight = (boxes + 1 - i) * 9.81 * frame_time;
        EXPECT_NEAR(under[static_cast<std::uint32_t>(i)], weight, 0.01 * weight);
    }
}

/// A box that slides: friction is μ times the normal impulse, against the motion.
TYPED_TEST(Contacts, TellTheFriction) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    Material rough;
    rough.friction = 0.4;
    world.add_body(ground<D>(rough));
    BodyDefinition<D> d = body_of<D>(Box<D>{vec<D>(1, 0.2, 1)}, vec<D>(0, 0.1), rough);
    d.mass = 5;
    d.velocity = vec<D>(10, 0);
    world.add_body(d);
    run(world, 30);
    const Vec<D> expected = vec<D>(-0.4 * 5 * 9.81 * frame_time, 0);
    EXPECT_LT(length(world.contacts().at(0).friction_impulse - expected), 0.02 * length(expected));
}

/// An impact: the normal impulse is the change of momentum.
TYPED_TEST(Contacts, TellTheImpulseOfAnImpact) {
    constexpr int D = TypeParam::value;
    for (const double restitution : {0.0, 0.5, 1.0}) {
        World<D> world(no_gravity<D>());
        Material elastic;
        elastic.restitution = restitution;
        world.add_body(ground<D>(elastic));
        BodyDefinition<D> d = body_of<D>(Ball{0.5}, vec<D>(0, 0.55), elastic);
        d.mass = 3;
        d.velocity = vec<D>(0, -6);
        const BodyId<D> ball = world.add_body(d);
        world.step(frame_time);
        EXPECT_NEAR(normal_impulse(world.contacts().at(0)), 3 * 6 * (1 + restitution), 1e-4);
        EXPECT_NEAR(world.velocity(ball).y, 6 * restitution, 1e-5);
    }
}

TYPED_TEST(Contacts, FollowTheFilter) {
    constexpr int D = TypeParam::value;
    const auto touch = [](const Filter& a, const Filter& b) {
        World<D> world(no_gravity<D>());
        BodyDefinition<D> first = body_of<D>(Ball{1}), second = body_of<D>(Ball{1}, vec<D>(1, 0));
        first.shapes[0].filter = a;
        second.shapes[0].filter = b;
        world.add_body(first);
        world.add_body(second);
        world.step(frame_time);
        return world.counts().contacts == 1;
    };
    const std::uint64_t all = ~std::uint64_t{0}, high = std::uint64_t{1} << 63;
    EXPECT_TRUE(touch({}, {}));
    EXPECT_TRUE(touch({2, 4, 0}, {4, 2, 0}));
    EXPECT_TRUE(touch({high, high, 0}, {high, high, 0}));
    EXPECT_FALSE(touch({2, 4, 0}, {4, 1, 0})) << "both masks must agree";
    EXPECT_FALSE(touch({1, all, 0}, {1, 0, 0}));
    EXPECT_TRUE(touch({1, 0, 3}, {1, 0, 3})) << "one positive group always";
    EXPECT_FALSE(touch({1, all, -3}, {1, all, -3})) << "one negative group never";
    EXPECT_TRUE(touch({1, all, -3}, {1, all, -4})) << "other groups ask the masks";
    EXPECT_FALSE(touch({1, 0, 3}, {1, all, 4}));
}

TYPED_TEST(Contacts, ShapesOfOneBodyDoNotCollide) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> d = body_of<D>(Ball{1});
    d.shapes.push_back(shape_of<D>(Ball{1}));
    d.shapes[1].center = vec<D>(0.5, 0);
    const BodyId<D> body = world.add_body(d);
    const Vec<D> center = world.center_of_mass(body);
    run(world, 10);
    EXPECT_EQ(world.counts().contacts, 0);
    EXPECT_EQ(world.center_of_mass(body), center);
}

TYPED_TEST(Contacts, BodiesThatCannotMoveDoNotCollide) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(fixed_of<D>(Ball{1}));
    world.add_body(ground<D>());
    BodyDefinition<D> d = body_of<D>(Ball{1}, vec<D>(0.5, 0));
    d.type = BodyType::kinematic;
    d.velocity = vec<D>(0.1, 0);
    world.add_body(d);
    run(world, 5);
    EXPECT_EQ(world.counts().contacts, 0);
}

TYPED_TEST(Contacts, EndWithTheirShapes) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    const BodyId<D> floor = world.add_body(ground<D>());
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(world, 30);
    EXPECT_EQ(world.counts().contacts, 1);
    world.remove_shape(world.shapes(floor)[0]);
    EXPECT_EQ(world.counts().contacts, 0);
    EXPECT_TRUE(world.contacts().empty());
    run(world, 30);
    EXPECT_LT(world.position(box).y, 0);
}

TYPED_TEST(Contacts, BeginWhenAShapeIsAdded) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    const BodyId<D> holder = world.add_body([] {
        BodyDefinition<D> d;
        d.type = BodyType::fixed;
        return d;
    }());
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 1)));
    run(world, 10);
    world.add_shape(holder, shape_of<D>(Plane<D>{vec<D>(0, 1), 0}));
    run(world, 180);
    EXPECT_NEAR(world.position(box).y, 0.5, 2e-3);
}

/// A game that copies the placements of the moved bodies has the right ones for all bodies at any time.
TYPED_TEST(Contacts, MovedBodiesAreAllThatAGameNeeds) {
    constexpr int D = TypeParam::value;
    World<D> world;
    struct Object {
        Transform<D> placed{};
        BodyId<D> body{};
    };
    std::vector<Object> objects(14);
    const auto add = [&](std::size_t place, BodyDefinition<D> d) {
        d.user_data = place;
        const BodyId<D> body = world.add_body(d);
        objects[place] = {world.transform(body), body};
    };
    add(0, ground<D>());
    for (std::size_t i = 1; i < 12; ++i) {
        BodyDefinition<D> d =
            body_of<D>(cube<D>(0.5), vec<D>(0.1 * (i % 3), 0.3 + 0.6 * static_cast<double>(i)));
        d.shapes[0].center = vec<D>(0.1, 0);
        add(i, d);
    }
    BodyDefinition<D> lift = body_of<D>(cube<D>(1), vec<D>(9, 1));
    lift.type = BodyType::kinematic;
    lift.velocity = vec<D>(0, 0.25);
    add(12, lift);
    lift.velocity = {};
    add(13, lift);
    for (int i = 0; i < 900; ++i) {
        world.step(frame_time);
        for (const MovedBody<D>& moved : world.moved_bodies()) {
            ASSERT_EQ(objects[moved.user_data].body, moved.body);
            objects[moved.user_data].placed = moved.transform;
            ASSERT_NE(moved.user_data, 0u);
            ASSERT_NE(moved.user_data, 13u);
        }
        for (const Object& object : objects) ASSERT_EQ(object.placed, world.transform(object.body));
    }
    ASSERT_EQ(world.counts().awake, 0);
    ASSERT_EQ(world.moved_bodies().size(), 1u) << "all others sleep";
    EXPECT_EQ(world.moved_bodies()[0].user_data, 12u);
}

TYPED_TEST(Contacts, CountsSayWhatIsThere) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_body(ground<D>());
    BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 0.5));
    d.shapes.push_back(d.shapes[0]);
    const BodyId<D> body = world.add_body(d);
    world.add_force({Wind<D>{{}, 0}});
    Counts counts = world.counts();
    EXPECT_EQ(counts.bodies, 2);
    EXPECT_EQ(counts.shapes, 3);
    EXPECT_EQ(counts.forces, 1);
    EXPECT_EQ(counts.joints, 0);
    EXPECT_EQ(counts.awake, 1);
    EXPECT_EQ(counts.contacts, 0);
    world.step(frame_time);
    EXPECT_EQ(world.counts().contacts, 2);
    world.put_to_sleep(body);
    EXPECT_EQ(world.counts().awake, 0);
}

}  // namespace
}  // namespace carom::test
