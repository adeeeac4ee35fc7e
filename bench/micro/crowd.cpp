#include <benchmark/benchmark.h>

#include <cmath>

#include "collision/sweep.hpp"
#include "collision/tree.hpp"
#include "scattered.hpp"

// A crowd that moves, and many bodies that come at once. The boxes of a crowd are 0.3 to 0.5 m large and lie
// as dense as in a heap: each overlaps a few others.

namespace carom::bench {
namespace {

template <int D>
struct Crowd {
    std::vector<detail::OuterBox<D>> boxes, before;
    std::vector<std::uint32_t> listed;
    std::vector<std::uint8_t> fresh;

    explicit Crowd(std::int64_t count) {
        Random random(15);
        const double half = 0.5 * 0.3 * std::pow(double(count), 1.0 / D);
        for (std::uint32_t i = 0; i < count; ++i) {
            const Vec<D> center = random.in_cube<D>(half);
            Vec<D> extent;
            for (int k = 0; k < D; ++k) extent[k] = random.between(0.15, 0.25);
            boxes.push_back(Aabb<D>{center - extent, center + extent});
            listed.push_back(i);
            fresh.push_back(i % 2);  // about as many as get new boxes in a step
            before.push_back(i % 2 ? detail::no_box<D>() : boxes[i]);
        }
    }
    detail::Tree<D> tree() const {
        std::vector<typename detail::Tree<D>::Entry> entries;
        for (const std::uint32_t i : listed) entries.push_back({boxes[i], i});
        detail::Tree<D> tree;
        tree.build(entries);
        return tree;
    }
};

template <int D>
void crowd_sweep(benchmark::State& state) {
    const Crowd<D> crowd(state.range(0));
    detail::Sweep<D> sweep;
    std::size_t pairs = 0;
    for (auto _ : state)
        sweep.find(crowd.listed, crowd.boxes, crowd.before, nullptr,
                   [&](std::uint32_t, std::uint32_t) { ++pairs; });
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.counters["pairs"] = double(pairs) / double(state.iterations());
}

/// The same pairs by a question to a tree for each box that is new.
template <int D>
void crowd_tree(benchmark::State& state) {
    const Crowd<D> crowd(state.range(0));
    const detail::Tree<D> tree = crowd.tree();
    std::size_t pairs = 0;
    for (auto _ : state) {
        for (const std::uint32_t i : crowd.listed) {
            if (!crowd.fresh[i]) continue;
            tree.query(crowd.boxes[i], [&](std::uint32_t other) {
                pairs += i != other && (!crowd.fresh[other] || i < other);
            });
        }
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.counters["pairs"] = double(pairs) / double(state.iterations());
}

/// Half of the boxes move by up to 0.05 m, at once.
template <int D>
void crowd_move(benchmark::State& state) {
    Crowd<D> crowd(state.range(0));
    detail::Tree<D> tree = crowd.tree();
    Random random(16);
    std::vector<std::int32_t> moved;
    for (auto _ : state) {
        moved.clear();
        for (const std::uint32_t i : crowd.listed) {
            if (!crowd.fresh[i]) continue;
            const Vec<D> way = random.in_cube<D>(0.05);
            const Aabb<D> box = detail::widened(crowd.boxes[i]);
            crowd.boxes[i] = Aabb<D>{box.lower + way, box.upper + way};
            moved.push_back(std::int32_t(i));
        }
        tree.move_all(moved, [&](std::uint32_t i) -> const detail::OuterBox<D>& { return crowd.boxes[i]; });
    }
    state.SetItemsProcessed(state.iterations() * state.range(0));
}

/// Fixed boxes come into an empty world, all alike (0) or each of another size (1), and the first step is
/// taken.
template <int D>
void world_add(benchmark::State& state) {
    constexpr int count = 100'000;
    Random random(17);
    for (auto _ : state) {
        World<D> world;
        BodyDefinition<D> body;
        body.type = BodyType::fixed;
        Box<D> box;
        for (int k = 0; k < D; ++k) box.size[k] = 1;
        body.shapes = {{box}};
        for (int i = 0; i < count; ++i) {
            body.position = random.in_cube<D>(D == 2 ? 450 : 93);
            if (state.range(0) == 1) {
                box.size.x = random.between(0.5, 1.5);
                body.shapes[0].geometry = box;
            }
            world.add_body(body);
        }
        world.step(1.0 / 60);
        benchmark::DoNotOptimize(world.counts());
    }
    state.SetItemsProcessed(state.iterations() * count);
}

BENCHMARK_TEMPLATE(crowd_sweep, 2)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(crowd_sweep, 3)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(crowd_tree, 2)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(crowd_tree, 3)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(crowd_move, 2)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(crowd_move, 3)->Arg(2000)->Arg(20000)->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(world_add, 2)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(world_add, 3)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace carom::bench
