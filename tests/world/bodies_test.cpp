#include <gtest/gtest.h>

#include <map>

#include "collision/random.hpp"
#include "world/builders.hpp"

// Bodies and shapes come and go at any time; handles tell what is still there.

namespace carom::test {
namespace {

template <class T>
class Bodies : public testing::Test {};
TYPED_TEST_SUITE(Bodies, BothDimensions);

TYPED_TEST(Bodies, AnEmptyWorldSteps) {
    constexpr int D = TypeParam::value;
    World<D> world;
    run(world, 10);
    EXPECT_EQ(world.steps(), 10u);
    EXPECT_NEAR(world.time(), 10.0 / 60, 1e-15);
    EXPECT_TRUE(world.bodies().empty());
    EXPECT_TRUE(world.moved_bodies().empty());
    EXPECT_TRUE(world.contacts().empty());
    EXPECT_EQ(world.counts().bodies, 0);
    EXPECT_EQ(world.energy().total(), 0);
}

TYPED_TEST(Bodies, AreAsTheyWereDefined) {
    constexpr int D = TypeParam::value;
    Random random(1);
    BodyDefinition<D> d = body_of<D>(cube<D>(1), random.in_cube<D>(5));
    d.rotation = random.rotation<D>();
    d.shapes.push_back(shape_of<D>(Ball{0.3}));
    d.shapes[1].center = vec<D>(2, 1);
    d.shapes[1].user_data = 77;
    d.velocity = random.in_cube<D>(3);
    d.angular_velocity = spin<D>(2.5);
    d.name = "crate";
    d.user_data = 123456789012345;
    World<D> world;
    const BodyId<D> body = world.add_body(d);

    EXPECT_LT(length(world.position(body) - d.position), 1e-15);
    EXPECT_EQ(world.rotation(body), normalized(d.rotation));
    EXPECT_EQ(world.velocity(body), d.velocity);
    EXPECT_EQ(world.angular_velocity(body), d.angular_velocity);
    EXPECT_EQ(world.name(body), "crate");
    EXPECT_EQ(world.user_data(body), 123456789012345u);
    EXPECT_EQ(world.type(body), BodyType::dynamic);
    EXPECT_TRUE(world.awake(body));
    ASSERT_EQ(world.shapes(body).size(), 2u);
    const ShapeId<D> second = world.shapes(body)[1];
    EXPECT_EQ(world.shape(second).user_data, 77u);
    EXPECT_EQ(world.shape(second).center, vec<D>(2, 1));
    EXPECT_EQ(world.body_of(second), body);
    const Vec<D> center = apply(world.transform(body), world.mass_properties(body).center);
    EXPECT_LT(length(world.center_of_mass(body) - center), 1e-15);
    const Vec<D> point = random.in_cube<D>(9);
    EXPECT_LT(length(world.velocity_at(body, point) -
                     (d.velocity + cross(d.angular_velocity, point - world.center_of_mass(body)))),
              1e-14);
    world.set_user_data(body, 5);
    EXPECT_EQ(world.user_data(body), 5u);
}

TYPED_TEST(Bodies, AHandleNamesNothingOnceItsBodyIsRemoved) {
    constexpr int D = TypeParam::value;
    World<D> world;
    const BodyId<D> first = world.add_body(body_of<D>(Ball{1}));
    const ShapeId<D> shape = world.shapes(first)[0];
    world.remove_body(first);
    const BodyId<D> second = world.add_body(body_of<D>(Ball{2}));
    EXPECT_EQ(first.index, second.index) << "the place is used again";
    EXPECT_FALSE(world.contains(first));
    EXPECT_FALSE(world.contains(shape));
    EXPECT_TRUE(world.contains(second));
    EXPECT_THROW(world.position(first), Error);
    EXPECT_THROW(world.shape(shape), Error);
    EXPECT_THROW(world.remove_body(first), Error);
    EXPECT_FALSE(world.contains(BodyId<D>{}));
    EXPECT_FALSE(BodyId<D>{});
    EXPECT_TRUE(second);
}

/// A body that takes over a place has nothing of the one that was there.
TYPED_TEST(Bodies, AUsedPlaceIsAsGoodAsNew) {
    constexpr int D = TypeParam::value;
    World<D> used, fresh;
    BodyDefinition<D> odd = body_of<D>(cube<D>(1), vec<D>(3, 0.4));
    odd.velocity = vec<D>(-5, 3);
    odd.angular_velocity = spin<D>(7);
    odd.gravity_scale = 3;
    odd.linear_damping = odd.angular_damping = 1;
    odd.locks = {true, false, true, true, true, false};
    odd.can_sleep = false;
    const BodyId<D> old = used.add_body(odd);
    used.apply_force(old, vec<D>(50, 60), vec<D>(1, 1));
    used.remove_body(old);
    std::vector<BodyId<D>> ids;
    for (World<D>* world : {&used, &fresh}) {
        world->add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.6)));
        ids.push_back(world->add_body(ground<D>()));
        run(*world, 100);
    }
    const BodyId<D> in_used = used.bodies()[0], in_fresh = fresh.bodies()[0];
    EXPECT_EQ(in_used.index, old.index);
    EXPECT_EQ(used.transform(in_used), fresh.transform(in_fresh));
    EXPECT_EQ(used.awake(in_used), fresh.awake(in_fresh));
    EXPECT_EQ(used.energy().total(), fresh.energy().total());
}

TYPED_TEST(Bodies, EnergyForgetsTheRemoved) {
    constexpr int D = TypeParam::value;
    World<D> world;
    world.add_force({PointGravity<D>{{}, 1}});
    world.add_body(unit_body<D>(vec<D>(1, 0)));
    const double one = world.energy().total();
    const BodyId<D> second = world.add_body(unit_body<D>(vec<D>(2, 0)));
    EXPECT_NEAR(world.energy().total(), one - 0.5, 1e-15);
    world.remove_body(second);
    EXPECT_EQ(world.energy().total(), one);
}

TYPED_TEST(Bodies, TheLastShapeMayGoWhenTheMassIsGiven) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> d = body_of<D>(Ball{1});
    d.mass = 3;
    const BodyId<D> body = world.add_body(d);
    world.remove_shape(world.shapes(body)[0]);
    EXPECT_TRUE(world.shapes(body).empty());
    EXPECT_EQ(world.counts().shapes, 0);
    run(world, 10);
    EXPECT_NEAR(world.velocity(body).y, -9.81 / 6, 1e-12);
    const ShapeId<D> shape = world.add_shape(body, shape_of<D>(Ball{0.5}));
    EXPECT_EQ(world.body_of(shape), body);
    EXPECT_EQ(world.mass_properties(body).mass, 3);
}

/// What the test expects of the world: what is there, in which order.
template <int D>
struct Model {
    struct Entry {
        std::uint64_t user_data;
        std::vector<ShapeId<D>> shapes;
    };
    std::vector<BodyId<D>> order;
    std::map<std::uint32_t, Entry> entries;
    std::vector<BodyId<D>> dead;
    std::vector<ShapeId<D>> dead_shapes;
};

template <int D>
BodyDefinition<D> random_body(Random& random, std::uint64_t user_data) {
    BodyDefinition<D> d;
    const int type = random.below(4);
    d.type = type == 0 ? BodyType::fixed : type == 1 ? BodyType::kinematic : BodyType::dynamic;
    d.position = random.in_cube<D>(4);
    d.rotation = random.rotation<D>();
    d.velocity = random.in_cube<D>(3);
    d.angular_velocity = spin<D>(random.between(-3, 3));
    for (int i = random.below(3); i >= 0; --i) {
        d.shapes.push_back(random.below(2) ? shape_of<D>(Ball{random.between(0.1, 0.6)})
                                           : shape_of<D>(cube<D>(random.between(0.1, 0.8))));
        d.shapes.back().center = random.in_cube<D>(0.5);
    }
    d.user_data = user_data;
    return d;
}

template <int D>
void expect_same(const World<D>& world, const Model<D>& model) {
    ASSERT_EQ(std::vector<BodyId<D>>(world.bodies().begin(), world.bodies().end()), model.order);
    int shapes = 0;
    for (const BodyId<D>& body : model.order) {
        const auto& entry = model.entries.at(body.index);
        shapes += static_cast<int>(entry.shapes.size());
        ASSERT_TRUE(world.contains(body));
        ASSERT_EQ(world.user_data(body), entry.user_data);
        ASSERT_EQ(std::vector<ShapeId<D>>(world.shapes(body).begin(), world.shapes(body).end()),
                  entry.shapes);
        for (const ShapeId<D>& shape : entry.shapes) ASSERT_EQ(world.body_of(shape), body);
    }
    ASSERT_EQ(world.counts().bodies, static_cast<int>(model.order.size()));
    ASSERT_EQ(world.counts().shapes, shapes);
    for (const BodyId<D>& body : model.dead) ASSERT_FALSE(world.contains(body));
    for (const ShapeId<D>& shape : model.dead_shapes) ASSERT_FALSE(world.contains(shape));
    for (const Contact<D>& contact : world.contacts()) {
        ASSERT_TRUE(world.contains(contact.shape_a) && world.contains(contact.shape_b));
        ASSERT_EQ(world.body_of(contact.shape_a), contact.body_a);
        ASSERT_EQ(world.body_of(contact.shape_b), contact.body_b);
    }
}

/// One random command to the world and its model.
template <int D>
void command(World<D>& world, Model<D>& model, Random& random, std::uint64_t number) {
    if (model.order.size() < 4 || (model.order.size() < 40 && random.below(3) == 0)) {
        const BodyId<D> body = world.add_body(random_body<D>(random, number));
        model.order.push_back(body);
        model.entries[body.index] = {number, {world.shapes(body).begin(), world.shapes(body).end()}};
        return;
    }
    const BodyId<D> body =
        model.order[static_cast<std::size_t>(random.below(static_cast<int>(model.order.size())))];
    auto& entry = model.entries[body.index];
    switch (random.below(6)) {
        case 0:
            world.remove_body(body);
            model.dead.push_back(body);
            for (const ShapeId<D>& shape : entry.shapes) model.dead_shapes.push_back(shape);
            model.entries.erase(body.index);
            std::erase(model.order, body);
            break;
        case 1:
            entry.shapes.push_back(world.add_shape(body, shape_of<D>(Ball{random.between(0.1, 0.5)})));
            break;
        case 2:
            if (entry.shapes.size() > 1) {
                const auto which = random.bits() % entry.shapes.size();
                const ShapeId<D> shape = entry.shapes[which];
                world.remove_shape(shape);
                model.dead_shapes.push_back(shape);
                entry.shapes.erase(entry.shapes.begin() + static_cast<std::ptrdiff_t>(which));
            }
            break;
        case 3: {
            constexpr BodyType types[] = {BodyType::dynamic, BodyType::kinematic, BodyType::fixed};
            world.set_type(body, types[random.below(3)]);
            break;
        }
        case 4:
            world.set_transform(body, random.placement<D>(4));
            break;
        default:
            run(world, 1);
    }
}

TYPED_TEST(Bodies, ComeAndGoAsInASimpleModel) {
    constexpr int D = TypeParam::value;
    Random random(99);
    World<D> world;
    world.add_force({Wind<D>{vec<D>(1, 0), 1.2}});
    Model<D> model;
    for (std::uint64_t i = 0; i < 1500; ++i) {
        command(world, model, random, i);
        if (i % 10 == 0) expect_same(world, model);
        if (testing::Test::HasFatalFailure()) FAIL() << "after command " << i;
    }
    for (const BodyId<D>& body : std::vector<BodyId<D>>(model.order)) world.remove_body(body);
    EXPECT_EQ(world.counts().bodies, 0);
    EXPECT_EQ(world.counts().shapes, 0);
    EXPECT_EQ(world.counts().contacts, 0);
    run(world, 2);
    EXPECT_EQ(world.energy().total(), 0);
}

}  // namespace
}  // namespace carom::test
