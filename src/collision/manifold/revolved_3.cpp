#include <algorithm>
#include <cmath>

#include "collision/epa_3.hpp"
#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

namespace {

bool is_revolved(const Shape<3>& shape) {
    return shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone;
}

/// Keeps the direction of the widest gap of those that are offered.
class Candidates {
  public:
    explicit Candidates(const Pair3& pair) : pair_(pair) {}

    void offer(const Vec3& normal, bool of_face = false) {
        const double gap = gap_along(pair_, normal).distance;
        if (gap <= widest_.distance) return;
        widest_ = {normal, gap};
        of_face_ = of_face;
    }
    void offer_both(const Vec3& axis, bool of_face = false) {
        if (length_squared(axis) <= 1e-12) return;
        offer(normalized(axis), of_face);
        offer(-normalized(axis), of_face);
    }
    const Gap3& widest() const { return widest_; }
    bool is_of_face() const { return of_face_; }

  private:
    const Pair3& pair_;
    Gap3 widest_;
    bool of_face_ = false;
};

/// Offers the normals of the flat faces of one of the shapes; `sign` is +1 for a, −1 for b.
void offer_faces(Candidates& candidates, const Shape<3>& shape, const Rotation3& turn, double sign) {
    if (shape.kind == ShapeKind::cone) {
        candidates.offer(-sign * rotate(turn, shape.b), true);
    } else if (shape.kind == ShapeKind::cylinder) {
        candidates.offer_both(rotate(turn, shape.b), true);
    } else if (shape.core) {
        for (const Vec3& normal : shape.core->normals) candidates.offer(sign * rotate(turn, normal), true);
    }
}

/// Directions in which such shapes often rest on each other: along flat faces, across two axes, and straight
/// away from an axis.
Candidates likely_directions(const Pair3& pair) {
    Candidates candidates(pair);
    const Rotation3& turn = pair.b_in_a.rotation;
    offer_faces(candidates, pair.a, {}, 1);
    offer_faces(candidates, pair.b, turn, -1);
    const Vec3 axis_b = rotate(turn, pair.b.b), axis_a = is_revolved(pair.a) ? pair.a.b : pair.a.b - pair.a.a;
    const Vec3 apart = apply(pair.b_in_a, pair.b.a) - pair.a.a;
    if (!pair.a.core) candidates.offer_both(cross(axis_a, axis_b));
    candidates.offer_both(apart - dot(apart, axis_b) * axis_b);
    return candidates;
}

/// Sharpens the direction of the widest gap. With b moved along the direction until the cores are `clearance`
/// apart, their closest points give a better one: where they overlap, the error shrinks each time by about
/// clearance over radius of curvature. Where flat faces meet, the first step is exact.
Nearest3 sharpened(const Pair3& pair, const Vec3& start, double clearance, int most_steps) {
    Nearest3 best = gap_along(pair, start);
    for (int i = 0; i < most_steps; ++i) {
        const Vec3 shift = (clearance - best.distance) * best.normal;
        const Transform3 moved{pair.b_in_a.position + shift, pair.b_in_a.rotation};
        const CoreDistance<3> found = core_distance<3>(pair.a, pair.b, moved);
        if (found.overlap) break;
        best.on_a = found.on_a;
        best.on_b = found.on_b - shift;
        const double gap = gap_along(pair, found.axis).distance;
        if (gap <= best.distance) break;
        const bool settled = gap - best.distance <= 1e-5 * std::fabs(gap);
        best.normal = found.axis;
        best.distance = gap;
        if (settled) break;
    }
    return best;
}

/// As well as rounding allows.
Nearest3 exactly(const Pair3& pair, const Gap3& likely, double extent) {
    const CoreDistance<3> found = core_distance<3>(pair.a, pair.b, pair.b_in_a);
    if (!found.overlap && found.distance <= likely.distance + 1e-9 * extent)
        return {likely.normal, likely.distance, found.on_a, found.on_b};
    Gap3 guess = likely;
    if (!found.overlap) {
        const double gap = gap_along(pair, found.axis).distance;
        if (gap > found.distance - 1e-9 * extent) return {found.axis, found.distance, found.on_a, found.on_b};
        // Rounding blurs the direction between closest points that all but touch.
        if (gap > guess.distance) guess = {found.axis, gap};
    }
    const Gap3 widest = widest_gap(pair.a, pair.b, pair.b_in_a, guess, 1e-7 * extent, 0);
    const double clearance = std::max(std::fabs(widest.distance), 1e-4 * extent);
    Nearest3 best = sharpened(pair, widest.normal, clearance, 16);
    if (widest.certain) return best;
    // Then each of many directions is followed to the widest gap near it.
    for (int i = 0; i < 27; ++i) {
        const Vec3 start{double(i % 3 - 1), double(i / 3 % 3 - 1), double(i / 9 - 1)};
        if (start == Vec3{}) continue;
        const Nearest3 other = sharpened(pair, normalized(start), clearance, 16);
        if (other.distance > best.distance) best = other;
    }
    return best;
}

/// Cheaply, to within a hundredth of the depth.
Nearest3 nearly(const Pair3& pair, const Search3& search, const Candidates& likely, double extent) {
    const Gap3 widest = widest_gap(pair.a, pair.b, pair.b_in_a, likely.widest(), 1e-5 * extent, 1e-2);
    if (widest.distance > search.limit) return gap_along(pair, widest.normal);
    if (!widest.certain) return exactly(pair, widest, extent);
    if (likely.is_of_face() && widest.distance == likely.widest().distance) {
        Nearest3 nearest = gap_along(pair, widest.normal);
        nearest.certain = false;
        return nearest;
    }
    return sharpened(pair, widest.normal, std::max(std::fabs(widest.distance), 1e-4 * extent), 4);
}

}  // namespace

Nearest3 core_revolved(const Pair3& pair, const Search3& search) {
    const double extent =
        std::min(core_extent(pair.a) + core_radius(pair.a), core_extent(pair.b) + core_radius(pair.b));
    const Candidates likely = likely_directions(pair);
    if (likely.widest().distance > search.limit) return gap_along(pair, likely.widest().normal);
    return search.steady ? nearly(pair, search, likely, extent) : exactly(pair, likely.widest(), extent);
}

}  // namespace carom::detail
