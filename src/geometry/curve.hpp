#pragma once

#include <cstddef>
#include <vector>

#include "math/dim.hpp"

namespace carom::detail {

/// A place on a curve.
template <int D>
struct CurvePlace {
    Vec<D> point{};
    Vec<D> tangent{};  ///< unit
    Vec<D> bend{};     ///< curvature times the unit vector towards its centre, 1/m; across the tangent
    double way = 0;    ///< length of the curve up to here
};

/// A curve through points: straight pieces, or a Catmull–Rom spline, which goes through each point in the
/// direction of the line from the one before to the one after it. Places are numbers: whole ones are the
/// points.
template <int D>
class Curve {
  public:
    /// At least two points, of which no two neighbours are the same.
    Curve(std::vector<Vec<D>> points, bool loop, bool smooth);

    double last_place() const { return static_cast<double>(pieces_); }
    double length() const { return ways_.back(); }
    bool loop() const { return loop_; }
    CurvePlace<D> at(double place) const;
    /// The place nearest to a point, of those up to a piece away from `near`.
    double nearest(const Vec<D>& point, double near) const;
    /// Of all places.
    double nearest(const Vec<D>& point) const;

  private:
    struct Derivatives {
        Vec<D> point, first, second;
    };
    Derivatives look(double place) const;
    const Vec<D>& point(std::ptrdiff_t index) const;
    double into_range(double place) const;
    double way_within(double from, double to) const;
    double nearest_on_lines(const Vec<D>& point, double near) const;
    double refined(const Vec<D>& point, double place) const;

    static constexpr int parts = 8;  ///< of a piece, in the table of ways

    std::vector<Vec<D>> points_;
    bool loop_, smooth_;
    std::size_t pieces_;
    std::vector<double> ways_;  ///< up to each part of a piece
};

}  // namespace carom::detail
