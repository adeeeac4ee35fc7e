#include "collision/gjk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom::detail {

namespace {

/// Cores closer than this, as a share of the difference's extent, count as touching: rounding leaves no
/// direction to be told from a shorter vector.
constexpr double touching = 1e-13;
/// A simplex of less than this share of its extent's area or volume is flat, and its inside is not asked for.
constexpr double flat = 1e-14;

/// Some of the vertices that the search has, and the point of what they span that is closest to the origin.
template <int D>
struct Simplex {
    std::array<SimplexVertex<D>, D + 1> vertices{};
    std::array<double, D + 1> weights{};  ///< of the closest point
    int count = 0;
    Vec<D> closest{};
};

/// A part of a simplex by the numbers of its vertices.
template <int D>
struct Part {
    const std::array<SimplexVertex<D>, D + 1>* vertices;
    std::array<int, D + 1> numbers;
    std::array<double, D + 1> weights;
    int count = 0;
    Vec<D> closest;

    explicit Part(const Simplex<D>& whole) : vertices(&whole.vertices) {}
    void add(int number) { numbers[count++] = number; }
    const Vec<D>& operator[](int i) const { return (*vertices)[numbers[i]].difference; }
};

double determinant(const Vec3& a, const Vec3& b, const Vec3& c) { return dot(a, cross(b, c)); }

/// Scales the weights to a sum of one. False when not all of them have the sign of their sum: then the point
/// that they stand for is outside.
template <int D>
bool normalize_weights(Part<D>& s, double least_sum) {
    double sum = 0;
    for (int i = 0; i < s.count; ++i) sum += s.weights[i];
    if (!(std::fabs(sum) > least_sum)) return false;
    for (int i = 0; i < s.count; ++i) {
        s.weights[i] /= sum;
        if (!(s.weights[i] >= 0)) return false;
    }
    return true;
}

template <int D>
bool solve_edge(Part<D>& s) {
    const Vec<D> edge = s[1] - s[0];
    s.weights[0] = dot(s[1], edge);
    s.weights[1] = -dot(s[0], edge);
    if (!normalize_weights(s, 0)) return false;
    s.closest = s.weights[0] * s[0] + s.weights[1] * s[1];
    // What rounding left along the edge would be a large part of a small distance.
    s.closest -= dot(s.closest, edge) / length_squared(edge) * edge;
    return true;
}

/// In a plane through a corner of a triangle, two of whose edges are e and f, the point nearest to the origin
/// is corner + s·e + t·f. The corner is the one opposite the longest edge: there e and f are furthest from
/// parallel, and n = e × f and all that depends on it are as exact as they can be for a needle.
bool solve_triangle(Part<3>& simplex) {
    int corner = 0;
    double longest = -1;
    for (int i = 0; i < 3; ++i) {
        const double opposite = length_squared(simplex[(i + 1) % 3] - simplex[(i + 2) % 3]);
        if (opposite > longest) {
            longest = opposite;
            corner = i;
        }
    }
    const Vec3& p = simplex[corner];
    const Vec3 e = simplex[(corner + 1) % 3] - p, f = simplex[(corner + 2) % 3] - p, n = cross(e, f);
    const double square = length_squared(n);
    if (!(square > 0)) return false;
    const double s = dot(n, cross(f, p)) / square, t = dot(n, cross(p, e)) / square;
    if (!(s >= 0 && t >= 0 && s + t <= 1)) return false;
    simplex.weights[corner] = 1 - s - t;
    simplex.weights[(corner + 1) % 3] = s;
    simplex.weights[(corner + 2) % 3] = t;
    simplex.closest = dot(n, p) / square * n;
    return true;
}

/// Is the origin within a simplex of as many corners as it can have? Its weights are the areas or volumes
/// that it spans with the other corners.
bool solve_full(Part<2>& s, double extent) {
    s.weights = {cross(s[1], s[2]), cross(s[2], s[0]), cross(s[0], s[1])};
    return normalize_weights(s, flat * extent * extent);
}
bool solve_full(Part<3>& s, double extent) {
    s.weights = {determinant(s[1], s[2], s[3]), -determinant(s[0], s[2], s[3]), determinant(s[0], s[1], s[3]),
                 -determinant(s[0], s[1], s[2])};
    return normalize_weights(s, flat * extent * extent * extent);
}

/// Finds the point nearest to the origin in the flat that the vertices span, and tells if it lies within the
/// simplex.
template <int D>
bool solve_whole(Part<D>& s) {
    if (s.count == 1) {
        s.weights[0] = 1;
        s.closest = s[0];
        return true;
    }
    if (s.count == 2) return solve_edge(s);
    if constexpr (D == 3)
        if (s.count == 3) return solve_triangle(s);
    double square = 0;
    for (int i = 0; i < s.count; ++i) square = std::max(square, length_squared(s[i]));
    s.closest = {};
    return solve_full(s, std::sqrt(square));
}

/// Leaves of a simplex the smallest part that holds its point closest to the origin. Only parts with the
/// newest vertex come into question, as the closest point of the rest is known and further away.
template <int D>
void reduce(Simplex<D>& whole) {
    Part<D> best(whole);
    double best_square = 0;
    const int newest = whole.count - 1;
    for (int choice = 0; choice < 1 << newest; ++choice) {
        Part<D> part(whole);
        for (int i = 0; i < newest; ++i)
            if (choice >> i & 1) part.add(i);
        part.add(newest);
        if (!solve_whole(part)) continue;
        const double square = part.count > D ? 0 : length_squared(part.closest);
        if (best.count == 0 || square < best_square) {
            best = part;
            best_square = square;
        }
    }
    whole.count = best.count;
    whole.closest = best.closest;
    for (int i = 0; i < best.count; ++i) {  // in the order that they have, so none is lost
        whole.vertices[i] = whole.vertices[best.numbers[i]];
        whole.weights[i] = best.weights[i];
    }
}

/// Of a simplex that holds the origin, itself or the face whose weights come nearest to it: those of a
/// simplex that is all but flat are mostly rounding.
template <int D>
void make_weights_sure(Simplex<D>& whole) {
    const auto miss = [&](int count, const auto& vertex, const auto& weights) {
        Vec<D> sum{};
        for (int i = 0; i < count; ++i) sum += weights[i] * vertex(i);
        return length_squared(sum);
    };
    Part<D> best(whole);
    double least = miss(
        whole.count, [&](int i) { return whole.vertices[i].difference; }, whole.weights);
    for (int left_out = 0; left_out < whole.count; ++left_out) {
        Part<D> face(whole);
        for (int i = 0; i < whole.count; ++i)
            if (i != left_out) face.add(i);
        if (!solve_whole(face)) continue;
        const double candidate = miss(
            face.count, [&](int i) { return face[i]; }, face.weights);
        if (!(candidate < least)) continue;
        least = candidate;
        best = face;
    }
    if (best.count == 0) return;
    whole.weights.fill(0);
    for (int i = 0; i < best.count; ++i) whole.weights[best.numbers[i]] = best.weights[i];
}

}  // namespace

template <int D>
SimplexVertex<D> difference_support(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a,
                                    const Vec<D>& direction) {
    const Vec<D> on_a = core_support(a, direction);
    const Vec<D> on_b = apply(b_in_a, core_support(b, unrotate(b_in_a.rotation, -direction)));
    return {on_a, on_b, on_a - on_b};
}

template <int D>
CoreDistance<D> core_distance(const Shape<D>& a, const Shape<D>& b, const Transform<D>& b_in_a) {
    constexpr int most_steps = 100;
    constexpr double precision = 1e-15;
    Vec<D> start = b_in_a.position;
    if (!(length_squared(start) > 0)) start.x = 1;

    Simplex<D> simplex;
    const auto begin_at = [&](const SimplexVertex<D>& vertex) {
        simplex.vertices[0] = vertex;
        simplex.count = 1;
        reduce(simplex);
    };
    begin_at(difference_support(a, b, b_in_a, start));
    double extent = length(simplex.closest);
    double distance = extent;
    Simplex<D> nearest;
    double nearest_distance = std::numeric_limits<double>::infinity();
    int restarts = 3;
    for (int step = 0; step < most_steps && simplex.count <= D && distance > touching * extent; ++step) {
        const Vec<D> axis = simplex.closest / -distance;
        const SimplexVertex<D> next = difference_support(a, b, b_in_a, axis);
        extent = std::max(extent, length(next.difference));
        // The cores are at least −axis · next apart.
        if (dot(axis, next.difference - simplex.closest) <= precision * extent) break;
        Simplex<D> larger = simplex;
        larger.vertices[larger.count++] = next;
        reduce(larger);
        const double nearer = larger.count > D ? 0 : length(larger.closest);
        if (!(nearer < distance)) {
            // Rounding holds it up, mostly at needles of points on a rim. From the newest point alone it may
            // find another way; the nearest of all is kept.
            if (distance < nearest_distance) {
                nearest = simplex;
                nearest_distance = distance;
            }
            if (restarts-- == 0) break;
            begin_at(next);
            distance = length(simplex.closest);
            continue;
        }
        simplex = larger;
        distance = nearer;
    }

    if (simplex.count <= D && nearest_distance < distance) {
        simplex = nearest;
        distance = nearest_distance;
    }
    CoreDistance<D> result;
    result.overlap = simplex.count > D || distance <= touching * extent;
    if (simplex.count > D) make_weights_sure(simplex);
    for (int i = 0; i < simplex.count; ++i) {
        result.on_a += simplex.weights[i] * simplex.vertices[i].on_a;
        result.on_b += simplex.weights[i] * simplex.vertices[i].on_b;
    }
    if (!result.overlap) {
        result.distance = distance;
        result.axis = simplex.closest / -distance;
    }
    result.simplex = simplex.vertices;
    result.count = simplex.count;
    return result;
}

template SimplexVertex<2> difference_support(const Shape<2>&, const Shape<2>&, const Transform<2>&,
                                             const Vec<2>&);
template SimplexVertex<3> difference_support(const Shape<3>&, const Shape<3>&, const Transform<3>&,
                                             const Vec<3>&);
template CoreDistance<2> core_distance(const Shape<2>&, const Shape<2>&, const Transform<2>&);
template CoreDistance<3> core_distance(const Shape<3>&, const Shape<3>&, const Transform<3>&);

}  // namespace carom::detail
