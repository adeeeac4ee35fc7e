#include <fmt/format.h>

#include <set>

#include "io/scene_parts.hpp"

namespace carom::io {
namespace {

constexpr std::pair<std::string_view, BodyType> body_types[] = {
    {"dynamic", BodyType::dynamic}, {"fixed", BodyType::fixed}, {"kinematic", BodyType::kinematic}};

struct Axis {
    std::string_view name;
    bool Locks::*lock;
    bool in_plane;  ///< has a meaning in 2D
};
constexpr Axis axes[] = {{"x", &Locks::x, true},  {"y", &Locks::y, true},    {"rz", &Locks::rz, true},
                         {"z", &Locks::z, false}, {"rx", &Locks::rx, false}, {"ry", &Locks::ry, false}};

template <int D>
void read_locks(const Value& value, Locks& locks) {
    std::vector<std::string_view> names;
    for (const Axis& axis : axes)
        if (D == 3 || axis.in_plane) names.push_back(axis.name);
    for_each_element(value,
                     [&](const Value& element) { locks.*axes[read_choice(element, names)].lock = true; });
}

/// A name stands for one body only, and cannot be taken for the label of a nameless one.
void read_name(const Value& value, std::set<std::string, std::less<>>& names, std::string& name) {
    read(value, name);
    if (name.empty()) value.refuse("is empty; leave the key out instead");
    if (name.front() == '#') value.refuse("begins with \"#\", as the labels of nameless bodies do");
    if (!names.insert(name).second) value.refuse("is the name of an earlier body already");
}

template <int D>
void read_body(const Value& value, const Materials& materials, std::set<std::string, std::less<>>& names,
               BodyDefinition<D>& body, std::vector<std::string>& material_names) {
    const auto name = [&](const Value& v) { read_name(v, names, body.name); };
    const auto type = [&](const Value& v) { read_choice<BodyType>(v, body_types, body.type); };
    const auto locks = [&](const Value& v) { read_locks<D>(v, body.locks); };
    const auto shapes = [&](const Value& list) {
        for_each_element(list, [&](const Value& shape) {
            read_shape(shape, materials, body.shapes.emplace_back(), material_names.emplace_back());
        });
    };
    read_object(value,
                {field("name", name), field("type", type), field("position", body.position),
                 orientation<D>(body.rotation), field("velocity", body.velocity),
                 field("angular_velocity", body.angular_velocity), field("mass", body.mass),
                 field("center_of_mass", body.center_of_mass), field("inertia", body.inertia),
                 field("gravity_scale", body.gravity_scale), field("linear_damping", body.linear_damping),
                 field("angular_damping", body.angular_damping), field("can_sleep", body.can_sleep),
                 field("bullet", body.bullet), field("locks", locks), field("shapes", shapes)});
}

}  // namespace

template <int D>
void read_bodies(const Value& value, const Materials& materials, SceneData<D>& scene) {
    std::set<std::string, std::less<>> names;
    for_each_element(value, [&](const Value& body) {
        read_body(body, materials, names, scene.bodies.emplace_back(), scene.materials.emplace_back());
    });
}

template void read_bodies(const Value&, const Materials&, SceneData<2>&);
template void read_bodies(const Value&, const Materials&, SceneData<3>&);

}  // namespace carom::io
