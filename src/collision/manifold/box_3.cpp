#include <algorithm>
#include <array>
#include <cmath>

#include "collision/manifold/nearest_3.hpp"

namespace carom::detail {

namespace {

/// Two boxes in the frame of the first one's axes.
struct Boxes {
    Boxes(const Pair3& pair)
        : a(pair.a.b),
          b(pair.b.b),
          placed(
              relative<3>({pair.a.a, pair.a.rotation}, pair.b_in_a * Transform3{pair.b.a, pair.b.rotation})) {
        for (int j = 0; j < 3; ++j) {
            Vec3 unit{};
            unit[j] = 1;
            axes[static_cast<std::size_t>(j)] = rotate(placed.rotation, unit);
        }
    }

    double cosine(int i, int j) const { return axes[static_cast<std::size_t>(j)][i]; }
    const Vec3& axis(int j) const { return axes[static_cast<std::size_t>(j)]; }

    Vec3 a, b;  ///< half lengths
    Transform3 placed;
    std::array<Vec3, 3> axes;  ///< those of b
};

/// An axis of a box, or one across an axis i of a and an axis j of b.
struct Candidate {
    double gap = -1e300;
    int i = -1, j = -1;
    Vec3 normal{};  ///< only of an axis across two edges
};

Candidate widest_of_a(const Boxes& boxes) {
    Candidate widest;
    for (int i = 0; i < 3; ++i) {
        double gap = std::fabs(boxes.placed.position[i]) - boxes.a[i];
        for (int j = 0; j < 3; ++j) gap -= std::fabs(boxes.cosine(i, j)) * boxes.b[j];
        if (gap > widest.gap) widest = {gap, i, -1};
    }
    return widest;
}

Candidate widest_of_b(const Boxes& boxes) {
    Candidate widest;
    for (int j = 0; j < 3; ++j) {
        double gap = std::fabs(dot(boxes.placed.position, boxes.axis(j))) - boxes.b[j];
        for (int i = 0; i < 3; ++i) gap -= std::fabs(boxes.cosine(i, j)) * boxes.a[i];
        if (gap > widest.gap) widest = {gap, -1, j};
    }
    return widest;
}

Candidate widest_of_edges(const Boxes& boxes) {
    Candidate widest;
    for (int i = 0; i < 3; ++i) {
        Vec3 edge_a{};
        edge_a[i] = 1;
        for (int j = 0; j < 3; ++j) {
            const Vec3 across = cross(edge_a, boxes.axis(j));
            const double size = length(across);
            if (size < 1e-7) continue;
            const Vec3 normal = across / (dot(across, boxes.placed.position) < 0 ? -size : size);
            double gap = dot(normal, boxes.placed.position);
            for (int k = 0; k < 3; ++k)
                gap -= std::fabs(normal[k]) * boxes.a[k] + std::fabs(dot(normal, boxes.axis(k))) * boxes.b[k];
            if (gap > widest.gap) widest = {gap, i, j, normal};
        }
    }
    return widest;
}

/// The corner of a box that lies furthest along `direction`, both in the box's axes; a component below zero
/// by rounding alone counts as zero, so that flat sides always give the same corner.
Vec3 corner(const Vec3& half, const Vec3& direction) {
    return {direction.x < -1e-9 ? -half.x : half.x, direction.y < -1e-9 ? -half.y : half.y,
            direction.z < -1e-9 ? -half.z : half.z};
}

Nearest3 at_face_of_a(const Boxes& boxes, const Candidate& face) {
    Vec3 normal{};
    normal[face.i] = boxes.placed.position[face.i] < 0 ? -1 : 1;
    const Vec3 on_b = apply(boxes.placed, corner(boxes.b, unrotate(boxes.placed.rotation, -normal)));
    return {normal, face.gap, on_b - face.gap * normal, on_b, false};
}

Nearest3 at_face_of_b(const Boxes& boxes, const Candidate& face) {
    const Vec3& axis = boxes.axis(face.j);
    const Vec3 normal = dot(boxes.placed.position, axis) < 0 ? -axis : axis;
    const Vec3 on_a = corner(boxes.a, normal);
    return {normal, face.gap, on_a, on_a + face.gap * normal, false};
}

Nearest3 at_edges(const Boxes& boxes, const Candidate& edges) {
    Vec3 from_a = corner(boxes.a, edges.normal);
    Vec3 from_b = corner(boxes.b, unrotate(boxes.placed.rotation, -edges.normal));
    from_a[edges.i] = -boxes.a[edges.i];
    from_b[edges.j] = -boxes.b[edges.j];
    Vec3 along_a{}, along_b{};
    along_a[edges.i] = 2 * boxes.a[edges.i];
    along_b = 2 * boxes.b[edges.j] * boxes.axis(edges.j);
    from_b = apply(boxes.placed, from_b);
    const SegmentPoints at = closest_on_segments(from_a, along_a, from_b, along_b);
    const bool inside = at.s > 0 && at.s < 1 && at.t > 0 && at.t < 1;
    return {edges.normal, edges.gap, from_a + at.s * along_a, from_b + at.t * along_b,
            edges.gap <= 0 || inside};
}

}  // namespace

// Separating axes of two boxes: three of each, and nine across an edge of one and an edge of the other
// (Gottschalk, Lin and Manocha 1996).
Nearest3 box_box(const Pair3& pair, const Search3& search) {
    const Boxes boxes(pair);
    const double extent = std::min(core_extent(pair.a), core_extent(pair.b));
    const auto preferred = [&](const Candidate& over, const Candidate& favoured) {
        return over.gap > favoured.gap + advantage(pair, search, favoured.gap, extent);
    };

    const Candidate of_a = widest_of_a(boxes);
    Nearest3 nearest;
    if (of_a.gap > search.limit) {
        nearest = at_face_of_a(boxes, of_a);
    } else {
        const Candidate of_b = widest_of_b(boxes);
        const bool b_wins = preferred(of_b, of_a);
        const Candidate& face = b_wins ? of_b : of_a;
        const Candidate of_edges = face.gap > search.limit ? Candidate{} : widest_of_edges(boxes);
        if (preferred(of_edges, face)) {
            nearest = at_edges(boxes, of_edges);
        } else {
            nearest = b_wins ? at_face_of_b(boxes, face) : at_face_of_a(boxes, face);
        }
    }
    const Transform3 axes_of_a{pair.a.a, pair.a.rotation};
    return {rotate(axes_of_a.rotation, nearest.normal), nearest.distance, apply(axes_of_a, nearest.on_a),
            apply(axes_of_a, nearest.on_b), nearest.certain};
}

}  // namespace carom::detail
