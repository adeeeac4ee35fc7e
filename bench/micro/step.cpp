#include <benchmark/benchmark.h>

#include <string>

#include "carom/carom.hpp"

// What a step costs where there is hardly anything: boxes that lie on the floor, side by side, awake.

namespace carom::bench {

namespace {

template <int D>
World<D> boxes_at_rest(int count, int threads) {
    WorldDefinition<D> definition;
    definition.sleep = false;
    World<D> world(definition);
    if (threads > 0) world.set_scheduler(make_thread_pool(threads));
    const auto box_at = [&](double x, double y, const Vec<D>& size, BodyType type) {
        BodyDefinition<D> body;
        body.type = type;
        body.position[0] = x;
        body.position[1] = y;
        body.shapes.push_back({Box<D>{size}});
        world.add_body(body);
    };
    Vec<D> floor, unit;
    for (int i = 0; i < D; ++i) floor[i] = i == 1 ? 1 : 1000, unit[i] = 1;
    box_at(0, -0.5, floor, BodyType::fixed);
    for (int i = 0; i < count; ++i) box_at(2.0 * i, 0.5, unit, BodyType::dynamic);
    for (int i = 0; i < 100; ++i) world.step(1.0 / 60);
    return world;
}

template <int D>
void step_at_rest(benchmark::State& state) {
    World<D> world = boxes_at_rest<D>(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
    for (auto _ : state) world.step(1.0 / 60);
}

}  // namespace

BENCHMARK(step_at_rest<2>)
    ->ArgNames({"boxes", "threads"})
    ->Args({10, 0})
    ->Args({10, 2})
    ->Args({100, 0})
    ->Args({100, 2});
BENCHMARK(step_at_rest<3>)
    ->ArgNames({"boxes", "threads"})
    ->Args({10, 0})
    ->Args({10, 2})
    ->Args({100, 0})
    ->Args({100, 2});

}  // namespace carom::bench
