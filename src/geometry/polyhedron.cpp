#include <numeric>
#include <optional>
#include <span>

#include "geometry/hull.hpp"

namespace carom::detail {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

struct FacePlane {
    Vec3 normal;
    double offset = 0;
};

/// The plane through a polygon in space (Newell's method: the normal is the sum of the triangles' area
/// vectors, the offset the mean of the corners').
FacePlane newell(const std::vector<Vec3>& points, std::span<const std::uint32_t> loop) {
    Vec3 area{};
    const Vec3& origin = points[loop[0]];
    for (std::size_t i = 2; i < loop.size(); ++i) {
        area += cross(points[loop[i - 1]] - origin, points[loop[i]] - origin);
    }
    FacePlane plane{normalized(area), 0};
    for (const auto i : loop) plane.offset += dot(plane.normal, points[i]);
    plane.offset /= static_cast<double>(loop.size());
    return plane;
}

/// The convex hull as faces of any number of corners: triangles of one plane made one.
class Merger {
  public:
    Merger(const std::vector<Vec3>& points, const std::vector<HullTriangle>& triangles, double tolerance)
        : points_(points), triangles_(triangles), tolerance_(tolerance), face_of_(triangles.size(), none) {}

    /// Nothing when the result would not be a convex polyhedron, within the tolerance.
    std::optional<Polyhedron> merge() {
        group();
        straighten();
        Polyhedron result = compact();
        if (!connect(result) || !is_convex(result)) return std::nullopt;
        return result;
    }

  private:
    using Loop = std::vector<std::uint32_t>;

    /// Gathers the triangles into faces, the largest triangles first: all around that lie in the plane of the
    /// first. Where the outline of these has a notch, only as many as leave none.
    void group() {
        std::vector<double> area(triangles_.size());
        for (std::size_t i = 0; i < area.size(); ++i) {
            const auto [a, b, c] = triangles_[i].corners;
            area[i] = length(cross(points_[b] - points_[a], points_[c] - points_[a]));
        }
        Loop order(triangles_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::sort(order,
                          [&](auto a, auto b) { return area[a] > area[b] || (area[a] == area[b] && a < b); });
        for (const auto seed : order) {
            if (face_of_[seed] != none) continue;
            const FacePlane plane = newell(points_, triangles_[seed].corners);
            const Loop members = flood(seed, plane);
            Loop loop = outline(members);
            if (!is_convex(loop, plane.normal)) {
                for (const auto member : members) face_of_[member] = none;
                loop = grow(seed, plane);
            }
            loops_.push_back(std::move(loop));
        }
    }

    bool lies_in(const FacePlane& plane, std::uint32_t triangle) const {
        for (const auto i : triangles_[triangle].corners) {
            if (std::fabs(dot(plane.normal, points_[i]) - plane.offset) > tolerance_) return false;
        }
        return true;
    }

    /// All triangles in the plane that hang together with the seed.
    Loop flood(std::uint32_t seed, const FacePlane& plane) {
        const auto face = static_cast<std::uint32_t>(loops_.size());
        Loop members{seed};
        face_of_[seed] = face;
        for (std::size_t k = 0; k < members.size(); ++k) {
            for (const auto neighbour : triangles_[members[k]].neighbours) {
                if (face_of_[neighbour] != none || !lies_in(plane, neighbour)) continue;
                face_of_[neighbour] = face;
                members.push_back(neighbour);
            }
        }
        return members;
    }

    /// The loop around the triangles of one face; empty when that is not one simple loop.
    Loop outline(const Loop& members) const {
        const std::uint32_t face = face_of_[members[0]];
        const auto inside = [&](std::uint32_t triangle, int edge) {
            return face_of_[triangles_[triangle].neighbours[edge]] == face;
        };
        std::size_t boundary = 0;
        std::uint32_t triangle = none;
        int edge = 0;
        for (const auto member : members) {
            for (int i = 0; i < 3; ++i) {
                if (inside(member, i)) continue;
                ++boundary;
                triangle = member;
                edge = i;
            }
        }
        Loop loop;
        while (loop.size() < boundary) {
            loop.push_back(triangles_[triangle].corners[edge]);
            // On to the next edge of the boundary out of the corner at the end of this one.
            edge = (edge + 1) % 3;
            while (inside(triangle, edge)) {
                const auto pivot = triangles_[triangle].corners[edge];
                triangle = triangles_[triangle].neighbours[edge];
                edge = static_cast<int>(std::ranges::find(triangles_[triangle].corners, pivot) -
                                        triangles_[triangle].corners.begin());
            }
        }
        Loop sorted = loop;
        std::ranges::sort(sorted);
        return std::ranges::adjacent_find(sorted) == sorted.end() ? loop : Loop{};
    }

    /// Triangle by triangle, as long as the outline stays convex.
    Loop grow(std::uint32_t seed, const FacePlane& plane) {
        const auto face = static_cast<std::uint32_t>(loops_.size());
        Loop loop(triangles_[seed].corners.begin(), triangles_[seed].corners.end());
        Loop members{seed};
        face_of_[seed] = face;
        for (std::size_t k = 0; k < members.size(); ++k) {
            const HullTriangle& t = triangles_[members[k]];
            for (int i = 0; i < 3; ++i) {
                const auto neighbour = t.neighbours[i];
                if (face_of_[neighbour] != none || !lies_in(plane, neighbour)) continue;
                const auto [a, b, c] = triangles_[neighbour].corners;
                const auto tip = a + b + c - t.corners[i] - t.corners[(i + 1) % 3];
                if (std::ranges::find(loop, tip) != loop.end()) continue;
                Loop larger = loop;
                larger.insert(std::ranges::find(larger, t.corners[i]) + 1, tip);
                if (!is_convex(larger, plane.normal)) continue;
                loop = std::move(larger);
                face_of_[neighbour] = face;
                members.push_back(neighbour);
            }
        }
        return loop;
    }

    /// No corner of the loop lies further inwards than the tolerance from the line between its neighbours.
    bool is_convex(const Loop& loop, const Vec3& normal) const {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Vec3& a = points_[loop[i]];
            const Vec3& b = points_[loop[(i + 1) % loop.size()]];
            const Vec3& c = points_[loop[(i + 2) % loop.size()]];
            if (dot(cross(b - a, c - b), normal) < -tolerance_ * length(c - a)) return false;
        }
        return loop.size() >= 3;
    }

    /// Leaves out corners at which only two faces meet, and faces that have no three corners left.
    void straighten() {
        for (bool changed = true; changed;) {
            changed = false;
            std::vector<int> faces_at(points_.size(), 0);
            for (const auto& loop : loops_) {
                for (const auto i : loop) ++faces_at[i];
            }
            for (auto& loop : loops_) {
                changed = std::erase_if(loop, [&](auto i) { return faces_at[i] < 3; }) > 0 || changed;
                if (!loop.empty() && loop.size() < 3) {
                    loop.clear();
                    changed = true;
                }
            }
        }
    }

    Polyhedron compact() const {
        Polyhedron result;
        std::vector<std::uint32_t> number(points_.size(), none);
        for (const auto& loop : loops_) {
            for (const auto i : loop) number[i] = 0;
        }
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (number[i] == none) continue;
            number[i] = static_cast<std::uint32_t>(result.vertices.size());
            result.vertices.push_back(points_[i]);
        }
        result.first.push_back(0);
        for (const auto& loop : loops_) {
            if (loop.empty()) continue;
            const FacePlane plane = newell(points_, loop);
            result.normals.push_back(plane.normal);
            result.offsets.push_back(plane.offset);
            for (const auto i : loop) result.indices.push_back(number[i]);
            result.first.push_back(static_cast<std::uint32_t>(result.indices.size()));
        }
        return result;
    }

    /// Euler's formula holds, faces are flat and convex, and all points lie beneath all faces.
    bool is_convex(const Polyhedron& hull) const {
        const std::size_t faces = hull.normals.size();
        if (hull.vertices.size() + faces != hull.edges.size() + 2) return false;
        for (std::size_t f = 0; f < faces; ++f) {
            const Vec3& normal = hull.normals[f];
            const double offset = hull.offsets[f];
            if (normal == Vec3{}) return false;
            for (const Vec3& p : points_) {
                if (dot(normal, p) - offset > 2 * tolerance_) return false;
            }
            for (auto i = hull.first[f]; i < hull.first[f + 1]; ++i) {
                if (offset - dot(normal, hull.vertices[hull.indices[i]]) > 2 * tolerance_) return false;
            }
        }
        return true;
    }

    const std::vector<Vec3>& points_;
    const std::vector<HullTriangle>& triangles_;
    double tolerance_;
    Loop face_of_;             ///< for each triangle
    std::vector<Loop> loops_;  ///< the corners of each face
};

/// The smallest distance between a face and the corner that is furthest beneath it.
double thickness(const Polyhedron& hull) {
    double thinnest = 1e300;
    for (std::size_t f = 0; f < hull.normals.size(); ++f) {
        double depth = 0;
        for (const Vec3& v : hull.vertices)
            depth = std::max(depth, hull.offsets[f] - dot(hull.normals[f], v));
        thinnest = std::min(thinnest, depth);
    }
    return thinnest;
}

std::vector<LatticePoint> on_lattice(const std::vector<Vec3>& points, double extent) {
    Vec3 lowest = points[0];
    for (const Vec3& p : points) {
        for (int i = 0; i < 3; ++i) lowest[i] = std::min(lowest[i], p[i]);
    }
    const double scale = static_cast<double>(lattice_size) / extent;
    std::vector<LatticePoint> result;
    for (const Vec3& p : points) {
        LatticePoint q;
        for (int i = 0; i < 3; ++i)
            q[i] = static_cast<std::int64_t>(std::floor((p[i] - lowest[i]) * scale + 0.5));
        result.push_back(q);
    }
    return result;
}

}  // namespace

void measure(Polyhedron& polyhedron) {
    polyhedron.middle = {};
    for (const Vec3& vertex : polyhedron.vertices) polyhedron.middle += vertex;
    polyhedron.middle = polyhedron.middle / double(polyhedron.vertices.size());
    double square = 0;
    for (const Vec3& vertex : polyhedron.vertices)
        square = std::max(square, length_squared(vertex - polyhedron.middle));
    polyhedron.extent = std::sqrt(square);
    polyhedron.unevenness = 0;
    for (std::size_t f = 0; f < polyhedron.normals.size(); ++f) {
        for (const Vec3& vertex : polyhedron.vertices) {
            const double height = dot(polyhedron.normals[f], vertex) - polyhedron.offsets[f];
            polyhedron.unevenness = std::max(polyhedron.unevenness, height);
        }
    }
}

bool connect(Polyhedron& polyhedron) {
    struct Side {
        std::uint32_t low, high, from, face;
    };
    std::vector<Side> sides;
    for (std::uint32_t f = 0; f + 1 < polyhedron.first.size(); ++f) {
        const std::uint32_t begin = polyhedron.first[f], end = polyhedron.first[f + 1];
        for (std::uint32_t i = begin; i < end; ++i) {
            const std::uint32_t from = polyhedron.indices[i];
            const std::uint32_t to = polyhedron.indices[i + 1 < end ? i + 1 : begin];
            sides.push_back({std::min(from, to), std::max(from, to), from, f});
        }
    }
    // Each edge has two sides, which run against each other.
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::array{a.low, a.high, a.from} < std::array{b.low, b.high, b.from};
    });
    polyhedron.edges.clear();
    if (sides.size() % 2 != 0) return false;
    for (std::size_t i = 0; i < sides.size(); i += 2) {
        const Side &a = sides[i], &b = sides[i + 1];
        if (a.low != b.low || a.high != b.high || a.from != a.low || b.from != b.high) return false;
        if (i + 2 < sides.size() && sides[i + 2].low == a.low && sides[i + 2].high == a.high) return false;
        polyhedron.edges.push_back({a.low, a.high, a.face, b.face});
    }
    return true;
}

Polyhedron convex_polyhedron(const std::vector<Vec3>& points) {
    check_points<3>(points);
    const double extent = extent_of<3>(points);
    if (extent > 0) {
        const std::vector<LatticePoint> lattice = on_lattice(points, extent);
        // Points that lie askew by about the tolerance may leave no clean faces; a coarser tolerance does.
        for (const double tolerance : {hull_tolerance, 2 * hull_tolerance, 4 * hull_tolerance}) {
            const auto triangles = quickhull(lattice, tolerance * static_cast<double>(lattice_size));
            if (triangles.empty()) break;
            auto hull = Merger(points, triangles, 2 * tolerance * extent).merge();
            if (!hull) continue;
            if (thickness(*hull) < thinnest_hull * extent) break;
            return *std::move(hull);
        }
    }
    throw Error("points: " + std::to_string(points.size()) + " points span no volume");
}

}  // namespace carom::detail
