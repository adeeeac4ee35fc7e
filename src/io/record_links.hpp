#pragma once

#include <vector>

#include "io/replay.hpp"
#include "io/scene.hpp"

namespace carom::io {

/// What is drawn of the joints of a scene as it starts: ropes and rods, springs, rails and paths, axes,
/// anchors, and lines from anchors to the bodies that do not reach them. Joints that may break are not drawn,
/// as links are there from a replay's first frame to its last.
template <int D>
std::vector<ReplayLink> joint_links(const SceneWorld<D>& scene);

}  // namespace carom::io
