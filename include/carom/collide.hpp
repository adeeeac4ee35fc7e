#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

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

/// Where and along which direction two shapes touch.
template <int D>
struct Manifold {
    static constexpr int capacity = D == 2 ? 2 : 4;

    Vec<D> normal{};  ///< unit vector from the first shape towards the second
    std::array<ManifoldPoint<D>, capacity> points{};
    int count = 0;  ///< number of points, 0 … `capacity`
};

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

}  // namespace carom
