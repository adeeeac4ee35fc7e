#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/json_reader.hpp"
#include "io/scene.hpp"

namespace carom::io {

// The parts that a scene file is read by, one source file each. All throw `Error` with the place.

using Materials = std::map<std::string, Material, std::less<>>;

/// The fields of a material, which a shape may have as well.
Fields material_fields(Material& material);

/// The material that the value names; `name` becomes what it is called.
const Material& read_material(const Value& value, const Materials& materials, std::string& name);

/// Make a geometry and say how its fields are read; `materials` are those of the scene.
Fields chain_fields(Geometry<2>& geometry, const Materials& materials);
Fields mesh_fields(Geometry<3>& geometry, const Materials& materials);
template <int D>
Fields height_field_fields(Geometry<D>& geometry, const Materials& materials);

/// The turn of a frame: `angle` in 2D, `rotation` in 3D.
template <int D>
Field orientation(Rotation<D>& rotation) {
    return field(D == 2 ? "angle" : "rotation", rotation);
}

/// Reads a shape and, into `material_name`, the name of its material.
template <int D>
void read_shape(const Value& value, const Materials& materials, ShapeDefinition<D>& shape,
                std::string& material_name);

/// Reads the list of bodies.
template <int D>
void read_bodies(const Value& value, const Materials& materials, SceneData<D>& scene);

/// Reads the list of joints, which may name the bodies of the scene and earlier joints.
template <int D>
void read_joints(const Value& value, SceneData<D>& scene);

/// Reads the list of forces, which may name the bodies of the scene.
template <int D>
void read_forces(const Value& value, SceneData<D>& scene);

}  // namespace carom::io
