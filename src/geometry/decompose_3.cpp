#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "carom/decompose.hpp"
#include "geometry/hull.hpp"
#include "geometry/polytope_mass.hpp"
#include "geometry/terrain.hpp"

namespace carom {

namespace {

using namespace detail;

/// A triangle of a piece's surface. Those that close a cut are fans, which may fold over themselves: they
/// count for the volume, as their parts cancel, but their corners are not corners of the solid.
struct Triangle {
    std::array<Vec3, 3> corners;
    bool closes_cut = false;
};
using Surface = std::vector<Triangle>;

double volume(const Surface& surface) {
    if (surface.empty()) return 0;
    const Vec3 origin = surface[0].corners[0];
    double six = 0;
    for (const Triangle& t : surface)
        six += dot(t.corners[0] - origin, cross(t.corners[1] - origin, t.corners[2] - origin));
    return six / 6;
}

/// The part of the surface with p[axis] below (side −1) or above (side +1) the level, closed along the cut.
/// What lies in the plane itself counts as below.
Surface half(const Surface& surface, int axis, double level, double side) {
    Surface result;
    std::optional<Vec3> hub;
    for (const Triangle& t : surface) {
        std::array<double, 3> height;
        for (std::size_t i = 0; i < 3; ++i) height[i] = side * (t.corners[i][axis] - level);
        const auto inside = [&](std::size_t i) { return side < 0 ? height[i] >= 0 : height[i] > 0; };
        std::array<Vec3, 4> kept;
        std::array<Vec3, 2> cut;  // where the border leaves the half-space and where it comes back
        std::size_t count = 0;
        bool is_cut = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t next = (i + 1) % 3;
            const Vec3 &p = t.corners[i], &q = t.corners[next];
            if (inside(i)) kept[count++] = p;
            if (inside(i) == inside(next)) continue;
            // The same point from either side of the edge, so that halves and neighbours fit.
            const bool rising = p[axis] < q[axis];
            const Vec3 &low = rising ? p : q, &high = rising ? q : p;
            Vec3 crossing = low + (level - low[axis]) / (high[axis] - low[axis]) * (high - low);
            crossing[axis] = level;
            kept[count++] = crossing;
            cut[inside(i) ? 0 : 1] = crossing;
            is_cut = true;
        }
        // A triangle that does not go beyond the plane is no surface of this half, unless it is its top.
        const bool beyond = height[0] > 0 || height[1] > 0 || height[2] > 0;
        const bool is_top =
            !is_cut && side < 0 && cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0])[axis] > 0;
        for (std::size_t i = 1; i + 1 < count; ++i)
            result.push_back({{kept[0], kept[i], kept[i + 1]}, t.closes_cut || !(beyond || is_top)});
        if (!is_cut) continue;
        if (!hub) hub = cut[0];
        result.push_back({{*hub, cut[1], cut[0]}, true});
    }
    return result;
}

/// The points that lie furthest along the directions of a grid on a cube, so many that little is lost.
std::vector<Vec3> furthest_points(const std::vector<Vec3>& points) {
    constexpr int steps = 8;
    std::vector<Vec3> result;
    for (int face = 0; face < 6; ++face) {
        for (int i = 0; i < steps * steps; ++i) {
            Vec3 direction{};
            direction[face % 3] = face < 3 ? 1 : -1;
            direction[(face + 1) % 3] = (2 * (i % steps) + 1.0) / steps - 1;
            direction[(face + 2) % 3] = (2 * (i / steps) + 1.0) / steps - 1;
            result.push_back(*std::max_element(
                points.begin(), points.end(),
                [&](const Vec3& a, const Vec3& b) { return dot(a, direction) < dot(b, direction); }));
        }
    }
    return result;
}

/// Different corners of the solid within the surface.
std::vector<Vec3> corners_of(const Surface& surface) {
    std::vector<Vec3> points;
    for (const Triangle& t : surface)
        if (!t.closes_cut) points.insert(points.end(), t.corners.begin(), t.corners.end());
    const auto before = [](const Vec3& a, const Vec3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    const auto make_unique = [&] {
        std::sort(points.begin(), points.end(), before);
        points.erase(std::unique(points.begin(), points.end()), points.end());
    };
    make_unique();
    if (points.size() <= most_hull_points) return points;
    points = furthest_points(points);
    make_unique();
    return points;
}

/// A part of the solid and its hull.
struct Piece {
    Surface surface;
    std::vector<Vec3> corners;  ///< of the hull; empty where it is too thin to be one
    double hull_volume = 0;
    double excess = 0;  ///< empty room in the hull

    explicit Piece(Surface of) : surface(std::move(of)) {
        const std::vector<Vec3> points = corners_of(surface);
        if (points.size() < 4) return;
        try {
            const Polyhedron hull = convex_polyhedron(points);
            hull_volume = polytope_mass(hull, 0).mass;
            corners = hull.vertices;
        } catch (const Error&) {
            return;  // a sliver
        }
        excess = std::max(0.0, hull_volume - volume(surface));
    }
};

using Halves = std::array<Piece, 2>;

/// Area by which the surface is closed in the plane p[axis] = level.
double cut_area(const Surface& surface, int axis, double level) {
    double twice = 0;
    for (const Triangle& t : surface) {
        const auto& [p, q, r] = t.corners;
        if (t.closes_cut && p[axis] == level && q[axis] == level && r[axis] == level)
            twice += cross(q - p, r - p)[axis];
    }
    return 0.5 * std::fabs(twice);
}

/// The two parts of the piece that have the least empty room in their hulls together. Where several cuts are
/// about as good, and where none helps at first, as with a ring, even parts and small cuts are preferred.
std::optional<Halves> best_cut(const Piece& piece, int planes) {
    Aabb<3> box{piece.corners[0], piece.corners[0]};
    for (const Vec3& p : piece.corners) {
        for (int i = 0; i < 3; ++i) {
            box.lower[i] = std::min(box.lower[i], p[i]);
            box.upper[i] = std::max(box.upper[i], p[i]);
        }
    }
    std::optional<Halves> best;
    constexpr double preference = 0.05;
    const Vec3 size = box.upper - box.lower;
    const double mean_size = (size.x + size.y + size.z) / 3;
    double least = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 1; k <= planes; ++k) {
            const double level = box.lower[axis] + k * (box.upper[axis] - box.lower[axis]) / (planes + 1);
            Halves halves{Piece(half(piece.surface, axis, level, -1)),
                          Piece(half(piece.surface, axis, level, 1))};
            if (halves[0].corners.empty() || halves[1].corners.empty()) continue;
            const double cost =
                halves[0].excess + halves[1].excess +
                preference * (std::fabs(halves[0].hull_volume - halves[1].hull_volume) +
                              mean_size * cut_area(halves[0].surface, axis, level));
            if (cost >= least) continue;
            least = cost;
            best = std::move(halves);
        }
    }
    return best;
}

/// A surface is closed when each edge is passed as often in one sense as in the other.
void check_closed(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> passes;
    for (const auto& corners : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = corners[i], to = corners[(i + 1) % 3];
            passes[std::minmax(from, to)] += from < to ? 1 : -1;
        }
    }
    for (const auto& [edge, sum] : passes) {
        if (sum != 0)
            throw Error("triangles: the surface is not closed at the edge between the vertices " +
                        std::to_string(edge.first) + " and " + std::to_string(edge.second));
    }
}

void require_count(int value, int most, std::string_view field) {
    if (value < 1 || value > most) refuse(field, value, "is not between 1 and " + std::to_string(most));
}

}  // namespace

std::vector<Hull3> convex_pieces(const Mesh& mesh, const Decomposition& settings) {
    require_in(settings.concavity, 0, 1, "concavity");
    require_count(settings.most_pieces, 1024, "most_pieces");
    require_count(settings.planes, 256, "planes");
    const Terrain<3> checked(mesh, {});
    check_closed(mesh);
    Surface surface;
    for (const auto& corners : mesh.triangles)
        surface.push_back(
            {{mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]}});
    std::vector<Piece> pieces{Piece(std::move(surface))};
    if (pieces[0].corners.empty()) throw Error("triangles: they span no volume");
    if (volume(pieces[0].surface) <= 0)
        throw Error("triangles: they hold no volume; corners must run counter-clockwise seen from outside");

    const double allowed = settings.concavity * pieces[0].hull_volume;
    std::vector<Piece> done;
    while (!pieces.empty()) {
        const auto worst = std::max_element(
            pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.excess < b.excess; });
        const bool enough = pieces.size() + done.size() >= std::size_t(settings.most_pieces);
        std::optional<Halves> halves;
        if (worst->excess > allowed && !enough) halves = best_cut(*worst, settings.planes);
        if (halves) {
            *worst = std::move((*halves)[0]);
            pieces.push_back(std::move((*halves)[1]));
        } else {
            done.push_back(std::move(*worst));
            pieces.erase(worst);
        }
    }
    std::vector<Hull3> hulls;
    for (Piece& piece : done) hulls.push_back({std::move(piece.corners), 0});
    return hulls;
}

}  // namespace carom
