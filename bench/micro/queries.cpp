#include <benchmark/benchmark.h>

#include "scattered.hpp"

// Queries of a world of 100 000 fixed boxes and balls: rays of 100 m from anywhere in any direction.

namespace carom::bench {
namespace {

constexpr int shapes = 100'000;
template <int D>
constexpr double half = D == 2 ? 450 : 93;

template <int D>
const World<D>& world() {
    static const World<D> made = scattered_world<D>(shapes, half<D>);
    return made;
}

template <int D>
const std::vector<Ray<D>>& rays() {
    static const std::vector<Ray<D>> made = [] {
        Random random(13);
        std::vector<Ray<D>> result;
        for (int i = 0; i < 100'000; ++i)
            result.push_back({random.in_cube<D>(half<D>), 100.0 * random.direction<D>()});
        return result;
    }();
    return made;
}

template <int D, class Question>
void ask(benchmark::State& state, const Question& question) {
    const World<D>& asked = world<D>();
    const std::vector<Ray<D>>& all = rays<D>();
    std::size_t next = 0;
    for (auto _ : state) {
        auto answer = question(asked, all[next++ % all.size()]);
        benchmark::DoNotOptimize(answer);
    }
    state.SetItemsProcessed(state.iterations());
}

template <int D>
void ray_first(benchmark::State& state) {
    ask<D>(state, [](const World<D>& w, const Ray<D>& ray) { return w.cast_ray(ray); });
}
template <int D>
void ray_any(benchmark::State& state) {
    ask<D>(state, [](const World<D>& w, const Ray<D>& ray) { return w.cast_ray_any(ray); });
}
template <int D>
void ray_all(benchmark::State& state) {
    ask<D>(state, [](const World<D>& w, const Ray<D>& ray) { return w.cast_ray_all(ray); });
}
template <int D>
void shape_first(benchmark::State& state) {
    const Solid<D> ball{Geometry<D>(Ball{0.5})};
    ask<D>(state, [&](const World<D>& w, const Ray<D>& ray) {
        return w.cast_shape(ball, {ray.origin, {}}, 0.2 * ray.translation);
    });
}
template <int D>
void overlapping(benchmark::State& state) {
    const Solid<D> ball{Geometry<D>(Ball{2})};
    ask<D>(state, [&](const World<D>& w, const Ray<D>& ray) {
        return w.overlapping(ball, {ray.origin, {}});
    });
}
template <int D>
void nearest(benchmark::State& state) {
    ask<D>(state, [](const World<D>& w, const Ray<D>& ray) { return w.nearest_point(ray.origin, 10); });
}

BENCHMARK_TEMPLATE(ray_first, 2);
BENCHMARK_TEMPLATE(ray_first, 3);
BENCHMARK_TEMPLATE(ray_any, 2);
BENCHMARK_TEMPLATE(ray_any, 3);
BENCHMARK_TEMPLATE(ray_all, 2);
BENCHMARK_TEMPLATE(ray_all, 3);
BENCHMARK_TEMPLATE(shape_first, 2);
BENCHMARK_TEMPLATE(shape_first, 3);
BENCHMARK_TEMPLATE(overlapping, 2);
BENCHMARK_TEMPLATE(overlapping, 3);
BENCHMARK_TEMPLATE(nearest, 2);
BENCHMARK_TEMPLATE(nearest, 3);

}  // namespace
}  // namespace carom::bench
