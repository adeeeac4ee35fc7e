#pragma once

#include <span>
#include <string>
#include <vector>

#include "carom/body.hpp"
#include "carom/error.hpp"
#include "carom/forces.hpp"
#include "carom/world.hpp"
#include "dynamics/body.hpp"
#include "geometry/shape.hpp"

namespace carom::detail {

/// Calls `work`; an `Error` from it gets `prefix` in front of its message.
template <class Work>
auto within(const std::string& prefix, Work&& work) {
    try {
        return work();
    } catch (const Error& error) {
        throw Error(prefix + error.what());
    }
}

/// Each throws `Error` that names the field.
template <int D>
void validate(const WorldDefinition<D>& definition);
/// Only where the body is to be.
template <int D>
void validate_place(const Transform<D>& placed);
/// Of each of many; the message says which it is.
template <int D>
void validate_places(std::span<const Transform<D>> places);
/// Only how the body moves.
template <int D>
void validate_motion(const BodyDefinition<D>& definition);
/// All but that. Returns the shapes, made ready.
template <int D>
std::vector<Shape<D>> validate(const BodyDefinition<D>& definition, Scheduler* scheduler);
/// Numbers only; whether the bodies exist is the world's to check.
template <int D>
void validate(const ForceDefinition<D>& definition);

/// Throws `Error` when a body of this type cannot carry the shape.
template <int D>
void require_place_for(const Shape<D>& shape, BodyType type);

void validate_inertia(double inertia);
void validate_inertia(const Symmetric3<double>& inertia);

/// The shapes of a body.
template <int D>
using ShapesOf = std::span<const ShapeDefinition<D>* const>;

/// Mass properties of a body with these shapes, overrides included. Throws `Error` when a dynamic body would
/// have no mass.
template <int D>
MassProperties<D> body_mass(BodyType type, const MassOverrides<D>& given, ShapesOf<D> shapes);

template <int D>
MassOverrides<D> overrides_of(const BodyDefinition<D>& definition) {
    return {definition.mass, definition.center_of_mass, definition.inertia};
}
template <int D>
MassOverrides<D> overrides_of(const BodyInfo<D>& info) {
    return info.seen().overrides.value_or(MassOverrides<D>{});
}

}  // namespace carom::detail
