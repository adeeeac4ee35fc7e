#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

#include "collision/tree.hpp"
#include "dynamics/body.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

/// What shapes that are alike share.
template <int D>
struct ShapeModel {
    Shape<D> shape;
    ShapeDefinition<D> definition;
    Vec<D> core{};  ///< of a convex shape: the middle of a ball half as large as fits into it
    double core_radius = 0;
};

/// A shape that lives in the world.
template <int D>
struct ShapeRecord {
    std::shared_ptr<const ShapeModel<D>> model;
    std::uint32_t body = 0;
    std::int32_t leaf = Tree<D>::none;  ///< in the tree that its body says

    const Shape<D>& shape() const { return model->shape; }
    const ShapeDefinition<D>& definition() const { return model->definition; }
    const Vec<D>& core() const { return model->core; }
    double core_radius() const { return model->core_radius; }
};

/// What bodies are made of, for forces that ask for it.
template <int D>
struct Solids {
    std::span<const BodyInfo<D>> bodies;
    std::span<const ShapeRecord<D>> shapes;

    /// Visits the shapes of a body that have a mass: all but sensors, unless it has no others.
    template <class Visit>
    void each(std::uint32_t body, const Visit& visit) const {
        const ShortList<ShapeId<D>>& ids = bodies[body].shapes;
        const auto is_sensor = [&](const ShapeId<D>& id) { return shapes[id.index].definition().sensor; };
        const bool only_sensors = std::all_of(ids.begin(), ids.end(), is_sensor);
        for (const ShapeId<D>& id : ids) {
            if (only_sensors || !is_sensor(id)) visit(shapes[id.index].shape());
        }
    }
};

}  // namespace carom::detail
