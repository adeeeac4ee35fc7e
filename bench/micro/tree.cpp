#include "collision/tree.hpp"

#include <benchmark/benchmark.h>

#include "scattered.hpp"

// The tree of boxes: 100 000 of them, about 1 m large, one in 64 m³ (8 m² in the plane).

namespace carom::bench {
namespace {

constexpr int boxes = 100'000;
template <int D>
constexpr double half = D == 2 ? 450 : 93;

template <int D>
std::vector<typename detail::Tree<D>::Entry> entries() {
    Random random(9);
    std::vector<typename detail::Tree<D>::Entry> result;
    for (int i = 0; i < boxes; ++i) {
        const Vec<D> center = random.in_cube<D>(half<D>);
        Vec<D> extent;
        for (int k = 0; k < D; ++k) extent[k] = random.between(0.25, 0.75);
        result.push_back({Aabb<D>{center - extent, center + extent}, std::uint32_t(i)});
    }
    return result;
}

template <int D>
detail::Tree<D> built() {
    detail::Tree<D> tree;
    tree.build(entries<D>());
    return tree;
}

template <int D>
void tree_build(benchmark::State& state) {
    const auto all = entries<D>();
    detail::Tree<D> tree;
    for (auto _ : state) tree.build(all);
    state.SetItemsProcessed(state.iterations() * boxes);
}

template <int D>
void tree_insert(benchmark::State& state) {
    const auto all = entries<D>();
    for (auto _ : state) {
        detail::Tree<D> tree;
        for (const auto& entry : all) tree.insert(entry.box, entry.payload);
    }
    state.SetItemsProcessed(state.iterations() * boxes);
}

/// Every box moves by up to 0.2 m.
template <int D>
void tree_move(benchmark::State& state) {
    Random random(11);
    detail::Tree<D> tree = built<D>();
    for (auto _ : state) {
        for (std::int32_t leaf = 0; leaf < boxes; ++leaf) {
            const Vec<D> way = random.in_cube<D>(0.2);
            const Aabb<D> box = detail::widened(tree.box(leaf));
            tree.move(leaf, Aabb<D>{box.lower + way, box.upper + way});
        }
    }
    state.SetItemsProcessed(state.iterations() * boxes);
}

template <int D>
void tree_query(benchmark::State& state) {
    const detail::Tree<D> tree = built<D>();
    const auto all = entries<D>();
    std::size_t next = 0, found = 0;
    for (auto _ : state) {
        tree.query(all[next].box, [&](std::uint32_t) { ++found; });
        next = (next + 7919) % all.size();
    }
    benchmark::DoNotOptimize(found);
    state.SetItemsProcessed(state.iterations());
}

/// Rays of random directions through the whole field, boxes alone, all that they meet.
template <int D>
void tree_ray(benchmark::State& state) {
    const detail::Tree<D> tree = built<D>();
    Random random(13);
    std::vector<Ray<D>> rays;
    for (int i = 0; i < 4096; ++i)
        rays.push_back({random.in_cube<D>(half<D>), 100.0 * random.direction<D>()});
    std::size_t next = 0, found = 0;
    for (auto _ : state) {
        const Ray<D>& ray = rays[next++ % rays.size()];
        tree.cast(ray.origin, ray.translation, Vec<D>{}, 1.0, [&](std::uint32_t, double limit) {
            ++found;
            return limit;
        });
    }
    benchmark::DoNotOptimize(found);
    state.SetItemsProcessed(state.iterations());
}

BENCHMARK_TEMPLATE(tree_build, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(tree_build, 3)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(tree_insert, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(tree_insert, 3)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(tree_move, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(tree_move, 3)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(tree_query, 2);
BENCHMARK_TEMPLATE(tree_query, 3);
BENCHMARK_TEMPLATE(tree_ray, 2);
BENCHMARK_TEMPLATE(tree_ray, 3);

}  // namespace
}  // namespace carom::bench
