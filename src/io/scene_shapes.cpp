#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/scene_parts.hpp"

namespace carom::io {
namespace {

template <int D>
Fields ball_fields(Geometry<D>& geometry, const Materials&) {
    Ball& ball = geometry.template emplace<Ball>();
    return {required("radius", ball.radius)};
}

template <int D>
Fields box_fields(Geometry<D>& geometry, const Materials&) {
    Box<D>& box = geometry.template emplace<Box<D>>();
    return {required("size", box.size), field("rounding", box.rounding)};
}

template <int D>
Fields capsule_fields(Geometry<D>& geometry, const Materials&) {
    Capsule<D>& capsule = geometry.template emplace<Capsule<D>>();
    return {required("from", capsule.from), required("to", capsule.to), required("radius", capsule.radius)};
}

template <int D>
Fields hull_fields(Geometry<D>& geometry, const Materials&) {
    Hull<D>& hull = geometry.template emplace<Hull<D>>();
    return {required("points", hull.points), field("rounding", hull.rounding)};
}

template <int D>
Fields plane_fields(Geometry<D>& geometry, const Materials&) {
    Plane<D>& plane = geometry.template emplace<Plane<D>>();
    return {required("normal", plane.normal), required("offset", plane.offset)};
}

/// For cylinders and cones.
template <class Round>
Fields round_fields(Geometry<3>& geometry, const Materials&) {
    Round& round = geometry.emplace<Round>();
    return {required("radius", round.radius), required("height", round.height)};
}

/// A type of shape: its name, and a function that makes the geometry and says how its fields are read.
template <int D>
struct ShapeType {
    std::string_view name;
    Fields (*fields)(Geometry<D>&, const Materials&);
};

template <int D>
constexpr auto shape_types() {
    if constexpr (D == 2)
        return std::array<ShapeType<2>, 7>{{{"ball", ball_fields<2>},
                                            {"box", box_fields<2>},
                                            {"capsule", capsule_fields<2>},
                                            {"hull", hull_fields<2>},
                                            {"plane", plane_fields<2>},
                                            {"chain", chain_fields},
                                            {"height_field", height_field_fields<2>}}};
    else
        return std::array<ShapeType<3>, 9>{{{"ball", ball_fields<3>},
                                            {"box", box_fields<3>},
                                            {"capsule", capsule_fields<3>},
                                            {"hull", hull_fields<3>},
                                            {"cylinder", round_fields<Cylinder>},
                                            {"cone", round_fields<Cone>},
                                            {"plane", plane_fields<3>},
                                            {"mesh", mesh_fields},
                                            {"height_field", height_field_fields<3>}}};
}

constexpr std::string_view types_of_space[] = {"cylinder", "cone", "mesh"};

template <int D>
const ShapeType<D>& read_type(const Value& value) {
    static constexpr auto types = shape_types<D>();
    std::vector<std::string_view> names;
    for (const auto& type : types) names.push_back(type.name);

    std::string written;
    read(value, written);
    if (D == 2 && std::ranges::count(types_of_space, written))
        value.refuse(fmt::format("exists in 3D only; allowed in 2D are {}", listed(names)));
    if (D == 3 && written == "chain")
        value.refuse(fmt::format("exists in 2D only; allowed in 3D are {}", listed(names)));
    return types[read_choice(value, names)];
}

}  // namespace

Fields material_fields(Material& material) {
    const auto restitution = [&material](const Value& value) {
        read(value, material.restitution);
        if (material.restitution < 0 || material.restitution > 1) value.refuse("is not between 0 and 1");
    };
    return {not_negative("density", material.density), not_negative("friction", material.friction),
            field("restitution", restitution),
            not_negative("rolling_resistance", material.rolling_resistance)};
}

template <int D>
void read_shape(const Value& value, const Materials& materials, ShapeDefinition<D>& shape,
                std::string& material_name) {
    // The type comes first: it says which other fields there may be.
    const Value type(value, member(value, "type"), "type");
    const Fields of_type = read_type<D>(type).fields(shape.geometry, materials);

    const auto material = [&](const Value& name) {
        shape.material = read_material(name, materials, material_name);
    };
    const Fields placed = {field("type", [](const Value&) {}), field("center", shape.center),
                           orientation<D>(shape.rotation)};
    // A number is a speed along the shape's x axis.
    const auto surface_velocity = [&](const Value& v) {
        if (v.json().is_number())
            read(v, shape.surface_velocity.x);
        else
            read(v, shape.surface_velocity);
    };
    // The named material comes before the fields that may change it.
    const Fields contact = {field("category", shape.filter.category),    field("mask", shape.filter.mask),
                            field("group", shape.filter.group),          field("sensor", shape.sensor),
                            field("surface_velocity", surface_velocity), field("one_way", shape.one_way)};
    read_object(value, placed + of_type + Fields{field("material", material)} +
                           material_fields(shape.material) + contact);
}

template void read_shape(const Value&, const Materials&, ShapeDefinition<2>&, std::string&);
template void read_shape(const Value&, const Materials&, ShapeDefinition<3>&, std::string&);

}  // namespace carom::io
