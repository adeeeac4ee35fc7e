#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/quadrature.hpp"
#include "geometry/submerged.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

/// Slices across the axis of a solid of revolution: disks, of which the half-space leaves a segment.
class Slices {
  public:
    Slices(const Vec3& center, const Vec3& axis, const Vec3& up, double surface)
        : center_(center), axis_(axis), height_(surface - dot(up, center)), rise_(dot(up, axis)) {
        const Vec3 across = up - rise_ * axis;
        slope_ = length(across);
        across_ = slope_ > 0 ? across / slope_ : Vec3{};
    }

    /// The part from t0 to t1 along the axis with the radius a + b t.
    void add_frustum(double t0, double t1, double a, double b) {
        // The surface passes the rim where height − rise t = ±slope (a + b t).
        std::array<double, 2> cuts{};
        int count = 0;
        for (const double side : {-slope_, slope_}) {
            const double divisor = rise_ + side * b;
            if (divisor != 0) cuts[static_cast<std::size_t>(count++)] = (height_ - side * a) / divisor;
        }
        add(t0, t1, cuts, count, [=](double t) { return a + b * t; });
    }

    /// The part from t0 to t1 of a ball around the point h of the axis.
    void add_ball(double t0, double t1, double h, double radius) {
        // (height − rise t)² = slope² (radius² − (t − h)²), where rise² + slope² = 1.
        const double half = height_ * rise_ + slope_ * slope_ * h;
        const double rest = height_ * height_ + slope_ * slope_ * (h * h - radius * radius);
        const double root = half * half - rest;
        std::array<double, 2> cuts{};
        if (root > 0) cuts = {half - std::sqrt(root), half + std::sqrt(root)};
        add(t0, t1, cuts, root > 0 ? 2 : 0,
            [=](double t) { return std::sqrt(std::max(0.0, radius * radius - (t - h) * (t - h))); });
    }

    Submerged<3> result() const {
        if (!(volume_ > 0)) return {};
        return {volume_, center_ + (along_ / volume_) * axis_ + (sideways_ / volume_) * across_};
    }

  private:
    template <class Radius>
    void add(double t0, double t1, std::array<double, 2> cuts, int count, const Radius& radius) {
        std::array<double, 4> ends{t0, t1, t1, t1};
        if (count == 2 && cuts[0] > cuts[1]) std::swap(cuts[0], cuts[1]);
        for (int i = 0; i < count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            ends[k + 1] = std::clamp(cuts[k], t0, t1);
        }
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            if (ends[i] < ends[i + 1]) add_piece(ends[i], ends[i + 1], radius);
        }
    }

    /// At its ends a segment begins with the power 3/2 of the way, which t = middle + half sin u makes
    /// analytic.
    template <class Radius>
    void add_piece(double from, double to, const Radius& radius) {
        const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
        each_node(-0.5 * pi, 0.5 * pi, [&](double u, double weight) {
            const auto [sine, cosine] = sin_cos(u);
            const double t = middle + half * sine, r = radius(t), w = weight * half * cosine;
            const double above = height_ - rise_ * t, edge = slope_ * r;
            // The part of the unit disk where x ≤ q: its area, and ∫ x.
            const double q = above >= edge ? 1 : above <= -edge ? -1 : above / edge;
            const double root = std::sqrt(1 - q * q);
            const double area = w * r * r * (q * root + asin(q) + 0.5 * pi);
            volume_ += area;
            along_ += t * area;
            sideways_ -= w * r * r * r * root * root * root * 2 / 3;
        });
    }

    Vec3 center_, axis_, across_{};
    double height_, rise_,
        slope_ = 0;  ///< of the surface over the centre; of up along the axis and across it
    double volume_ = 0, along_ = 0, sideways_ = 0;
};

}  // namespace

Submerged<3> submerged_revolved(const Shape<3>& shape, const Vec3& up, double surface) {
    const double r = shape.radius;
    if (shape.kind == ShapeKind::capsule) {
        const double half = 0.5 * length(shape.b - shape.a);
        const Vec3 axis = half > 0 ? (shape.b - shape.a) / (2 * half) : up;
        Slices slices(0.5 * (shape.a + shape.b), axis, up, surface);
        slices.add_ball(-half - r, -half, -half, r);
        slices.add_frustum(-half, half, r, 0);
        slices.add_ball(half, half + r, half, r);
        return slices.result();
    }
    const double h = shape.half_height;
    Slices slices(shape.a, shape.b, up, surface);
    if (shape.kind == ShapeKind::cylinder)
        slices.add_frustum(-h, h, r, 0);
    else
        slices.add_frustum(-h, h, 0.5 * r, -0.5 * r / h);
    return slices.result();
}

}  // namespace carom::detail
