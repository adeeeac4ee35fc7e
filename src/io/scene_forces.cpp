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

/// A type of force: its name, and a function that makes it and says how its fields are read.
template <int D>
struct ForceType {
    std::string_view name;
    Fields (*fields)(const BodyNames<D>&, ForceDefinition<D>&);
};

template <int D>
constexpr std::array<ForceType<D>, 7> force_types = {{{"force", force_fields<D>},
                                                      {"torque", torque_fields<D>},
                                                      {"impulse", impulse_fields<D>},
                                                      {"drag", drag_fields<D>},
                                                      {"wind", wind_fields<D>},
                                                      {"point_gravity", point_gravity_fields<D>},
                                                      {"spring", spring_fields<D>}}};

template <int D>
const ForceType<D>& read_type(const Value& value) {
    std::vector<std::string_view> names;
    for (const auto& type : force_types<D>) names.push_back(type.name);
    if (value.json() == "buoyancy")
        value.refuse(fmt::format("is not supported by this version; allowed are {}", listed(names)));
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
