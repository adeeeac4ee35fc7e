#pragma once

#include "io/scene_check.hpp"

namespace carom::io {

/// What is suspicious about the joints of a scene, of which `built` was made: added to `found`.
template <int D>
void check_joints(const Scene& scene, const SceneWorld<D>& built, std::vector<Suspicion>& found);

}  // namespace carom::io
