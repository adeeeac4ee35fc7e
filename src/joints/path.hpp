#pragma once

#include "dynamics/joint.hpp"

namespace carom::detail {

/// Brings the rows of a joint along a path to where a point, in the frame of a, is nearest to it.
template <int D>
void follow_path(JointRecord<D>& record, const Vec<D>& point);

}  // namespace carom::detail
