#include "builders.hpp"

// Contact events and sensors.

namespace carom::test {
namespace {

template <class T>
struct Events : testing::Test {};
TYPED_TEST_SUITE(Events, BothDimensions);

TYPED_TEST(Events, a_ball_that_falls_begins_hits_and_keeps_touching) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    const BodyId<D> floor = world.add_body(ground<D>());
    const BodyId<D> ball = world.add_body(body_of<D>(Ball{0.5}, vec<D>(0, 5.5)));
    int begins = 0, ends = 0, hits = 0;
    for (int i = 0; i < 180; ++i) {
        world.step(frame_time);
        begins += static_cast<int>(world.contact_begins().size());
        ends += static_cast<int>(world.contact_ends().size());
        for (const ContactHit<D>& hit : world.contact_hits()) {
            ++hits;
            const double speed = std::sqrt(2 * 9.81 * 5), mass = world.mass_properties(ball).mass;
            EXPECT_NEAR(hit.approach_speed, speed, 1e-3 * speed);
            EXPECT_NEAR(std::fabs(hit.normal.y), 1, 1e-6);
            EXPECT_NEAR(hit.impulse, mass * speed, 0.02 * mass * speed);
            EXPECT_NEAR(hit.energy_lost, 0.5 * mass * speed * speed, 0.02 * 0.5 * mass * speed * speed);
            EXPECT_TRUE((hit.body_a == floor && hit.body_b == ball) ||
                        (hit.body_a == ball && hit.body_b == floor));
        }
    }
    EXPECT_EQ(begins, 1);
    EXPECT_EQ(ends, 0);
    EXPECT_EQ(hits, 1);
}

TYPED_TEST(Events, a_bounce_begins_and_ends_each_time) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    Material rubber;
    rubber.restitution = 0.9;
    world.add_body(ground<D>(rubber));
    world.add_body(body_of<D>(Ball{0.5}, vec<D>(0, 3.5), rubber));
    int begins = 0, ends = 0;
    for (int i = 0; i < 240; ++i) {
        world.step(frame_time);
        begins += static_cast<int>(world.contact_begins().size());
        ends += static_cast<int>(world.contact_ends().size());
    }
    // 0.78 s down, then bounces of 1.41, 1.27, … s: three times on the ground within 4 s.
    EXPECT_EQ(begins, 3);
    EXPECT_EQ(ends, 3);
}

TYPED_TEST(Events, a_removed_body_ends_its_contacts) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(world, 10);
    world.remove_body(box);
    world.step(frame_time);
    ASSERT_EQ(world.contact_ends().size(), 1u);
    const ContactEnd<D>& end = world.contact_ends()[0];
    EXPECT_TRUE(end.body_a == box || end.body_b == box);
    EXPECT_FALSE(world.contains(box));
    world.step(frame_time);
    EXPECT_TRUE(world.contact_ends().empty());
}

TYPED_TEST(Events, a_sensor_notices_who_comes_and_goes_and_pushes_nobody) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> gate = fixed_of<D>(cube<D>(1));
    gate.shapes[0].sensor = true;
    const BodyId<D> gate_body = world.add_body(gate);
    const ShapeId<D> sensor = world.shapes(gate_body)[0];
    BodyDefinition<D> walker = body_of<D>(Ball{0.25}, vec<D>(-2, 0));
    walker.velocity = vec<D>(3, 0);
    const BodyId<D> visitor = world.add_body(walker);
    double came = 0, went = 0;
    for (int i = 0; i < 120; ++i) {
        world.step(frame_time);
        for (const SensorBegin<D>& begin : world.sensor_begins()) {
            EXPECT_EQ(begin.shape_a, sensor);
            EXPECT_EQ(begin.body_b, visitor);
            came = world.position(visitor).x;
        }
        for (const SensorEnd<D>& end : world.sensor_ends()) {
            EXPECT_EQ(end.shape_a, sensor);
            went = world.position(visitor).x;
        }
        const bool is_inside = std::fabs(world.position(visitor).x) <= 0.75;
        EXPECT_EQ(world.inside(sensor).size(), is_inside ? 1u : 0u);
    }
    EXPECT_NEAR(came, -0.75, 0.051);
    EXPECT_NEAR(went, 0.75, 0.051);
    EXPECT_NEAR(world.velocity(visitor).x, 3, 1e-12);
    EXPECT_TRUE(world.contacts().empty());
    EXPECT_THROW(world.inside(world.shapes(visitor)[0]), Error);
}

TYPED_TEST(Events, a_sensor_notices_who_is_put_in_taken_out_or_removed) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> gate = fixed_of<D>(Ball{1});
    gate.shapes[0].sensor = true;
    const ShapeId<D> sensor = world.shapes(world.add_body(gate))[0];
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(5, 0)));
    world.step(frame_time);
    EXPECT_TRUE(world.inside(sensor).empty());
    world.set_transform(box, {vec<D>(0.5, 0), {}});
    world.step(frame_time);
    EXPECT_EQ(world.sensor_begins().size(), 1u);
    EXPECT_EQ(world.inside(sensor).size(), 1u);
    world.set_transform(box, {vec<D>(5, 0), {}});
    world.step(frame_time);
    EXPECT_EQ(world.sensor_ends().size(), 1u);
    world.set_transform(box, {vec<D>(0, 0.5), {}});
    world.step(frame_time);
    world.remove_body(box);
    EXPECT_TRUE(world.inside(sensor).empty());
    world.step(frame_time);
    EXPECT_EQ(world.sensor_ends().size(), 1u);
}

TYPED_TEST(Events, a_sensor_has_no_mass) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> body = body_of<D>(cube<D>(1));
    const double alone = world.mass_properties(world.add_body(body)).mass;
    ShapeDefinition<D> field = shape_of<D>(Ball{3});
    field.sensor = true;
    body.shapes.push_back(field);
    EXPECT_EQ(world.mass_properties(world.add_body(body)).mass, alone);
}

TYPED_TEST(Events, bodies_told_not_to_collide_pass_each_other_until_told_otherwise) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    const BodyId<D> floor = world.add_body(fixed_of<D>(Box<D>{vec<D>(10, 1, 10)}, vec<D>(0, -0.5)));
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    run(world, 30);
    EXPECT_NEAR(world.position(box).y, 0.5, 1e-3);
    world.set_collision(box, floor, false);
    run(world, 10);
    EXPECT_LT(world.position(box).y, 0.45);
    world.set_transform(box, {vec<D>(0, 2), {}});
    world.set_velocity(box, {});
    world.set_collision(box, floor, true);
    run(world, 120);
    EXPECT_NEAR(world.position(box).y, 0.5, 1e-3);
    EXPECT_THROW(world.set_collision(box, box, false), Error);
}

TYPED_TEST(Events, a_shape_is_changed_in_its_place) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    world.add_body(ground<D>());
    const BodyId<D> body = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.5)));
    const ShapeId<D> shape = world.shapes(body)[0];
    run(world, 30);
    const double mass = world.mass_properties(body).mass;
    world.set_shape(shape, shape_of<D>(Ball{1}));
    EXPECT_TRUE(world.contains(shape));
    EXPECT_GT(world.mass_properties(body).mass, mass);
    run(world, 180);
    EXPECT_NEAR(world.center_of_mass(body).y, 1, 2e-3);

    const std::uint64_t before = world.hash();
    EXPECT_THROW(world.set_shape(shape, shape_of<D>(Ball{-1})), Error);
    EXPECT_THROW(world.set_shape(shape, shape_of<D>(Plane<D>{vec<D>(0, 1), 0})), Error);
    EXPECT_EQ(world.hash(), before);
}

/// Contacts with ground name its facets, so none may outlive it.
TYPED_TEST(Events, ground_is_changed_under_what_lies_on_it) {
    constexpr int D = TypeParam::value;
    const auto flat = [](int cells) -> Geometry<D> {
        HeightField<D> field;
        if constexpr (D == 2)
            field.heights.assign(static_cast<std::size_t>(cells) + 1, 0.0);
        else
            field.heights.assign(static_cast<std::size_t>(cells) + 1,
                                 std::vector<double>(static_cast<std::size_t>(cells) + 1, 0.0));
        field.spacing.fill(20.0 / cells);
        return field;
    };
    World<D> world(sleepless<D>());
    const ShapeId<D> ground_shape =
        world.shapes(world.add_body(fixed_of<D>(flat(80), vec<D>(-10, 0, -10))))[0];
    const BodyId<D> box = world.add_body(body_of<D>(cube<D>(1), vec<D>(5, 0.5, 5)));
    for (const Geometry<D>& next : {flat(2), Geometry<D>(Box<D>{vec<D>(60, 0.02, 60)}), flat(40)}) {
        run(world, 60);
        world.set_shape(ground_shape, shape_of<D>(next));
    }
    run(world, 60);
    EXPECT_NEAR(world.position(box).y, 0.5, 0.02);
}

}  // namespace
}  // namespace carom::test
