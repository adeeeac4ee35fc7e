#pragma once

#include "collision/gjk.hpp"

namespace carom::detail {

/// A direction, and the gap between two cores along it.
struct Gap3 {
    Vec3 normal{};  ///< unit vector from a to b, in a's frame
    double distance = -1e300;
    bool certain = true;  ///< false where rounding ended the search, or its length, before nothing was left
};

/// The widest gap between two cores that overlap or nearly touch, by the expanding polytope algorithm (van
/// den Bergen 2001): the polytope of extreme points of the difference a − b grows where its surface is
/// nearest to the origin, until no direction can beat the best one seen by more than `tolerance` and `share`
/// of its own gap. A good first `guess` ends the search early. One of the cores must have a volume.
Gap3 widest_gap(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a, const Gap3& guess,
                double tolerance, double share);

}  // namespace carom::detail
