#include <cmath>
#include <memory>

#include "scenes/builders.hpp"
#include "scenes/ragdoll.hpp"

namespace carom::bench {
namespace {

/// Groups of humans that fall in columns, until all columns are there; then the oldest is taken away and
/// falls anew, and so on.
template <int D>
class Rain {
  public:
    using Bodies = std::vector<BodyId<D>>;
    /// `make(world, row, column)` adds a group.
    using Make = std::vector<BodyId<D>> (*)(World<D>&, int row, int column);

    Rain(int rows, int columns, Make make) : rows_(rows), columns_(columns), make_(make) {}

    void next(World<D>& world) {
        const int column = drops_++ % columns_;
        const bool anew = drops_ > columns_;
        if (!anew) groups_.resize(static_cast<std::size_t>(rows_ * drops_));
        for (int row = 0; row < rows_; ++row) {
            Bodies& group = groups_[static_cast<std::size_t>(column * rows_ + row)];
            for (const BodyId<D> body : group) world.remove_body(body);
            group = make_(world, row, column);
        }
    }

  private:
    int rows_, columns_;
    Make make_;
    int drops_ = 0;
    std::vector<Bodies> groups_;
};

void append(std::vector<BodyId2>& all, const std::vector<BodyId2>& more) {
    all.insert(all.end(), more.begin(), more.end());
}
void append(std::vector<BodyId3>& all, const std::vector<BodyId3>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

std::vector<BodyId2> group_of_five(World2& world, int row, int column) {
    std::vector<BodyId2> group;
    for (int i = 0; i < 5; ++i)
        append(group, add_human(world, {-125 + 6.25 * (column + 0.5) + 0.5 * i, 40 + 45.0 * row}, i + 1));
    return group;
}

std::vector<BodyId3> group_of_three(World3& world, int row, int column) {
    std::vector<BodyId3> group;
    for (int i = 0; i < 3; ++i)
        append(group, add_human(world, {-75 + 15 * (column + 0.5) + 0.75 * i, 20, -75 + 15 * (row + 0.5)},
                                10 * row + column));
    return group;
}

constexpr double pi = 3.14159265358979323846;

/// A grid of 8 × 8 cells around the origin.
Mesh flat_grid() {
    constexpr int cells = 8;
    constexpr double cell = 15.0 / cells;
    Mesh mesh;
    for (int x = 0; x <= cells; ++x)
        for (int z = 0; z <= cells; ++z)
            mesh.vertices.push_back({(x - cells / 2) * cell, 0, (z - cells / 2) * cell});
    const auto vertex = [](int x, int z) { return static_cast<std::uint32_t>(x * (cells + 1) + z); };
    for (int x = 0; x < cells; ++x)
        for (int z = 0; z < cells; ++z) {
            mesh.triangles.push_back({vertex(x, z), vertex(x, z + 1), vertex(x + 1, z + 1)});
            mesh.triangles.push_back({vertex(x, z), vertex(x + 1, z + 1), vertex(x + 1, z)});
        }
    return mesh;
}

/// A ring that stands upright, half of it below the ground.
Mesh torus() {
    constexpr int parts = 16;
    Mesh mesh;
    for (int i = 0; i < parts; ++i)
        for (int k = 0; k < parts; ++k) {
            const Rotation2 u = Rotation2::from_angle(2 * pi * i / parts),
                            v = Rotation2::from_angle(2 * pi * k / parts);
            mesh.vertices.push_back({(3.75 + v.c) * u.c, (3.75 + v.c) * u.s, v.s});
        }
    const auto vertex = [](int i, int k) {
        return static_cast<std::uint32_t>(i % parts * parts + k % parts);
    };
    for (int i = 0; i < parts; ++i)
        for (int k = 0; k < parts; ++k) {
            mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)});
            mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)});
        }
    return mesh;
}

}  // namespace

BenchWorld<2> rain_2() {
    BenchWorld<2> bench{World<2>(bench_world<2>())};
    BodyDefinition<2> floors;
    floors.type = BodyType::fixed;
    for (int floor = 0; floor < 5; ++floor)
        for (int j = 0; j <= 500; ++j) {
            ShapeDefinition<2>& box = floors.shapes.emplace_back();
            box.geometry = Box<2>{{0.5, 0.5}};
            box.center = {-125 + 0.5 * j, 45.0 * floor};
        }
    bench.world.add_body(floors);
    bench.before_step = [rain = Rain<2>(5, 40, group_of_five)](World2& world, int step) mutable {
        if (step % 8 == 0) rain.next(world);
    };
    return bench;
}

BenchWorld<3> rain_3() {
    BenchWorld<3> bench{World<3>(bench_world<3>())};
    const Mesh ground = flat_grid(), ring = torus();
    for (int x = 0; x < 10; ++x)
        for (int z = 0; z < 10; ++z) {
            BodyDefinition<3> cell;
            cell.type = BodyType::fixed;
            cell.position = {-67.5 + 15 * x, 0, -67.5 + 15 * z};
            cell.shapes.emplace_back().geometry = ground;
            cell.shapes.emplace_back().geometry = ring;
            bench.world.add_body(cell);
        }
    bench.before_step = [rain = Rain<3>(10, 10, group_of_three)](World3& world, int step) mutable {
        if ((step & 0x2F) == 0) rain.next(world);
    };
    return bench;
}

}  // namespace carom::bench
