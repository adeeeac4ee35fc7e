#pragma once

#include "scenes/bench_scenes.hpp"

namespace carom::bench {

// One function a scene; those that exist in both dimensions are templates.
template <int D>
BenchWorld<D> large_pyramid();
template <int D>
BenchWorld<D> many_pyramids();
BenchWorld<2> smash();
template <int D>
BenchWorld<D> joint_grid();
BenchWorld<2> tumbler();
BenchWorld<2> spinner();
BenchWorld<2> rain_2();
BenchWorld<3> rain_3();
BenchWorld<3> convex_pile();
template <int D>
BenchWorld<D> sleeping_city();
BenchWorld<3> convex_vs_mesh();
BenchWorld<3> large_world();
BenchWorld<3> wide_pyramid();
BenchWorld<3> pyramid();
BenchWorld<3> ragdoll_pile();

/// The settings that most scenes have in common.
template <int D>
WorldDefinition<D> bench_world() {
    WorldDefinition<D> definition;
    definition.gravity.y = -10;
    return definition;
}

/// A vector of either dimension: z is left out in the plane.
template <int D>
Vec<D> make_vec(double x, double y, [[maybe_unused]] double z) {
    if constexpr (D == 2)
        return {x, y};
    else
        return {x, y, z};
}

/// A body with one box of half lengths `half` and otherwise default material.
template <int D>
BodyDefinition<D> box_body(BodyType type, const Vec<D>& position, const Vec<D>& half, double density) {
    BodyDefinition<D> body;
    body.type = type;
    body.position = position;
    ShapeDefinition<D>& shape = body.shapes.emplace_back();
    shape.geometry = Box<D>{2.0 * half};
    shape.material.density = density;
    return body;
}

}  // namespace carom::bench
