#pragma once

#include <vector>

#include "carom/world.hpp"

namespace carom {

/// Runs a world at a fixed step under a render loop of any frame rate, and gives placements in between the
/// last two steps, so that motion looks smooth. (G. Fiedler, "Fix your timestep!", 2004.)
template <int D>
class FixedStepDriver {
  public:
    /// `step`: seconds a step (positive, at most 1). `max_steps`: most steps in one frame (at least 1);
    /// time beyond them is dropped, so that a slow machine does not fall behind for ever.
    explicit FixedStepDriver(World<D>& world, double step = 1.0 / 60, int max_steps = 8);

    /// Adds `frame_time` seconds (finite, not negative) and takes the steps that have become due.
    /// Returns how many were taken.
    int advance(double frame_time);

    /// How far the present lies between the last two steps, 0 … 1.
    double alpha() const { return accumulated_ / step_; }

    /// The body's placement at the present, between the last two steps. A body that was just added or
    /// teleported is where it is, not smeared in between.
    Transform<D> interpolated(BodyId<D> body) const;

    /// Places the body elsewhere at once, without drawing it on the way there.
    void teleport(BodyId<D> body, const Transform<D>& transform);

  private:
    struct Previous {
        BodyId<D> body{};
        Transform<D> transform{};
    };
    void remember();

    World<D>* world_;
    double step_;
    int max_steps_;
    double accumulated_ = 0;
    std::vector<Previous> previous_;  ///< by body index
};

using FixedStepDriver2 = FixedStepDriver<2>;
using FixedStepDriver3 = FixedStepDriver<3>;

}  // namespace carom
