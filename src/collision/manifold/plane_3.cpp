#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

Nearest3 core_plane(const Pair3& pair, const Search3&) {
    const Vec3 outward = rotate(pair.b_in_a.rotation, pair.b.a);
    const double offset = pair.b.offset + dot(outward, pair.b_in_a.position);
    const Vec3 lowest = core_support(pair.a, -outward);
    const double gap = dot(outward, lowest) - offset;
    return {-outward, gap, lowest, lowest - gap * outward};
}

}  // namespace carom::detail
