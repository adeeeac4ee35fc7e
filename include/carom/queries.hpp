#pragma once

#include <cstdint>
#include <functional>

#include "carom/collide.hpp"
#include "carom/ids.hpp"

namespace carom {

/// Which shapes of a world a query sees. A shape is seen when its category is in the query's mask and the
/// query's category is in the shape's mask; groups do not matter. Bodies in quarantine are not seen.
template <int D>
struct QueryFilter {
    std::uint64_t category = ~std::uint64_t{0};
    std::uint64_t mask = ~std::uint64_t{0};
    bool sensors = false;  ///< are sensors seen?
    BodyId<D> ignored{};   ///< a body that is not seen, or none: for a query that starts in it
    /// When given, only shapes for which it says true are seen. Batches may call it from several threads.
    std::function<bool(ShapeId<D>)> accepts{};
};

/// A ray from `origin` to `origin` + `translation`, m; without length it is a point.
template <int D>
struct Ray {
    Vec<D> origin{};
    Vec<D> translation{};
};

/// Where a ray or a moving shape meets a shape of the world.
template <int D>
struct WorldHit {
    ShapeId<D> shape{};
    BodyId<D> body{};
    double fraction = 0;  ///< of the way, 0 … 1; 0 when they touch from the start
    Vec<D> point{};       ///< where they touch, m
    Vec<D> normal{};      ///< unit vector out of the shape that is hit
};

/// The point of a world's shapes that is nearest to a given one.
template <int D>
struct NearestPoint {
    ShapeId<D> shape{};
    BodyId<D> body{};
    Vec<D> point{};       ///< m; the given point itself where the shape holds it
    double distance = 0;  ///< m; zero where the shape holds the given point
};

using QueryFilter2 = QueryFilter<2>;
using QueryFilter3 = QueryFilter<3>;
using Ray2 = Ray<2>;
using Ray3 = Ray<3>;

}  // namespace carom
