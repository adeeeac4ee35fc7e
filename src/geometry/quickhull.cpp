#include <cassert>

#include "geometry/hull.hpp"

namespace carom::detail {
namespace {

LatticePoint operator-(const LatticePoint& a, const LatticePoint& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
LatticePoint cross(const LatticePoint& a, const LatticePoint& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// Exact for a = cross of two differences and b a difference: |a · b| ≤ (√3 lattice_size)³ < 2⁶³.
std::int64_t dot(const LatticePoint& a, const LatticePoint& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const LatticePoint& a) {
    const double x = static_cast<double>(a[0]), y = static_cast<double>(a[1]), z = static_cast<double>(a[2]);
    return std::sqrt(x * x + y * y + z * z);
}

struct Triangle : HullTriangle {
    LatticePoint normal;  ///< outwards; its length is twice the area
    double normal_length;
    std::vector<std::uint32_t> outside;  ///< points strictly above this triangle, each in one list only
    bool alive = true, visible = false;
};

struct HorizonEdge {
    std::uint32_t from, to;
    std::uint32_t beyond;  ///< the triangle that stays
};

class Builder {
  public:
    Builder(const std::vector<LatticePoint>& points, double tolerance)
        : points_(points), tolerance_(tolerance) {}

    std::vector<HullTriangle> build() {
        if (!start()) return {};
        for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
            if (!triangles_[i].alive) continue;
            const auto eye = furthest_outside(triangles_[i]);
            if (eye != none) add(eye, i);
        }
        return result();
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;

    /// Six times the volume of the tetrahedron under the point: positive outside.
    std::int64_t height(const Triangle& t, std::uint32_t point) const {
        return dot(t.normal, points_[point] - points_[t.corners[0]]);
    }

    std::uint32_t make(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        Triangle t{};
        t.corners = {a, b, c};
        t.normal = cross(points_[b] - points_[a], points_[c] - points_[a]);
        t.normal_length = length(t.normal);
        triangles_.push_back(std::move(t));
        return static_cast<std::uint32_t>(triangles_.size() - 1);
    }

    /// The first point for which the measure is largest.
    template <class Measure>
    std::uint32_t furthest(Measure measure) const {
        std::uint32_t best = 0;
        double largest = -1;
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            const double value = measure(points_[i]);
            if (value > largest) {
                largest = value;
                best = i;
            }
        }
        return best;
    }

    /// A tetrahedron of points that lie far apart.
    bool start() {
        const LatticePoint& origin = points_[0];
        const auto a = furthest([&](const LatticePoint& p) { return length(p - origin); });
        const auto b = furthest([&](const LatticePoint& p) { return length(p - points_[a]); });
        const LatticePoint ab = points_[b] - points_[a];
        const auto c = furthest([&](const LatticePoint& p) { return length(cross(ab, p - points_[a])); });
        const LatticePoint normal = cross(ab, points_[c] - points_[a]);
        const auto above = [&](const LatticePoint& p) {
            return static_cast<double>(dot(normal, p - points_[a]));
        };
        auto d = furthest([&](const LatticePoint& p) { return std::fabs(above(p)); });
        if (!(std::fabs(above(points_[d])) > tolerance_ * length(normal))) return false;

        const bool swap = above(points_[d]) > 0;
        const auto first = make(a, swap ? c : b, swap ? b : c);
        const auto [p, q, r] = triangles_[first].corners;
        make(q, p, d);
        make(r, q, d);
        make(p, r, d);
        triangles_[0].neighbours = {1, 2, 3};
        triangles_[1].neighbours = {0, 3, 2};
        triangles_[2].neighbours = {0, 1, 3};
        triangles_[3].neighbours = {0, 2, 1};
        std::vector<std::uint32_t> all(points_.size());
        for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
        distribute(all, 0);
        return true;
    }

    /// Gives each point that lies outside to that one of the triangles from `first` on which it is furthest
    /// above.
    void distribute(const std::vector<std::uint32_t>& points, std::uint32_t first) {
        for (const auto point : points) {
            double furthest_above = 0;
            std::uint32_t best = none;
            for (auto i = first; i < triangles_.size(); ++i) {
                const double above =
                    static_cast<double>(height(triangles_[i], point)) / triangles_[i].normal_length;
                if (above > furthest_above) {
                    furthest_above = above;
                    best = i;
                }
            }
            if (best != none) triangles_[best].outside.push_back(point);
        }
    }

    std::uint32_t furthest_outside(const Triangle& t) const {
        double furthest_above = tolerance_ * t.normal_length;
        std::uint32_t best = none;
        for (const auto point : t.outside) {
            const double above = static_cast<double>(height(t, point));
            if (above > furthest_above) {
                furthest_above = above;
                best = point;
            }
        }
        return best;
    }

    /// The triangles that the eye sees, and the closed chain of edges around them.
    void look(std::uint32_t eye, std::uint32_t seen) {
        visible_.assign(1, seen);
        horizon_.clear();
        triangles_[seen].visible = true;
        for (std::size_t k = 0; k < visible_.size(); ++k) {
            const Triangle& t = triangles_[visible_[k]];
            for (int i = 0; i < 3; ++i) {
                const auto neighbour = t.neighbours[i];
                Triangle& other = triangles_[neighbour];
                if (other.visible) continue;
                if (height(other, eye) > 0) {
                    other.visible = true;
                    visible_.push_back(neighbour);
                } else {
                    horizon_.push_back({t.corners[i], t.corners[(i + 1) % 3], neighbour});
                }
            }
        }
        // In order along the chain. It is simple, because the predicate is exact and the surface convex.
        for (std::size_t k = 1; k < horizon_.size(); ++k) {
            const auto next = std::find_if(horizon_.begin() + static_cast<std::ptrdiff_t>(k), horizon_.end(),
                                           [&](const auto& e) { return e.from == horizon_[k - 1].to; });
            assert(next != horizon_.end());
            std::swap(horizon_[k], *next);
        }
    }

    /// Replaces what the eye sees by a fan of triangles from the horizon to the eye.
    void add(std::uint32_t eye, std::uint32_t seen) {
        look(eye, seen);
        const auto first = static_cast<std::uint32_t>(triangles_.size());
        const auto count = static_cast<std::uint32_t>(horizon_.size());
        for (std::uint32_t k = 0; k < count; ++k) {
            const HorizonEdge& edge = horizon_[k];
            const auto fresh = make(edge.from, edge.to, eye);
            triangles_[fresh].neighbours = {edge.beyond, first + (k + 1) % count,
                                            first + (k + count - 1) % count};
            Triangle& beyond = triangles_[edge.beyond];
            for (int i = 0; i < 3; ++i) {
                if (beyond.corners[i] == edge.to) beyond.neighbours[i] = fresh;
            }
        }
        std::vector<std::uint32_t> orphans;
        for (const auto i : visible_) {
            Triangle& t = triangles_[i];
            t.alive = false;
            orphans.insert(orphans.end(), t.outside.begin(), t.outside.end());
            t.outside = {};
        }
        distribute(orphans, first);
    }

    std::vector<HullTriangle> result() const {
        std::vector<std::uint32_t> number(triangles_.size(), none);
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            if (triangles_[i].alive) number[i] = count++;
        }
        std::vector<HullTriangle> hull;
        for (const Triangle& t : triangles_) {
            if (!t.alive) continue;
            hull.push_back(
                {t.corners, {number[t.neighbours[0]], number[t.neighbours[1]], number[t.neighbours[2]]}});
        }
        return hull;
    }

    const std::vector<LatticePoint>& points_;
    double tolerance_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> visible_;
    std::vector<HorizonEdge> horizon_;
};

}  // namespace

std::vector<HullTriangle> quickhull(const std::vector<LatticePoint>& points, double tolerance) {
    return Builder(points, tolerance).build();
}

}  // namespace carom::detail
