#include "scenes/builders.hpp"
#include "scenes/ragdoll.hpp"

namespace carom::bench {

/// A thousand humans of 14 bones each fall into a pit, in layers of 10 × 10.
BenchWorld<3> ragdoll_pile() {
    BenchWorld<3> bench{World<3>(bench_world<3>())};
    BodyDefinition<3> pit;
    pit.type = BodyType::fixed;
    pit.shapes.emplace_back().geometry = Plane<3>{{0, 1, 0}, 0};
    for (const double side : {-1.0, 1.0}) {
        for (const bool along_x : {false, true}) {
            ShapeDefinition<3>& wall = pit.shapes.emplace_back();
            wall.geometry = Box<3>{{along_x ? 14.0 : 1.0, 30, along_x ? 1.0 : 14.0}};
            wall.center = {along_x ? 0 : 6.5 * side, 14, along_x ? 6.5 * side : 0};
        }
    }
    bench.world.add_body(pit);
    for (int layer = 0; layer < 10; ++layer)
        for (int row = 0; row < 10; ++row)
            for (int column = 0; column < 10; ++column)
                add_human(bench.world,
                          {1.1 * (column - 4.5) + 0.05 * (layer % 3), 0.5 + 2 * layer, 1.1 * (row - 4.5)},
                          100 * layer + 10 * row + column + 1);
    return bench;
}

}  // namespace carom::bench
