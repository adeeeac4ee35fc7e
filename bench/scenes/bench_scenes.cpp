#include "scenes/bench_scenes.hpp"

#include "scenes/builders.hpp"

namespace carom::bench {

std::span<const BenchScene> bench_scenes() {
    static constexpr BenchScene scenes[] = {
        {"large_pyramid_2", 500, large_pyramid<2>},
        {"many_pyramids_2", 200, many_pyramids<2>},
        {"joint_grid_2", 500, joint_grid<2>},
        {"tumbler_2", 750, tumbler},
        {"spinner_2", 500, spinner},
        {"smash_2", 300, smash},
        {"sleeping_city_2", 500, sleeping_city<2>},
        {"rain_2", 1000, rain_2},
        {"large_pyramid_3", 200, large_pyramid<3>},
        {"many_pyramids_3", 100, many_pyramids<3>},
        {"joint_grid_3", 100, joint_grid<3>},
        {"convex_pile_3", 500, convex_pile},
        {"sleeping_city_3", 500, sleeping_city<3>},
        {"rain_3", 400, rain_3},
        {"convex_vs_mesh_3", 500, convex_vs_mesh, true},
        {"large_world_3", 500, large_world},
        {"wide_pyramid_3", 500, wide_pyramid},
        {"pyramid_3", 500, pyramid, true},
        {"ragdolls_3", 300, ragdoll_pile, true},
    };
    return scenes;
}

}  // namespace carom::bench
