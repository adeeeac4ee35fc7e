#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "carom/inertia.hpp"
#include "carom/shapes.hpp"

namespace carom {

namespace detail {
template <int D>
struct Shape;
}

/// A shape made ready for collision queries: checked, and a hull's faces found. Copies are cheap and share
/// the result; several threads may use one at the same time.
template <int D>
class Solid {
  public:
    /// Throws `Error` for a shape that cannot exist.
    Solid(const ShapeDefinition<D>& definition);
    /// The shape at the origin of its body's frame.
    Solid(const Geometry<D>& geometry);

    const detail::Shape<D>& shape() const { return *shape_; }

  private:
    std::shared_ptr<const detail::Shape<D>> shape_;
};

using Solid2 = Solid<2>;
using Solid3 = Solid<3>;

/// The direction in which two shapes are nearest to being apart.
template <int D>
struct Separation {
    Vec<D> axis{};        ///< unit vector from the first shape towards the second
    double distance = 0;  ///< gap between the surfaces along the axis, m; negative: depth of penetration
};

/// One point where two shapes touch or nearly touch.
template <int D>
struct ManifoldPoint {
    Vec<D> position{};          ///< midway between the two surfaces, in the outer frame, m
    double separation = 0;      ///< gap along the normal, m; negative where they overlap
    std::uint32_t feature = 0;  ///< which features meet here; equal from step to step while they are the same
};

/// Whose face gives a manifold its normal, which then turns with that shape.
enum class NormalOf : std::uint8_t { neither, first, second };

/// Where and along which direction two shapes touch.
template <int D>
struct Manifold {
    static constexpr int capacity = D == 2 ? 2 : 4;

    Vec<D> normal{};  ///< unit vector from the first shape towards the second
    std::array<ManifoldPoint<D>, capacity> points{};
    int count = 0;  ///< number of points, 0 … `capacity`
    NormalOf normal_of = NormalOf::neither;
};

/// The points of two shapes that are nearest to each other.
template <int D>
struct ClosestPoints {
    Vec<D> on_a{}, on_b{};  ///< in the outer frame, m; one and the same point where the shapes overlap
    Vec<D> axis{};          ///< unit vector from `on_a` to `on_b`; zero where the shapes overlap
    double distance = 0;    ///< between them, m; zero where the shapes overlap
};

/// Where something that moves first touches a shape.
template <int D>
struct CastHit {
    double fraction = 0;  ///< of the way, 0 … 1; 0 when they touch from the start
    Vec<D> point{};       ///< where they touch, in the outer frame, m
    Vec<D> normal{};      ///< unit vector out of the shape that is hit
};

/// The motion of a shape through a stretch of time: its `center` moves in a straight line while it turns
/// about it at a steady rate.
template <int D>
struct Sweep {
    Transform<D> start{};   ///< placement of the shape's body when the motion begins
    Vec<D> translation{};   ///< way of the centre, m
    Angular<D> rotation{};  ///< angle (2D) or rotation vector (3D), rad; at most 10 000
    Vec<D> center{};        ///< the point of the body that moves in a straight line, in the body's frame, m

    /// Where the body is at a fraction, 0 … 1, of the motion.
    Transform<D> at(double fraction) const;
};

using Sweep2 = Sweep<2>;
using Sweep3 = Sweep<3>;

// Positions that a shape is asked about lie within ±1e100 m. All shapes are closed and solid: to touch is to
// overlap, and a way that begins inside ends there.
// A chain, mesh or height field has no inside: what counts is its segments or triangles, each from its front
// alone unless it is two-sided. The answer is that of the one which is nearest or is overlapped most.

/// Do the two placed shapes overlap (touching counts)?
template <int D>
bool overlap(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
             const Transform<D>& b_placed);

/// Axis of collision and depth, or the gap when the shapes are apart. Nothing for two planes, for a plane or
/// ground against ground, and for a shape behind ground.
template <int D>
std::optional<Separation<D>> separation(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
                                        const Transform<D>& b_placed);

/// The contact manifold of two placed shapes. It is empty when they are further apart than `reach` (m, not
/// negative).
template <int D>
Manifold<D> collide(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
                    const Transform<D>& b_placed, double reach = 0);

/// The closest points of two shapes, by the algorithm of Gilbert, Johnson and Keerthi (1988). How deep shapes
/// overlap is told by `separation`.
template <int D>
ClosestPoints<D> closest_points(const Solid<D>& a, const Transform<D>& a_placed, const Solid<D>& b,
                                const Transform<D>& b_placed);

/// Is the point (of the outer frame) in the shape or on its surface?
template <int D>
bool contains(const Solid<D>& solid, const Transform<D>& placed, const Vec<D>& point);

/// Where the ray from `origin` to `origin` + `translation` enters the shape; in closed form. A ray that
/// begins in the shape hits it at once, with the normal against its direction. A ray of no length is a point.
template <int D>
std::optional<CastHit<D>> cast_ray(const Solid<D>& solid, const Transform<D>& placed, const Vec<D>& origin,
                                   const Vec<D>& translation);

/// Where `moving` first touches `target` on its straight way along `translation`, without turning. The hit
/// is one of the target. Shapes that overlap from the start hit at once, with the normal of their
/// `separation`. The gap at the hit is less than 1e-9 of the shapes' sizes. Method: conservative advancement
/// (Mirtich 1996), which for a translation is Newton's method on a convex function and passes no hit.
template <int D>
std::optional<CastHit<D>> cast_shape(const Solid<D>& moving, const Transform<D>& moving_placed,
                                     const Vec<D>& translation, const Solid<D>& target,
                                     const Transform<D>& target_placed);

/// When two moving shapes first come within `tolerance` (m, at least 1e-9 of the sizes) of each
/// other. It misses nothing, however fast they turn: at every fraction before the answer, and at every
/// fraction at all when there is none, they are apart. The hit is one of `b`. Method: conservative
/// advancement along the separating axis, with a bound on the curvature of the gap over time. The time that
/// it takes grows with the angles and falls with the tolerance. A plane may move but not turn.
template <int D>
std::optional<CastHit<D>> time_of_impact(const Solid<D>& a, const Sweep<D>& a_sweep, const Solid<D>& b,
                                         const Sweep<D>& b_sweep, double tolerance = 1e-5);

}  // namespace carom
