#include <algorithm>
#include <cmath>

#include "geometry/submerged.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

/// Integrals over the part of an area below the line y = 0, by what runs along its border, counter-clockwise:
/// ∫ 1 = −∮ y dx, ∫ x = −∮ x y dx, ∫ y = −½ ∮ y² dx. On the line itself all of them vanish, so the border of
/// the whole shape, cut off at the line, is all that is needed.
struct Below {
    double area = 0;
    Vec2 first{};

    void add_segment(Vec2 a, Vec2 b) {
        if (a.y >= 0 && b.y >= 0) return;
        const Vec2 cut = a + (b - a) * (a.y / (a.y - b.y));
        if (a.y > 0) a = {cut.x, 0};
        if (b.y > 0) b = {cut.x, 0};
        const Vec2 d = b - a;
        area -= 0.5 * d.x * (a.y + b.y);
        first.x -= d.x * (a.x * a.y + 0.5 * (a.x * d.y + a.y * d.x) + d.x * d.y / 3);
        first.y -= d.x * (a.y * a.y + a.y * b.y + b.y * b.y) / 6;
    }

    /// The arc around c from the angle `from` to the angle `to`, no more than a full turn on.
    void add_arc(const Vec2& c, double radius, double from, double to) {
        const double height = -c.y / radius;  // below is where the sine is less
        if (height <= -1) return;
        if (height >= 1) return add_whole_arc(c, radius, from, to);
        const double limit = asin(height);
        for (int turn = -2; turn <= 1; ++turn) {
            const double begin = std::max(from, pi - limit + 2 * pi * turn);
            const double end = std::min(to, 2 * pi + limit + 2 * pi * turn);
            if (begin < end) add_whole_arc(c, radius, begin, end);
        }
    }

  private:
    void add_whole_arc(const Vec2& c, double r, double from, double to) {
        const auto [s0, c0] = sin_cos(from);
        const auto [s1, c1] = sin_cos(to);
        // ∫ sin, ∫ sin², ∫ sin³, ∫ cos sin and ∫ cos sin² over the angle.
        const double sin1 = c0 - c1, sin2 = 0.5 * (to - from - (s1 * c1 - s0 * c0));
        const double sin3 = sin1 - (c0 * c0 * c0 - c1 * c1 * c1) / 3;
        const double cos_sin = 0.5 * (s1 * s1 - s0 * s0), cos_sin2 = (s1 * s1 * s1 - s0 * s0 * s0) / 3;
        area += r * (c.y * sin1 + r * sin2);
        first.x += r * (c.x * c.y * sin1 + c.x * r * sin2 + c.y * r * cos_sin + r * r * cos_sin2);
        first.y += 0.5 * r * (c.y * c.y * sin1 + 2 * c.y * r * sin2 + r * r * sin3);
    }
};

/// A convex outline as seen over the water: x along the surface, y out of it.
class Outline {
  public:
    Outline(const Vec2& up, double surface, const Vec2& middle)
        : up_(up), along_{up.y, -up.x}, middle_(middle), depth_(dot(up, middle) - surface) {}

    /// One side from corner a to b, grown by the radius, and the arc from it to the side with `next_normal`.
    void add(const Vec2& a, const Vec2& b, const Vec2& normal, const Vec2& next_normal, double radius) {
        below_.add_segment(seen(a + radius * normal), seen(b + radius * normal));
        if (radius == 0) return;
        const double from = angle(normal);
        double turn = atan2(cross(normal, next_normal), dot(normal, next_normal));
        if (turn < 0) turn += 2 * pi;  // half a turn, rounded
        below_.add_arc(seen(b), radius, from, from + turn);
    }
    void add_disk(const Vec2& center, double radius) { below_.add_arc(seen(center), radius, 0, 2 * pi); }

    Submerged<2> result() const {
        if (!(below_.area > 0)) return {};
        const Vec2 c = below_.first / below_.area;
        return {below_.area, middle_ + c.x * along_ + (c.y - depth_) * up_};
    }

  private:
    Vec2 seen(const Vec2& p) const { return {dot(along_, p - middle_), dot(up_, p - middle_) + depth_}; }
    double angle(const Vec2& v) const { return atan2(dot(up_, v), dot(along_, v)); }

    Vec2 up_, along_, middle_;
    double depth_;
    Below below_;
};

}  // namespace

template <>
Submerged<2> submerged(const Shape<2>& shape, const Vec2& up, double surface) {
    if (shape.kind == ShapeKind::plane || shape.kind == ShapeKind::terrain) return {};
    Outline outline(up, surface, middle_of(shape));
    if (shape.kind == ShapeKind::ball || (shape.kind == ShapeKind::capsule && shape.a == shape.b)) {
        outline.add_disk(shape.a, shape.radius);
    } else if (shape.kind == ShapeKind::capsule) {
        const Vec2 along = normalized(shape.b - shape.a), right{along.y, -along.x};
        outline.add(shape.a, shape.b, right, -right, shape.radius);
        outline.add(shape.b, shape.a, -right, right, shape.radius);
    } else {
        const Polygon& core = *shape.core;
        const std::size_t count = core.vertices.size();
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t next = (i + 1) % count;
            outline.add(core.vertices[i], core.vertices[next], core.normals[i], core.normals[next],
                        shape.radius);
        }
    }
    return outline.result();
}

}  // namespace carom::detail
