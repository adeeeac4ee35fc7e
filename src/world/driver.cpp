#include "carom/driver.hpp"

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {

using namespace detail;

namespace {

/// Between two rotations along the shorter way. The chord is cut and brought back to length: for the small
/// turns of one step this differs from the arc by less than can be seen.
Rotation2 between(const Rotation2& a, const Rotation2& b, double t) {
    const Rotation2 q{a.c + t * (b.c - a.c), a.s + t * (b.s - a.s)};
    return q.c * q.c + q.s * q.s > 1e-12 ? normalized(q) : b;
}
Rotation3 between(const Rotation3& a, const Rotation3& b, double t) {
    const double sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? -1 : 1;
    const auto mix = [&](double from, double to) { return from + t * (sign * to - from); };
    return normalized(Rotation3{mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), mix(a.w, b.w)});
}

}  // namespace

template <int D>
FixedStepDriver<D>::FixedStepDriver(World<D>& world, double step, int max_steps)
    : world_(&world), step_(step), max_steps_(max_steps) {
    require_positive(step, "step");
    require_in(step, 0, 1, "step");
    require_in(max_steps, 1, 1e6, "max_steps");
    remember();
}

template <int D>
void FixedStepDriver<D>::remember() {
    for (const BodyId<D>& id : world_->bodies()) {
        if (id.index >= previous_.size()) previous_.resize(id.index + 1);
        previous_[id.index] = {id, world_->transform(id)};
    }
}

template <int D>
int FixedStepDriver<D>::advance(double frame_time) {
    require_not_negative(frame_time, "frame_time");
    accumulated_ += frame_time;
    // Sums of frame times are rounded: a step that is due but for a billionth of itself is due.
    const double due = step_ * (1 - 1e-9);
    int taken = 0;
    while (accumulated_ >= due && taken < max_steps_) {
        remember();
        world_->step(step_);
        accumulated_ = accumulated_ > step_ ? accumulated_ - step_ : 0;
        ++taken;
    }
    if (accumulated_ >= due) accumulated_ = 0;
    return taken;
}

template <int D>
Transform<D> FixedStepDriver<D>::interpolated(BodyId<D> body) const {
    const Transform<D> now = world_->transform(body);
    const bool known = body.index < previous_.size() && previous_[body.index].body == body;
    if (!known) return now;
    const Transform<D>& last = previous_[body.index].transform;
    return {last.position + alpha() * (now.position - last.position),
            between(last.rotation, now.rotation, alpha())};
}

template <int D>
void FixedStepDriver<D>::teleport(BodyId<D> body, const Transform<D>& transform) {
    world_->set_transform(body, transform);
    if (body.index < previous_.size()) previous_[body.index] = {body, world_->transform(body)};
}

template class FixedStepDriver<2>;
template class FixedStepDriver<3>;

}  // namespace carom
