#include "world/validate.hpp"

#include "geometry/shape.hpp"
#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom::detail {

template <int D>
void validate(const WorldDefinition<D>& w) {
    require_finite(w.gravity, "gravity");
    require_in(w.substeps, 1, 64, "substeps");
    require_not_negative(w.restitution_threshold, "restitution_threshold");
    require_not_negative(w.hit_speed, "hit_speed");
}

void validate_inertia(double inertia) { require_positive(inertia, "inertia"); }

void validate_inertia(const Symmetric3<double>& inertia) {
    require_finite(inertia, "inertia");
    if (!is_positive_definite(inertia)) throw Error("inertia: the matrix is not positive definite");
}

template <int D>
void require_place_for(const Shape<D>& shape, BodyType type) {
    if (shape.kind == ShapeKind::plane && type != BodyType::fixed)
        throw Error("geometry: a plane needs a fixed body");
    if (shape.kind == ShapeKind::terrain && type == BodyType::dynamic)
        throw Error("geometry: a chain, mesh or height field needs a fixed or kinematic body");
}

template <int D>
void validate_place(const Transform<D>& placed) {
    require_finite(placed.position, "position");
    require_unit(placed.rotation, "rotation");
}

template <int D>
void validate_places(std::span<const Transform<D>> places) {
    std::size_t checked = 0;
    try {
        for (; checked < places.size(); ++checked) validate_place(places[checked]);
    } catch (const Error& error) {
        throw Error("places[" + std::to_string(checked) + "]." + error.what());
    }
}

template <int D>
void validate_motion(const BodyDefinition<D>& b) {
    require_finite(b.velocity, "velocity");
    require_finite(b.angular_velocity, "angular_velocity");
}

template <int D>
std::vector<Shape<D>> validate(const BodyDefinition<D>& b, Scheduler* scheduler) {
    if (b.mass) require_positive(*b.mass, "mass");
    if (b.center_of_mass) require_finite(*b.center_of_mass, "center_of_mass");
    if (b.inertia) validate_inertia(*b.inertia);
    require_finite(b.gravity_scale, "gravity_scale");
    require_not_negative(b.linear_damping, "linear_damping");
    require_not_negative(b.angular_damping, "angular_damping");
    std::vector<Shape<D>> shapes;
    std::vector<const ShapeDefinition<D>*> definitions;
    for (std::size_t i = 0; i < b.shapes.size(); ++i) {
        within("shapes[" + std::to_string(i) + "].", [&] {
            shapes.push_back(make_shape(b.shapes[i], scheduler));
            require_place_for(shapes.back(), b.type);
        });
    }
    for (const ShapeDefinition<D>& s : b.shapes) definitions.push_back(&s);
    body_mass<D>(b.type, overrides_of(b), definitions);
    return shapes;
}

template <int D>
void validate(const ForceDefinition<D>& f) {
    if (!(f.from >= 0)) refuse("from", f.from, "is negative or not a number");
    if (!(f.to >= f.from)) refuse("to", f.to, "lies before `from`");
    const auto check = [](const auto& kind) {
        using Kind = std::decay_t<decltype(kind)>;
        if constexpr (requires { kind.value; }) require_finite(kind.value, "value");
        if constexpr (requires { kind.point; }) {
            if (kind.point) require_finite(*kind.point, "point");
        }
        if constexpr (std::is_same_v<Kind, TimedImpulse<D>>) require_not_negative(kind.at, "at");
        if constexpr (std::is_same_v<Kind, Drag<D>>) {
            require_not_negative(kind.linear, "linear");
            require_not_negative(kind.quadratic, "quadratic");
        }
        if constexpr (std::is_same_v<Kind, Wind<D>>) {
            require_finite(kind.velocity, "velocity");
            require_not_negative(kind.density, "density");
        }
        if constexpr (std::is_same_v<Kind, PointGravity<D>>) {
            require_finite(kind.center, "center");
            require_finite(kind.gm, "gm");
        }
        if constexpr (std::is_same_v<Kind, Buoyancy<D>>) {
            require_finite(kind.up, "up");
            if (!(length(normalized(kind.up)) > 0.5)) throw Error("up: a direction has a length");
            require_finite(kind.surface, "surface");
            require_not_negative(kind.density, "density");
            require_not_negative(kind.linear_drag, "linear_drag");
            require_not_negative(kind.quadratic_drag, "quadratic_drag");
            require_finite(kind.flow, "flow");
        }
        if constexpr (std::is_same_v<Kind, Spring<D>>) {
            require_finite(kind.anchor_a, "anchor_a");
            require_finite(kind.anchor_b, "anchor_b");
            require_not_negative(kind.stiffness, "stiffness");
            require_not_negative(kind.damping, "damping");
            if (kind.length) require_not_negative(*kind.length, "length");
        }
    };
    std::visit(check, f.kind);
}

template void require_place_for(const Shape<2>&, BodyType);
template void require_place_for(const Shape<3>&, BodyType);
template void validate_place(const Transform<2>&);
template void validate_places(std::span<const Transform<2>>);
template void validate_motion(const BodyDefinition<2>&);
template void validate_place(const Transform<3>&);
template void validate_places(std::span<const Transform<3>>);
template void validate_motion(const BodyDefinition<3>&);
template void validate(const WorldDefinition<2>&);
template void validate(const WorldDefinition<3>&);
template std::vector<Shape<2>> validate(const BodyDefinition<2>&, Scheduler*);
template std::vector<Shape<3>> validate(const BodyDefinition<3>&, Scheduler*);
template void validate(const ForceDefinition<2>&);
template void validate(const ForceDefinition<3>&);

}  // namespace carom::detail
