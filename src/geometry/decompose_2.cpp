#include <algorithm>
#include <limits>
#include <string>

#include "carom/decompose.hpp"
#include "geometry/hull.hpp"

namespace carom {

namespace {

using namespace detail;

using Ring = std::vector<std::uint32_t>;  ///< corners, counter-clockwise

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

double area(const std::vector<Vec2>& p) {
    double twice = 0;
    for (std::size_t i = 0; i < p.size(); ++i) twice += cross(p[i] - p[0], p[(i + 1) % p.size()] - p[0]);
    return 0.5 * twice;
}

/// Do the segments have a point in common?
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
    const double at_c = turn(a, b, c), at_d = turn(a, b, d), at_a = turn(c, d, a), at_b = turn(c, d, b);
    if (at_c * at_d < 0 && at_a * at_b < 0) return true;
    const auto on = [](double side, const Vec2& p, const Vec2& q, const Vec2& x) {
        return side == 0 && dot(p - x, q - x) <= 0;
    };
    return on(at_c, a, b, c) || on(at_d, a, b, d) || on(at_a, c, d, a) || on(at_b, c, d, b);
}

std::string edge_name(std::size_t i) { return "outline[" + std::to_string(i) + "]"; }

void check_outline(const std::vector<Vec2>& p) {
    check_points<2>(p);
    const std::size_t count = p.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (p[i] == p[(i + 1) % count])
            throw Error(edge_name((i + 1) % count) + ": lies at the same place as " + edge_name(i));
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 2; j < count; ++j) {
            if (i == 0 && j + 1 == count) continue;  // neighbours
            if (meet(p[i], p[i + 1], p[j], p[(j + 1) % count]))
                throw Error("outline: the edges from " + edge_name(i) + " and from " + edge_name(j) +
                            " meet");
        }
    }
}

/// Cuts off ears, the best formed first.
class EarClipper {
  public:
    EarClipper(const std::vector<Vec2>& points, const Ring& ring) : points_(points), ring_(ring) {
        for (std::size_t i = 0; i < ring_.size(); ++i) quality_.push_back(quality(i));
    }

    std::vector<Ring> run() {
        std::vector<Ring> triangles;
        while (ring_.size() > 3) {
            const auto best = std::max_element(quality_.begin(), quality_.end());
            const auto i = std::size_t(best - quality_.begin());
            triangles.push_back({ring_[before(i)], ring_[i], ring_[after(i)]});
            ring_.erase(ring_.begin() + std::ptrdiff_t(i));
            quality_.erase(best);
            const std::size_t next = i % ring_.size(), previous = before(next);
            quality_[next] = quality(next);
            quality_[previous] = quality(previous);
        }
        triangles.push_back(ring_);
        return triangles;
    }

  private:
    std::size_t before(std::size_t i) const { return (i + ring_.size() - 1) % ring_.size(); }
    std::size_t after(std::size_t i) const { return (i + 1) % ring_.size(); }
    const Vec2& at(std::size_t i) const { return points_[ring_[i]]; }

    /// How far the triangle at corner i is from a sliver, 0 … 1; negative where it is no ear. An ear that
    /// only rounding spoils is better than none.
    double quality(std::size_t i) const {
        const Vec2 &a = at(before(i)), &b = at(i), &c = at(after(i));
        const double twice = turn(a, b, c);
        const double longest =
            std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
        if (twice <= 0) return -1 + twice / longest;
        for (std::size_t k = 0; k < ring_.size(); ++k) {
            if (k == i || k == before(i) || k == after(i)) continue;
            if (turn(a, b, at(k)) >= 0 && turn(b, c, at(k)) >= 0 && turn(c, a, at(k)) >= 0) return -2;
        }
        return twice / longest;
    }

    const std::vector<Vec2>& points_;
    Ring ring_;
    std::vector<double> quality_;
};

/// Where in the ring the edge from one corner to another begins; the ring's size if it is not there.
std::size_t find_edge(const Ring& ring, std::uint32_t from, std::uint32_t to) {
    for (std::size_t i = 0; i < ring.size(); ++i)
        if (ring[i] == from && ring[(i + 1) % ring.size()] == to) return i;
    return ring.size();
}

/// Joins two rings along the edge that leads from `from` to `to` in the first and back in the second.
Ring joined(const Ring& first, std::size_t edge, const Ring& second, std::size_t back) {
    Ring result;
    for (std::size_t i = 1; i <= first.size(); ++i) result.push_back(first[(edge + i) % first.size()]);
    for (std::size_t i = 2; i < second.size(); ++i) result.push_back(second[(back + i) % second.size()]);
    return result;
}

bool is_convex(const std::vector<Vec2>& points, const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::size_t next = (i + 1) % ring.size(), last = (i + 2) % ring.size();
        if (turn(points[ring[i]], points[ring[next]], points[ring[last]]) < 0) return false;
    }
    return true;
}

/// Takes away every diagonal that is not needed for the pieces to be convex, long ones first.
void join_pieces(const std::vector<Vec2>& points, std::vector<Ring>& pieces) {
    struct Diagonal {
        std::uint32_t from, to;
        double square;
    };
    std::vector<Diagonal> diagonals;
    const auto count = std::uint32_t(points.size());
    for (const Ring& ring : pieces) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const std::uint32_t from = ring[i], to = ring[(i + 1) % ring.size()];
            if (from < to && to - from > 1 && !(from == 0 && to == count - 1))
                diagonals.push_back({from, to, length_squared(points[to] - points[from])});
        }
    }
    std::stable_sort(diagonals.begin(), diagonals.end(),
                     [](const Diagonal& a, const Diagonal& b) { return a.square > b.square; });
    for (const Diagonal& diagonal : diagonals) {
        const auto holding = [&](std::uint32_t from, std::uint32_t to) {
            return std::find_if(pieces.begin(), pieces.end(),
                                [&](const Ring& ring) { return find_edge(ring, from, to) < ring.size(); });
        };
        const auto first = holding(diagonal.from, diagonal.to), second = holding(diagonal.to, diagonal.from);
        if (first == pieces.end() || second == pieces.end() || first == second) continue;
        Ring both = joined(*first, find_edge(*first, diagonal.from, diagonal.to), *second,
                           find_edge(*second, diagonal.to, diagonal.from));
        if (!is_convex(points, both)) continue;
        *first = std::move(both);
        pieces.erase(second);
    }
}

/// Is the ring thick enough to be a hull?
bool is_hull(const Hull2& hull) {
    try {
        convex_polygon(hull.points);
        return true;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace

std::vector<Hull2> convex_pieces(const std::vector<Vec2>& outline) {
    check_outline(outline);
    std::vector<Vec2> points = outline;
    if (area(points) < 0) std::reverse(points.begin(), points.end());
    Ring ring(points.size());
    for (std::uint32_t i = 0; i < ring.size(); ++i) ring[i] = i;
    std::vector<Ring> pieces{ring};
    if (!is_convex(points, ring)) {
        pieces = EarClipper(points, ring).run();
        join_pieces(points, pieces);
    }
    std::vector<Hull2> hulls;
    for (const Ring& piece : pieces) {
        Hull2 hull;
        for (const std::uint32_t corner : piece) hull.points.push_back(points[corner]);
        if (is_hull(hull)) hulls.push_back(std::move(hull));
    }
    if (hulls.empty()) throw Error("outline: it has no area");
    return hulls;
}

}  // namespace carom
