#pragma once

#include <vector>

#include "io/replay.hpp"
#include "io/scene.hpp"

namespace carom::io {

/// Writes down what happens in the world of a scene, for a replay.
template <int D>
class Recorder {
  public:
    /// Takes down what does not change: names, shapes, masses, materials.
    Recorder(const Scene& scene, const SceneWorld<D>& built);

    /// Takes down the present: call it before the first step and after each.
    void record_frame(const World<D>& world);

    const Replay& replay() const { return replay_; }

  private:
    std::vector<BodyId<D>> bodies_;
    std::vector<std::vector<ShapeId<D>>> sensors_;  ///< of each body
    std::vector<std::int32_t> index_of_;            ///< in the scene, by the index in the body's handle
    Replay replay_;
};

}  // namespace carom::io
