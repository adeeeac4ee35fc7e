#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

#include "collision/tree.hpp"
#include "dynamics/body.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

/// A shape that lives in the world.
template <int D>
struct ShapeRecord {
    Shape<D> shape;
    std::shared_ptr<const ShapeDefinition<D>> definition;  ///< shapes that are alike share one
    std::uint32_t body = 0;
    Vec<D> core{};  ///< of a convex shape: the middle of a ball half as large as fits into it
    double core_radius = 0;
    std::int32_t leaf = Tree<D>::none;  ///< in the tree that its body says
};

/// What bodies are made of, for forces that ask for it.
template <int D>
struct Solids {
    std::span<const BodyInfo<D>> bodies;
    std::span<const ShapeRecord<D>> shapes;

    /// Visits the shapes of a body that have a mass: all but sensors, unless it has no others.
    template <class Visit>
    void each(std::uint32_t body, const Visit& visit) const {
        const std::vector<ShapeId<D>>& ids = bodies[body].shapes;
        const auto is_sensor = [&](const ShapeId<D>& id) { return shapes[id.index].definition->sensor; };
        const bool only_sensors = std::all_of(ids.begin(), ids.end(), is_sensor);
        for (const ShapeId<D>& id : ids) {
            if (only_sensors || !is_sensor(id)) visit(shapes[id.index].shape);
        }
    }
};

}  // namespace carom::detail
