#pragma once

#include "scenes/bench_scenes.hpp"

namespace carom::bench {

/// A human of capsules on joints, with friction and springs in them. `group` (from 1 in 2D, from 0 in 3D) is
/// the group of its shapes: those of one human do not touch each other. Returns its bodies.
std::vector<BodyId2> add_human(World2& world, const Vec2& position, int group);
std::vector<BodyId3> add_human(World3& world, const Vec3& position, int group);

}  // namespace carom::bench
