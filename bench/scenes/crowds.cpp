#include <cstdint>

#include "scenes/builders.hpp"

namespace carom::bench {

BenchWorld<2> smash() {
    WorldDefinition<2> definition = bench_world<2>();
    definition.gravity = {};
    BenchWorld<2> bench{World<2>(definition)};
    BodyDefinition<2> hammer = box_body<2>(BodyType::dynamic, {-20, 0}, {4, 4}, 8);
    hammer.velocity = {40, 0};
    bench.world.add_body(hammer);
    for (int i = 0; i < 120; ++i)
        for (int j = 0; j < 80; ++j)
            bench.world.put_to_sleep(bench.world.add_body(
                box_body<2>(BodyType::dynamic, {30 + 0.4 * i, 0.4 * (j - 40)}, {0.2, 0.2}, 1)));
    return bench;
}

namespace {

/// Points spread over a sphere, the same everywhere: a linear congruential generator draws points in a ball,
/// which are then moved out to its surface.
std::vector<Vec3> points_on_sphere(int count, double radius) {
    std::uint32_t state = 42;
    const auto draw = [&state] {
        state = state * 2147001325u + 715136305u;
        return (state & 0xffff) / 65535.0 - 0.5;
    };
    std::vector<Vec3> points;
    while (points.size() < static_cast<std::size_t>(count)) {
        const double x = draw(), y = draw(), z = draw();
        const Vec3 point{x, y, z};
        if (length_squared(point) <= 0.25) points.push_back(radius * normalized(point));
    }
    return points;
}

}  // namespace

BenchWorld<3> convex_pile() {
    constexpr int layers = 80, side = 8;
    BenchWorld<3> bench{World<3>(bench_world<3>())};
    bench.world.add_body(box_body<3>(BodyType::fixed, {0, -1, 0}, {250, 1, 250}, 1000));
    BodyDefinition<3> rock;
    rock.shapes.emplace_back().geometry = Hull<3>{points_on_sphere(32, 2)};
    for (int layer = 0; layer < layers; ++layer)
        for (int z = 0; z < side; ++z)
            for (int x = 0; x < side; ++x) {
                rock.position = {4.0 * (x - 4), 2 + 4.0 * layer, 4.0 * (z - 4)};
                bench.world.add_body(rock);
            }
    return bench;
}

template <int D>
BenchWorld<D> sleeping_city() {
    constexpr int floors = 10;
    constexpr int houses = 10'000;  // in space a square of streets, in the plane a row
    constexpr int side = D == 2 ? houses : 100;
    constexpr double pitch = 4, square = 40;  // m; no houses stand nearer to the middle than half the square
    BenchWorld<D> bench{World<D>(bench_world<D>())};
    const double half_ground = 0.5 * side * pitch + square;
    bench.world.add_body(
        box_body<D>(BodyType::fixed, make_vec<D>(0, -1, 0), make_vec<D>(half_ground, 1, half_ground), 1000));
    const auto place = [](int i) {
        const double x = pitch * (i - 0.5 * (side - 1));
        return x + (x < 0 ? -0.5 : 0.5) * square;
    };
    for (int i = 0; i < houses; ++i)
        for (int floor = 0; floor < floors; ++floor) {
            const Vec<D> center = make_vec<D>(place(i % side), 0.5 + floor, place(i / side));
            bench.world.put_to_sleep(bench.world.add_body(
                box_body<D>(BodyType::dynamic, center, make_vec<D>(0.5, 0.5, 0.5), 100)));
        }
    BodyDefinition<D> ball;
    ball.position = make_vec<D>(-0.5 * square, 0.5, 0);
    ball.velocity = make_vec<D>(4, 0, 0);
    if constexpr (D == 2)
        ball.angular_velocity = -8;
    else
        ball.angular_velocity = {0, 0, -8};
    ball.shapes.emplace_back().geometry = Ball{0.5};
    bench.world.add_body(ball);
    return bench;
}

template BenchWorld<2> sleeping_city();
template BenchWorld<3> sleeping_city();

BenchWorld<3> convex_vs_mesh() {
    constexpr int cells = 100;
    constexpr double cell = 3;
    BenchWorld<3> bench{World<3>(WorldDefinition<3>{})};  // with the gravity of the Earth
    Mesh hills;
    for (int x = 0; x <= cells; ++x)
        for (int z = 0; z <= cells; ++z)
            hills.vertices.push_back({cell * x,
                                      5 * Rotation2::from_angle(0.5 * x).s * Rotation2::from_angle(0.5 * z).c,
                                      cell * z});
    const auto vertex = [](int x, int z) { return static_cast<std::uint32_t>(x * (cells + 1) + z); };
    for (int x = 0; x < cells; ++x)
        for (int z = 0; z < cells; ++z) {
            hills.triangles.push_back({vertex(x, z), vertex(x, z + 1), vertex(x + 1, z)});
            hills.triangles.push_back({vertex(x + 1, z), vertex(x, z + 1), vertex(x + 1, z + 1)});
        }
    const auto make = [](const Geometry<3>& geometry) {
        BodyDefinition<3> body;
        ShapeDefinition<3>& shape = body.shapes.emplace_back();
        shape.geometry = geometry;
        shape.material = {.density = 1000, .friction = 0.5, .restitution = 0.6};
        body.linear_damping = body.angular_damping = 0.05;
        return body;
    };
    BodyDefinition<3> ground = make(hills);
    ground.type = BodyType::fixed;
    ground.position = {-0.5 * cell * cells, 5, -0.5 * cell * cells};
    bench.world.add_body(ground);
    BodyDefinition<3> layers[] = {make(Box<3>{{1, 1.5, 2}}), make(Ball{0.5}),
                                  make(Capsule<3>{{0, -0.75, 0}, {0, 0.75, 0}, 0.5}),
                                  make(Hull<3>{{{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}})};
    for (int x = -10; x <= 10; ++x)
        for (int y = 0; y < 4; ++y)
            for (int z = -10; z <= 10; ++z) {
                layers[y].position = {7.5 * x, 15.0 + 2 * y, 7.5 * z};
                bench.world.add_body(layers[y]);
            }
    return bench;
}

BenchWorld<3> large_world() {
    constexpr int side = 1000;        // floor tiles
    constexpr int dropped_side = 10;  // balls
    constexpr int interval = 5;       // steps from ball to ball
    constexpr double tile = 10;       // m
    BenchWorld<3> bench{World<3>(bench_world<3>())};
    const auto center = [](int i) { return -side * tile / 2 + (i + 0.5) * tile; };
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k)
            bench.world.add_body(box_body<3>(BodyType::fixed, {center(i), 0, center(k)}, {5, 0.25, 5}, 1000));

    bench.before_step = [](World<3>& world, int step) {
        const int index = step / interval - 1;
        if (step % interval != 0 || index < 0 || index >= dropped_side * dropped_side) return;
        constexpr double reach = 0.8 * side * tile;
        const auto place = [](int i) { return -reach / 2 + reach * i / (dropped_side - 1); };
        BodyDefinition<3> ball;
        ball.position = {place(index / dropped_side), 1.5, place(index % dropped_side)};
        ball.shapes.emplace_back().geometry = Ball{0.5};
        world.add_body(ball);
    };
    return bench;
}

}  // namespace carom::bench
