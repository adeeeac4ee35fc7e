#include <fmt/format.h>

#include <array>

#include "io/names.hpp"
#include "io/scene_parts.hpp"

namespace carom::io {
namespace {

/// The body that a force names, as its index in the scene.
template <int D>
class BodyNames {
  public:
    explicit BodyNames(const SceneData<D>& scene) {
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            indices_.add(scene.bodies[i].name, static_cast<std::uint32_t>(i));
    }

    /// The field of a body; `target` is its handle, or an optional one.
    template <class Target>
    Field operator()(std::string_view key, Target& target) const {
        return {key, [this, &target](const Value& value) {
                    target = BodyId<D>{indices_.find(value, "a body"), 0};
                }};
    }

  private:
    IndexByName indices_;
};

Field needed(Field field) {
    field.required = true;
    return field;
}

template <class Force, int D>
Force& make(ForceDefinition<D>& definition) {
    return definition.kind.template emplace<Force>();
}

template <int D>
Fields force_fields(const BodyNames<D>& body, ForceDefinition<D>& definition) {
    auto& force = make<ConstantForce<D>>(definition);
    return {needed(body("body", force.body)), required("value", force.value), field("point", force.point),
            field("local", force.local)};
}

template <int D>
Fields torque_fields(const BodyNames<D>& body, ForceDefinition<D>& definition) {
    auto& torque = make<ConstantTorque<D>>(definition);
    return {needed(body("body", torque.body)), required("value", torque.value)};
}

template <int D>
Fields impulse_fields(const BodyNames<D>& body, ForceDefinition<D>& definition) {
    auto& impulse = make<TimedImpulse<D>>(definition);
    return {needed(body("body", impulse.body)), required("value", impulse.value),
            field("point", impulse.point), not_negative("at", impulse.at)};
}

template <int D>
Fields drag_fields(const BodyNames<D>& body, ForceDefinition<D>& definition) {
    auto& drag = make<Drag<D>>(definition);
    return {body("body", drag.body), not_negative("linear", drag.linear),
            not_negative("quadratic", drag.quadratic)};
}

template <int D>
Fields wind_fields(const BodyNames<D>&, ForceDefinition<D>& definition) {
    auto& wind = make<Wind<D>>(definition);
    return {required("velocity", wind.velocity), not_negative("density", wind.density)};
}

template <int D>
Fields point_gravity_fields(const BodyNames<D>&, ForceDefinition<D>& definition) {
    auto& gravity = make<PointGravity<D>>(definition);
    return {field("center", gravity.center), required("gm", gravity.gm)};
}

template <int D>
Fields spring_fields(const BodyNames<D>& body, ForceDefinition<D>& definition) {
    auto& spring = make<Spring<D>>(definition);
    const auto length = [&spring](const Value& value) {
        not_negative("length", spring.length.emplace()).read(value);
    };
    return {body("a", spring.a),
            needed(body("b", spring.b)),
            field("anchor_a", spring.anchor_a),
            field("anchor_b", spring.anchor_b),
            not_negative("stiffness", spring.stiffness),
            not_negative("damping", spring.damping),
            field("length", length)};
}

/// A surface is a height, or a plane; drag is linear, or both kinds.
template <int D>
Fields buoyancy_fields(const BodyNames<D>&, ForceDefinition<D>& definition) {
    auto& water = make<Buoyancy<D>>(definition);
    const auto normal = [&water](const Value& value) {
        read(value, water.up);
        if (water.up == Vec<D>{}) value.refuse("has no length");
    };
    const auto surface = [&water, normal](const Value& value) {
        if (value.json().is_object())
            return read_object(value, {required("normal", normal), required("offset", water.surface)});
        read(value, water.surface);
    };
    const auto drag = [&water](const Value& value) {
        if (value.json().is_object())
            return read_object(value, {not_negative("linear", water.linear_drag),
                                       not_negative("quadratic", water.quadratic_drag)});
        not_negative("drag", water.linear_drag).read(value);
    };
    return {required("surface", surface), not_negative("density", water.density), field("drag", drag),
            field("flow", water.flow)};
}

/// A type of force: its name, and a function that makes it and says how its fields are read.
template <int D>
struct ForceType {
    std::string_view name;
    Fields (*fields)(const BodyNames<D>&, ForceDefinition<D>&);
};

template <int D>
constexpr std::array<ForceType<D>, 8> force_types = {{{"force", force_fields<D>},
                                                      {"torque", torque_fields<D>},
                                                      {"impulse", impulse_fields<D>},
                                                      {"drag", drag_fields<D>},
                                                      {"wind", wind_fields<D>},
                                                      {"point_gravity", point_gravity_fields<D>},
                                                      {"spring", spring_fields<D>},
                                                      {"buoyancy", buoyancy_fields<D>}}};

template <int D>
const ForceType<D>& read_type(const Value& value) {
    std::vector<std::string_view> names;
    for (const auto& type : force_types<D>) names.push_back(type.name);
    return force_types<D>[read_choice(value, names)];
}

template <int D>
void read_force(const Value& value, const BodyNames<D>& bodies, ForceDefinition<D>& force) {
    const Value type(value, member(value, "type"), "type");
    const Fields of_type = read_type<D>(type).fields(bodies, force);
    const auto to = [&force](const Value& end) {
        read(end, force.to);
        if (force.to < force.from) end.refuse(fmt::format("is before \"from\", {}", force.from));
    };
    read_object(value, Fields{field("type", [](const Value&) {})} + of_type +
                           Fields{not_negative("from", force.from), field("to", to)});
}

}  // namespace

template <int D>
void read_forces(const Value& value, SceneData<D>& scene) {
    const BodyNames<D> bodies(scene);
    for_each_element(value,
                     [&](const Value& force) { read_force(force, bodies, scene.forces.emplace_back()); });
}

template void read_forces(const Value&, SceneData<2>&);
template void read_forces(const Value&, SceneData<3>&);

}  // namespace carom::io
