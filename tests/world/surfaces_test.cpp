#include "builders.hpp"
#include "collision/random.hpp"

// Seams between fixed shapes, one-way shapes, conveyor belts.

namespace carom::test {
namespace {

template <class T>
struct Surfaces : testing::Test {};
TYPED_TEST_SUITE(Surfaces, BothDimensions);

struct Floor {
    std::vector<double> joints;  ///< where one tile ends and the next begins
    bool compound = false;       ///< one body of many shapes, or many bodies
};

template <int D>
void add_floor(World<D>& world, const Floor& floor, const Material& material) {
    BodyDefinition<D> whole;
    whole.type = BodyType::fixed;
    for (std::size_t i = 0; i + 1 < floor.joints.size(); ++i) {
        const double from = floor.joints[i], to = floor.joints[i + 1];
        ShapeDefinition<D> tile = shape_of<D>(Box<D>{vec<D>(to - from, 1, 20)}, material);
        tile.center = vec<D>((from + to) / 2, -0.5);
        whole.shapes.push_back(tile);
    }
    if (floor.compound) {
        world.add_body(whole);
        return;
    }
    for (const ShapeDefinition<D>& tile : whole.shapes) {
        BodyDefinition<D> body;
        body.type = BodyType::fixed;
        body.shapes = {tile};
        world.add_body(body);
    }
}

template <int D>
Geometry<D> slider(int kind) {
    switch (kind) {
        case 0:
            return Ball{0.5};
        case 1:
            return cube<D>(1);
        case 2:
            return Capsule<D>{vec<D>(-0.3, 0), vec<D>(0.3, 0), 0.5};
        default:
            return Box<D>{vec<D>(1, 1, 1), 0.1};
    }
}

struct Ride {
    double vertical = 0;  ///< the largest vertical speed
    double left = 0;      ///< speed along the floor at the end
};

template <int D>
Ride ride(const Floor& floor, int kind, double speed, double friction, int steps) {
    World<D> world(sleepless<D>());
    Material material;
    material.friction = friction;
    add_floor<D>(world, floor, material);
    BodyDefinition<D> body = body_of<D>(slider<D>(kind), vec<D>(0, 0.5), material);
    body.velocity = vec<D>(speed, 0);
    const BodyId<D> id = world.add_body(body);
    Ride result;
    for (int i = 0; i < steps; ++i) {
        world.step(frame_time);
        result.vertical = std::max(result.vertical, std::fabs(world.velocity(id).y));
    }
    result.left = world.velocity(id).x;
    return result;
}

TYPED_TEST(Surfaces, tiles_are_felt_no_more_than_a_single_floor) {
    constexpr int D = TypeParam::value;
    Random random(7);
    const int count = trials(120);
    for (int run = 0; run < count; ++run) {
        const int kind = run % 4;
        const double speed = std::exp(5 * random.unit()), friction = run % 3 == 0 ? 0.0 : 0.3 * random.unit();
        const int steps = std::min(90, static_cast<int>(40 / speed / frame_time));
        Floor floor{{-5.0}, run % 2 == 0};
        while (floor.joints.back() < 50)
            floor.joints.push_back(floor.joints.back() + 0.2 + 3 * random.unit());
        const Ride tiled = ride<D>(floor, kind, speed, friction, steps);
        const Ride plane = ride<D>({{-5, floor.joints.back()}, false}, kind, speed, friction, steps);
        SCOPED_TRACE("run " + std::to_string(run) + ", kind " + std::to_string(kind) + ", speed " +
                     std::to_string(speed) + ", friction " + std::to_string(friction));
        EXPECT_NEAR(tiled.vertical, plane.vertical, 1e-3 * speed);
        EXPECT_NEAR(tiled.left, plane.left, 1e-3 * speed);
    }
}

TYPED_TEST(Surfaces, what_lies_right_above_a_seam_rests) {
    constexpr int D = TypeParam::value;
    World<D> world;
    add_floor<D>(world, {{-3, -2, -1, 0, 1, 2, 3}}, {});
    std::vector<BodyId<D>> balls;
    for (int i = -2; i <= 2; ++i)
        balls.push_back(world.add_body(body_of<D>(Ball{0.5 / (3 + i)}, vec<D>(i, 1.1 + 0.07 * i))));
    run(world, 240);
    for (const BodyId<D>& ball : balls) {
        EXPECT_FALSE(world.awake(ball)) << world.position(ball).x;
        EXPECT_LT(length(world.velocity(ball)), 1e-12);
    }
}

TYPED_TEST(Surfaces, a_wall_on_the_floor_stops_what_a_seam_does_not) {
    constexpr int D = TypeParam::value;
    for (int kind = 0; kind < 4; ++kind) {
        World<D> world(sleepless<D>());
        Material smooth;
        smooth.friction = 0;
        add_floor<D>(world, {{-5, 0.4, 1, 2, 8}, false}, smooth);
        world.add_body(
            fixed_of<D>(Box<D>{vec<D>(1, 1, 20)}, vec<D>(3.5, 0.5), smooth));  // on top, from x = 3
        BodyDefinition<D> body = body_of<D>(slider<D>(kind), vec<D>(0, 0.5), smooth);
        body.velocity = vec<D>(5, 0);
        const BodyId<D> id = world.add_body(body);
        run(world, 120);
        const double half = kind == 2 ? 0.8 : 0.5;
        EXPECT_NEAR(world.position(id).x, 3 - half, 5e-3) << "kind " << kind;
        EXPECT_NEAR(world.position(id).y, 0.5, 2e-3) << "kind " << kind;
        EXPECT_LT(fastest(world), 0.1) << "kind " << kind;
    }
}

TYPED_TEST(Surfaces, a_step_up_and_an_edge_are_still_there) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    add_floor<D>(world, {{-5, 0, 5}, false}, {});
    world.add_body(fixed_of<D>(Box<D>{vec<D>(2, 0.1, 20)}, vec<D>(3, 0.05)));  // 0.1 m high, from x = 2
    BodyDefinition<D> ball = body_of<D>(Ball{0.5}, vec<D>(0, 0.5));
    ball.velocity = vec<D>(1, 0);
    ball.angular_velocity = spin<D>(-2);
    const BodyId<D> id = world.add_body(ball);
    run(world, 180);
    // Too slow to climb (½ · 1.4 v² < g · 0.1 in space), it is thrown back by the step, and rolls on the
    // floor.
    EXPECT_LT(world.position(id).x, 1.7);
    EXPECT_NEAR(world.position(id).y, 0.5, 2e-3);
}

TYPED_TEST(Surfaces, a_one_way_platform_lets_pass_from_below_and_holds_from_above) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    BodyDefinition<D> platform = fixed_of<D>(Box<D>{vec<D>(4, 0.2, 4)}, vec<D>(0, 2));
    platform.shapes[0].one_way = vec<D>(0, 1);
    world.add_body(platform);
    BodyDefinition<D> jumper = body_of<D>(Ball{0.25}, vec<D>(0, 0.5));
    jumper.velocity = vec<D>(0, 8);
    const BodyId<D> id = world.add_body(jumper);
    double highest = 0;
    for (int i = 0; i < 180; ++i) {
        world.step(frame_time);
        highest = std::max(highest, world.position(id).y);
    }
    EXPECT_NEAR(highest, 0.5 + 64 / (2 * 9.81), 1e-3);  // as if nothing were there
    EXPECT_NEAR(world.position(id).y, 2.35, 2e-3);      // and then it stands on it
}

TYPED_TEST(Surfaces, a_one_way_platform_knows_the_sides_of_what_is_fast) {
    constexpr int D = TypeParam::value;
    for (const double speed : {60.0, 400.0}) {
        for (const double side : {-1.0, 1.0}) {
            World<D> world(no_gravity<D>());
            BodyDefinition<D> platform = fixed_of<D>(Box<D>{vec<D>(4, 0.2, 4)});
            platform.shapes[0].one_way = vec<D>(0, 1);
            world.add_body(platform);
            BodyDefinition<D> shot = body_of<D>(Ball{0.1}, vec<D>(0, 3 * side));
            shot.velocity = vec<D>(0, -speed * side);
            const BodyId<D> id = world.add_body(shot);
            run(world, 20);
            const double expected = side > 0 ? 0.2 : -3 + speed / 3;
            EXPECT_NEAR(world.position(id).y, expected, 2e-3) << "speed " << speed << ", side " << side;
        }
    }
}

TYPED_TEST(Surfaces, a_body_placed_inside_a_one_way_platform_falls_out) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    BodyDefinition<D> platform = fixed_of<D>(Box<D>{vec<D>(4, 0.2, 4)}, vec<D>(0, 2));
    platform.shapes[0].one_way = vec<D>(0, 1);
    world.add_body(platform);
    const BodyId<D> id = world.add_body(body_of<D>(Ball{0.25}, vec<D>(0, 1.85)));
    run(world, 60);
    EXPECT_LT(world.position(id).y, 0);
}

TYPED_TEST(Surfaces, a_conveyor_brings_what_lies_on_it_to_its_speed) {
    constexpr int D = TypeParam::value;
    World<D> world(sleepless<D>());
    BodyDefinition<D> belt = fixed_of<D>(Box<D>{vec<D>(40, 1, 4)}, vec<D>(0, -0.5));
    belt.shapes[0].surface_velocity = vec<D>(2, 0);
    world.add_body(belt);
    const BodyId<D> box = world.add_body(body_of<D>(Box<D>{vec<D>(1, 0.4, 1)}, vec<D>(-5, 0.2)));
    run(world, 10);  // still slipping: v = μ g t
    EXPECT_NEAR(world.velocity(box).x, 0.6 * 9.81 / 6, 1e-2);
    run(world, 50);
    EXPECT_NEAR(world.velocity(box).x, 2, 1e-4);
    // Slipping takes v/(μ g), and half the way that the belt makes in it.
    const double slip_time = 2 / (0.6 * 9.81);
    EXPECT_NEAR(world.position(box).x, -5 + 2 * (1 - slip_time / 2), 5e-3);
}

TYPED_TEST(Surfaces, what_cannot_be_a_surface_is_refused) {
    constexpr int D = TypeParam::value;
    World<D> world;
    BodyDefinition<D> body = body_of<D>(cube<D>(1));
    body.shapes[0].one_way = Vec<D>{};
    EXPECT_THROW(world.add_body(body), Error);
    body.shapes[0].one_way.reset();
    body.shapes[0].surface_velocity = vec<D>(std::nan(""), 0);
    EXPECT_THROW(world.add_body(body), Error);
    EXPECT_EQ(world.counts().bodies, 0);
}

}  // namespace
}  // namespace carom::test
