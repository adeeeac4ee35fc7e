#include "collision/epa_3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace carom::detail {

namespace {

constexpr int most_vertices = 256;
constexpr std::uint32_t none = 0xffffffffu;

/// A triangle of the polytope: counter-clockwise from outside, `neighbors[k]` across the edge from corner k
/// to k + 1.
struct Triangle {
    std::array<std::uint32_t, 3> corners;
    std::array<std::uint32_t, 3> neighbors;
    Vec3 normal;
    double offset;
    bool alive;
};

/// An edge of the horizon: seen from the new vertex, what lies behind `beyond` stays.
struct HorizonEdge {
    std::uint32_t from, to, beyond;
};

class Expansion {
  public:
    Expansion(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a, const Gap3& guess)
        : a_(a), b_(b), b_in_a_(b_in_a), best_(guess) {
        vertices_.reserve(64);
        triangles_.reserve(192);
        queue_.reserve(192);
    }

    Gap3 run(double tolerance, double share) {
        if (!begin()) return uncertain();
        while (vertices_.size() < most_vertices && !queue_.empty()) {
            const std::uint32_t nearest = take_nearest();
            if (!triangles_[nearest].alive) continue;
            const Vec3 normal = triangles_[nearest].normal;
            const double offset = triangles_[nearest].offset;
            // The polytope lies within the difference: no direction has less depth than its nearest face.
            if (-best_.distance - offset <= tolerance + share * std::fabs(best_.distance)) return best_;
            const Vec3 vertex = extreme(normal);
            // Where nothing lies beyond, this is the surface itself, and the best over it is known.
            if (dot(normal, vertex) - offset > 1e-3 * tolerance && !grow(nearest, vertex)) return uncertain();
        }
        return queue_.empty() ? best_ : uncertain();
    }

  private:
    Gap3 uncertain() const { return {best_.normal, best_.distance, false}; }

    Vec3 extreme(const Vec3& direction) {
        const Vec3 vertex = difference_support<3>(a_, b_, b_in_a_, direction).difference;
        const double gap = -dot(direction, vertex);
        if (gap > best_.distance) best_ = {direction, gap};
        return vertex;
    }

    /// The first tetrahedron, as wide as extreme points along the axes of the frame allow.
    bool begin() {
        std::array<Vec3, 6> extremes;
        for (std::size_t i = 0; i < 6; ++i) {
            Vec3 direction{};
            direction[static_cast<int>(i / 2)] = i % 2 == 0 ? 1 : -1;
            extremes[i] = extreme(direction);
        }
        std::array<Vec3, 4> corners{};
        double widest = -1;
        for (std::size_t i = 0; i < 6; i += 2) {
            const double width = length_squared(extremes[i] - extremes[i + 1]);
            if (width <= widest) continue;
            widest = width;
            corners[0] = extremes[i];
            corners[1] = extremes[i + 1];
        }
        const Vec3 along = normalized(corners[1] - corners[0]);
        if (!furthest_across(extremes, corners, along)) return false;
        Vec3 normal = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
        const Vec3 above = extreme(normal), below = extreme(-normal);
        const double up = dot(normal, above - corners[0]), down = dot(normal, corners[0] - below);
        corners[3] = up >= down ? above : below;
        if (std::max(up, down) <= 0) return false;
        if (up >= down) std::swap(corners[1], corners[2]);  // so that the fourth lies behind the first three
        vertices_.assign(corners.begin(), corners.end());
        add({0, 1, 2}, {1, 2, 3});
        add({1, 0, 3}, {0, 3, 2});
        add({2, 1, 3}, {0, 1, 3});
        add({0, 2, 3}, {0, 2, 1});
        return true;
    }

    /// The third corner: an extreme point off the line through the first two.
    bool furthest_across(const std::array<Vec3, 6>& extremes, std::array<Vec3, 4>& corners,
                         const Vec3& along) {
        const auto off_line = [&](const Vec3& p) { return length_squared(cross(along, p - corners[0])); };
        corners[2] = *std::max_element(extremes.begin(), extremes.end(), [&](const Vec3& p, const Vec3& q) {
            return off_line(p) < off_line(q);
        });
        for (int i = 0; i < 3 && off_line(corners[2]) <= 1e-24 * length_squared(corners[1] - corners[0]);
             ++i) {
            Vec3 axis{};
            axis[i] = 1;
            const Vec3 across = cross(along, axis);
            if (length(across) > 0.1) corners[2] = extreme(normalized(across));
        }
        return off_line(corners[2]) > 0;
    }

    void add(const std::array<std::uint32_t, 3>& corners, const std::array<std::uint32_t, 3>& neighbors) {
        const Vec3 &p = vertices_[corners[0]], &q = vertices_[corners[1]], &r = vertices_[corners[2]];
        const Vec3 across = cross(q - p, r - p);
        const double size = length(across);
        // A triangle without area has no normal; its neighbours cover its place.
        const bool flat = size <= 1e-14 * (length_squared(q - p) + length_squared(r - p));
        const Vec3 normal = flat ? Vec3{} : across / size;
        triangles_.push_back({corners, neighbors, normal, dot(normal, p), true});
        if (flat) return;
        queue_.push_back(static_cast<std::uint32_t>(triangles_.size() - 1));
        std::push_heap(queue_.begin(), queue_.end(), [this](auto i, auto j) { return later(i, j); });
    }

    /// Of two triangles, the one that is taken later: the further one, or the newer of equals.
    bool later(std::uint32_t i, std::uint32_t j) const {
        const double p = triangles_[i].offset, q = triangles_[j].offset;
        return p != q ? p > q : i > j;
    }

    std::uint32_t take_nearest() {
        std::pop_heap(queue_.begin(), queue_.end(), [this](auto i, auto j) { return later(i, j); });
        const std::uint32_t nearest = queue_.back();
        queue_.pop_back();
        return nearest;
    }

    bool sees(const Vec3& vertex, const Triangle& triangle) const {
        return dot(triangle.normal, vertex - vertices_[triangle.corners[0]]) > 0;
    }

    /// Collects the horizon of what the vertex sees, in order round it, beginning across `edge` of `index`.
    void flood(std::uint32_t index, std::uint32_t came_from, const Vec3& vertex) {
        triangles_[index].alive = false;
        std::uint32_t start = 0;
        while (start < 3 && triangles_[index].neighbors[start] != came_from) ++start;
        for (std::uint32_t k = start < 3 ? 1 : 0; k < 3; ++k) {
            const std::uint32_t edge = (start + k) % 3;
            const std::uint32_t next = triangles_[index].neighbors[edge];
            if (!triangles_[next].alive) continue;
            if (sees(vertex, triangles_[next])) {
                flood(next, index, vertex);
            } else {
                const auto& corners = triangles_[index].corners;
                horizon_.push_back({corners[edge], corners[(edge + 1) % 3], next});
            }
        }
    }

    /// Replaces what the vertex sees by a fan from the vertex to the horizon.
    bool grow(std::uint32_t nearest, const Vec3& vertex) {
        horizon_.clear();
        flood(nearest, none, vertex);
        const auto apex = static_cast<std::uint32_t>(vertices_.size());
        const auto first = static_cast<std::uint32_t>(triangles_.size());
        const auto count = static_cast<std::uint32_t>(horizon_.size());
        vertices_.push_back(vertex);
        for (std::uint32_t i = 0; i < count; ++i) {
            const HorizonEdge& edge = horizon_[i];
            if (edge.to != horizon_[(i + 1) % count].from) return false;  // torn by rounding
            add({edge.from, edge.to, apex},
                {edge.beyond, first + (i + 1) % count, first + (i + count - 1) % count});
            for (std::uint32_t k = 0; k < 3; ++k) {
                if (triangles_[edge.beyond].corners[k] == edge.to)
                    triangles_[edge.beyond].neighbors[k] = first + i;
            }
        }
        return count >= 3;
    }

    const Shape<3>& a_;
    const Shape<3>& b_;
    const Transform<3>& b_in_a_;
    Gap3 best_;
    std::vector<Vec3> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> queue_;  ///< a heap of triangles, the nearest to the origin first
    std::vector<HorizonEdge> horizon_;
};

}  // namespace

Gap3 widest_gap(const Shape<3>& a, const Shape<3>& b, const Transform<3>& b_in_a, const Gap3& guess,
                double tolerance, double share) {
    return Expansion(a, b, b_in_a, guess).run(tolerance, share);
}

}  // namespace carom::detail
