#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "carom/collide.hpp"
#include "scattered.hpp"

// Each pair of kinds: contact manifold, separation and closest points of shapes about 1 m large, at 256
// random placements: apart (`far`), a millimetre deep (`near`), and a quarter of a metre deep (`deep`).

namespace carom::bench {
namespace {

constexpr int placements = 256;

struct Depth {
    const char* name;
    double gap;  ///< m
};
constexpr Depth depths[] = {{"far", 1}, {"near", -0.001}, {"deep", -0.25}};

template <int D>
std::vector<Transform<D>> placements_of(const Solid<D>& a, const Solid<D>& b, double gap) {
    Random random(1);
    std::vector<Transform<D>> result;
    while (int(result.size()) < placements) {
        Transform<D> placed{2.0 * random.direction<D>(), random.rotation<D>()};
        // A few rounds along the axis bring the gap about, where there is one.
        for (int round = 0; round < 3; ++round) {
            const auto apart = separation<D>(a, Transform<D>{}, b, placed);
            if (apart) placed.position += (gap - apart->distance) * apart->axis;
        }
        result.push_back(placed);
    }
    return result;
}

template <int D, class Question>
void ask(benchmark::State& state, const Solid<D>& a, const Solid<D>& b, double gap,
         const Question& question) {
    const std::vector<Transform<D>> placed = placements_of(a, b, gap);
    const Transform<D> here;
    for (auto _ : state) {
        for (const Transform<D>& there : placed) {
            auto answer = question(a, here, b, there);
            benchmark::DoNotOptimize(answer);
        }
    }
    state.SetItemsProcessed(state.iterations() * placements);
}

template <int D>
void add_pairs() {
    const std::vector<Kind<D>> kinds = kinds_of<D>();
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        for (std::size_t j = i; j < kinds.size(); ++j) {
            const Solid<D> a(kinds[i].geometry), b(kinds[j].geometry);
            if (kinds[i].name == "plane" && kinds[j].name == "plane") continue;
            const std::string pair = std::to_string(D) + "d/" + kinds[i].name + "_" + kinds[j].name + "/";
            for (const Depth& depth : depths) {
                const double gap = depth.gap;
                benchmark::RegisterBenchmark(
                    (pair + "collide/" + depth.name).c_str(), [=](benchmark::State& state) {
                        ask<D>(state, a, b, gap, [](auto&... x) { return collide<D>(x..., 0.02); });
                    });
            }
            benchmark::RegisterBenchmark((pair + "closest_points/far").c_str(), [=](benchmark::State& state) {
                ask<D>(state, a, b, 1, [](auto&... x) { return closest_points<D>(x...); });
            });
        }
    }
}

const bool added = (add_pairs<2>(), add_pairs<3>(), true);

}  // namespace
}  // namespace carom::bench
