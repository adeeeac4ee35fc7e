#include "scenes/builders.hpp"

namespace carom::bench {
namespace {

constexpr double half_box = 0.5;

template <int D>
double box_density() {
    return D == 2 ? 1 : 100;
}

template <int D>
Vec<D> half_cube(double half) {
    return make_vec<D>(half, half, half);
}

/// A wall of touching boxes, `base` of them in the lowest row. The boxes are added row by row from below, and
/// the first stands half a box to the right of `corner` and above it.
template <int D>
void add_pyramid(World<D>& world, int base, const Vec<D>& corner, bool can_sleep) {
    for (int i = 0; i < base; ++i)
        for (int j = i; j < base; ++j) {
            const Vec<D> offset =
                make_vec<D>((i + 1) * half_box + 2 * (j - i) * half_box, (2 * i + 1) * half_box, 0);
            BodyDefinition<D> box =
                box_body<D>(BodyType::dynamic, corner + offset, half_cube<D>(half_box), box_density<D>());
            box.can_sleep = can_sleep;
            world.add_body(box);
        }
}

constexpr int small_base = 10;
constexpr double small_width = 2 * half_box * (small_base + 1);

/// The centre of the first box of a small pyramid lies at `x`.
template <int D>
Vec<D> small_corner(double x, double y, double z) {
    return make_vec<D>(x - half_box, y, z);
}

}  // namespace

template <int D>
BenchWorld<D> large_pyramid() {
    constexpr int base = 100;
    WorldDefinition<D> definition = bench_world<D>();
    definition.sleep = false;
    BenchWorld<D> bench{World<D>(definition)};
    const double half_ground = D == 2 ? 100 : 400;
    bench.world.add_body(box_body<D>(BodyType::fixed, make_vec<D>(0, -1, 0),
                                     make_vec<D>(half_ground, 1, half_ground), box_density<D>()));
    add_pyramid<D>(bench.world, base, make_vec<D>(-half_box * base, 0, 0), true);
    return bench;
}

template BenchWorld<2> large_pyramid();
template BenchWorld<3> large_pyramid();

/// The floors of the original are line segments. Here they are boxes, half a metre thick, whose tops lie
/// where the segments do; the tips of the pyramids beneath stay half a metre below them.
template <>
BenchWorld<2> many_pyramids<2>() {
    constexpr int rows = 20, columns = 20;
    constexpr double width = small_width * columns;
    constexpr double half_floor = 0.25;

    WorldDefinition<2> definition = bench_world<2>();
    definition.sleep = false;
    BenchWorld<2> bench{World<2>(definition)};
    BodyDefinition<2> floors;
    floors.type = BodyType::fixed;
    for (int row = 0; row < rows; ++row) {
        ShapeDefinition<2>& floor = floors.shapes.emplace_back();
        floor.geometry = Box<2>{{width, 2 * half_floor}};
        floor.center = {0, small_width * row - half_floor};
    }
    bench.world.add_body(floors);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double x = -width / 2 + column * small_width + 2 * half_box;
            add_pyramid<2>(bench.world, small_base, small_corner<2>(x, small_width * row, 0), true);
        }
    return bench;
}

template <>
BenchWorld<3> many_pyramids<3>() {
    constexpr int rows = 14, columns = 14;
    constexpr double half_ground = half_box * columns * (small_base + 1);

    BenchWorld<3> bench{World<3>(bench_world<3>())};
    bench.world.add_body(
        box_body<3>(BodyType::fixed, {0, -1, 0}, {half_ground, 1, half_ground}, box_density<3>()));
    for (int row = 0; row < rows; ++row) {
        const double z = -half_ground + 2 * half_box + row * 2 * (half_ground - 2 * half_box) / (rows - 1);
        for (int column = 0; column < columns; ++column) {
            const double x = -half_ground + column * small_width + 2 * half_box;
            add_pyramid<3>(bench.world, small_base, small_corner<3>(x, 0, z), false);
        }
    }
    return bench;
}

template <int D>
BenchWorld<D> small_pyramids(int bodies) {
    constexpr int base = 4, boxes = base * (base + 1) / 2;
    constexpr double pitch = base + 1;
    const int count = (bodies + boxes - 1) / boxes;
    int side = 1;  // pyramids in a row: all of them in the plane, a square of rows in space
    if constexpr (D == 2)
        side = count;
    else
        while (side * side < count) ++side;
    WorldDefinition<D> definition = bench_world<D>();
    definition.sleep = false;
    BenchWorld<D> bench{World<D>(definition)};
    const double half_ground = 0.5 * pitch * (side + 1);
    bench.world.add_body(box_body<D>(BodyType::fixed, make_vec<D>(0, -1, 0),
                                     make_vec<D>(half_ground, 1, half_ground), box_density<D>()));
    for (int i = 0; i < count; ++i) {
        const double x = pitch * (i % side) - half_ground + 1, z = pitch * (i / side) - half_ground + 2;
        add_pyramid<D>(bench.world, base, make_vec<D>(x, 0, z), true);
    }
    return bench;
}

template BenchWorld<2> small_pyramids(int);
template BenchWorld<3> small_pyramids(int);

namespace {

/// A pyramid with a square base, whose layers begin half a metre apart. The boxes are 2 m wide, less a
/// margin.
void add_square_pyramid(World<3>& world, double half, const BodyDefinition<3>& model) {
    constexpr int height = 15;
    constexpr double width = 2, pitch = 2.5;
    for (int i = 0; i < height; ++i) {
        const int first = i / 2, last = height - 1 - (i + 1) / 2;
        const double shift = i % 2 == 1 ? 1 : 0;
        for (int j = first; j <= last; ++j)
            for (int k = first; k <= last; ++k) {
                BodyDefinition<3> box = model;
                box.position = {-height + width * j + shift, 1 + pitch * i, -height + width * k + shift};
                box.shapes.front().geometry = Box<3>{{2 * half, 2 * half, 2 * half}};
                world.add_body(box);
            }
    }
}

}  // namespace

BenchWorld<3> wide_pyramid() {
    BenchWorld<3> bench{World<3>(bench_world<3>())};
    bench.world.add_body(box_body<3>(BodyType::fixed, {0, -1, 0}, {100, 1, 100}, 1000));
    add_square_pyramid(bench.world, 1 - 0.025, box_body<3>(BodyType::dynamic, {}, {1, 1, 1}, 1000));
    return bench;
}

BenchWorld<3> pyramid() {
    WorldDefinition<3> definition;  // with the gravity of the Earth
    definition.sleep = false;
    BenchWorld<3> bench{World<3>(definition)};
    BodyDefinition<3> floor = box_body<3>(BodyType::fixed, {0, -1, 0}, {50, 1, 50}, 1000);
    BodyDefinition<3> box = box_body<3>(BodyType::dynamic, {}, {1, 1, 1}, 1000);
    for (BodyDefinition<3>* body : {&floor, &box}) body->shapes.front().material.friction = 0.2;
    box.linear_damping = box.angular_damping = 0.05;
    bench.world.add_body(floor);
    add_square_pyramid(bench.world, 1, box);
    return bench;
}

}  // namespace carom::bench
