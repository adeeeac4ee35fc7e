#include "scenes/builders.hpp"
#include "scenes/ragdoll.hpp"

namespace carom::bench {

/// A thousand humans of 14 bones each fall into a pit, in five layers of 20 × 10.
BenchWorld<3> ragdoll_pile() {
    constexpr double width = 24, depth = 12, height = 20;
    BenchWorld<3> bench{World<3>(bench_world<3>())};
    BodyDefinition<3> pit;
    pit.type = BodyType::fixed;
    const auto add_box = [&](const Vec3& center, const Vec3& size) {
        ShapeDefinition<3>& box = pit.shapes.emplace_back();
        box.geometry = Box<3>{size};
        box.center = center;
    };
    add_box({0, -1, 0}, {width + 4, 2, depth + 4});
    for (const double side : {-1.0, 1.0}) {
        add_box({side * (width / 2 + 1), height / 2, 0}, {2, height, depth + 4});
        add_box({0, height / 2, side * (depth / 2 + 1)}, {width + 4, height, 2});
    }
    bench.world.add_body(pit);
    int group = 0;
    for (int layer = 0; layer < 5; ++layer)
        for (int row = 0; row < 10; ++row)
            for (int column = 0; column < 20; ++column)
                add_human(bench.world,
                          {1.15 * (column - 9.5) + 0.05 * (layer % 3), 0.5 + 2 * layer, 1.1 * (row - 4.5)},
                          ++group);
    return bench;
}

}  // namespace carom::bench
