#include <algorithm>
#include <cmath>
#include <vector>

#include "math/check.hpp"
#include "world/state.hpp"
#include "world/validate.hpp"

namespace carom::detail {

namespace {

/// Cube root of x ≥ 0 by Newton's iteration, from above, where it falls until it is exact to rounding.
double cube_root(double x) {
    if (x <= 0) return 0;
    double r = std::max(1.0, x);
    for (double next = r; (next = (2 * r + x / (r * r)) / 3) < r;) r = next;
    return r;
}

/// Area that a ball of the given measure shows to the wind: πr² of the volume 4/3 πr³, or 2r of the area πr².
template <int D>
double ball_cross_section(double measure) {
    if constexpr (D == 2) {
        return 2 * std::sqrt(measure / pi);
    } else {
        const double radius = cube_root(3 * measure / (4 * pi));
        return pi * radius * radius;
    }
}

bool is_isotropic(double) { return true; }
bool is_isotropic(const Symmetric3<double>& i) {
    const double tolerance = 1e-9 * (i.xx + i.yy + i.zz);
    return std::fabs(i.xx - i.yy) <= tolerance && std::fabs(i.xx - i.zz) <= tolerance &&
           std::fabs(i.xy) <= tolerance && std::fabs(i.xz) <= tolerance && std::fabs(i.yz) <= tolerance;
}

template <int D>
MassProperties<D> sum_of_shapes(ShapesOf<D> shapes) {
    std::vector<MassProperties<D>> parts;
    const bool only_sensors = std::ranges::all_of(shapes, [](const auto* s) { return s->sensor; });
    for (const ShapeDefinition<D>* s : shapes) {
        if (!s->sensor || only_sensors) parts.push_back(carom::mass_properties<D>(*s));
    }
    return combine<D>(parts);
}

/// What the shapes give, and what the user put in its place.
template <int D>
MassProperties<D> resolve(const MassOverrides<D>& given, ShapesOf<D> shapes) {
    MassProperties<D> p = sum_of_shapes<D>(shapes);
    if (p.mass == 0) {  // shapes without density still say how the given mass is spread
        std::vector<ShapeDefinition<D>> dense;
        for (const ShapeDefinition<D>* s : shapes) dense.push_back(*s);
        std::vector<const ShapeDefinition<D>*> list;
        for (ShapeDefinition<D>& s : dense) {
            s.material.density = 1;
            list.push_back(&s);
        }
        p = sum_of_shapes<D>(list);
        if (!given.mass) p.mass = 0;
    }
    if (given.mass) {
        p.inertia = p.mass > 0 ? p.inertia * (*given.mass / p.mass) : Inertia<D>{};
        p.mass = *given.mass;
    }
    if (given.center_of_mass) p.center = *given.center_of_mass;
    if (given.inertia) p.inertia = *given.inertia;
    return p;
}

}  // namespace

template <int D>
MassProperties<D> body_mass(BodyType type, const MassOverrides<D>& given, ShapesOf<D> shapes) {
    const MassProperties<D> p = resolve<D>(given, shapes);
    if (type == BodyType::dynamic && !(p.mass > 0))
        throw Error("mass: a dynamic body needs a mass, or shapes with a density that is not zero");
    if (type == BodyType::dynamic) require_in(p.mass, 1e-30, 1e30, "mass");
    return p;
}

template <int D>
void WorldState<D>::update_mass(std::uint32_t body) {
    const BodyInfo<D>& info = infos[body];
    std::vector<const ShapeDefinition<D>*> definitions;
    double measured = 0;
    for (const ShapeId<D>& id : info.shapes) {
        definitions.push_back(&shapes[id.index].definition());
        measured += measure<D>(definitions.back()->geometry);
    }
    const MassProperties<D> p = resolve<D>(overrides_of(info), definitions);
    BodyMass<D>& m = masses[body];
    const Vec<D> moved_center = rotate(states[body].rotation, p.center - m.center);
    states[body].position += moved_center;
    states[body].velocity += cross(states[body].angular_velocity, moved_center);
    m.center = p.center;
    m.inertia = p.inertia;
    m.cross_section = ball_cross_section<D>(measured);
    const bool dynamic = types[body] == BodyType::dynamic;
    m.mass = dynamic ? p.mass : 0;
    m.inverse_mass = dynamic ? 1 / p.mass : 0;
    m.inverse_inertia = dynamic && p.inertia != Inertia<D>{} ? inverse(p.inertia) : Inertia<D>{};
    m.isotropic = is_isotropic(p.inertia);
    m.radius = 0;
    m.core_radius = info.shapes.empty() ? 0 : shapes[info.shapes[0].index].core_radius();
    for (const ShapeId<D>& id : info.shapes) {
        m.core_radius = std::min(m.core_radius, shapes[id.index].core_radius());
        if (shapes[id.index].shape().kind == ShapeKind::plane) continue;
        const Aabb<D> box = bounds(shapes[id.index].shape(), Transform<D>{});
        Vec<D> far;
        for (int i = 0; i < D; ++i) far[i] = std::max(m.center[i] - box.lower[i], box.upper[i] - m.center[i]);
        m.radius = std::max(m.radius, length(far));
    }
    measure_extents(body);
    expect_other_joints();
}

template MassProperties<2> body_mass(BodyType, const MassOverrides<2>&, ShapesOf<2>);
template MassProperties<3> body_mass(BodyType, const MassOverrides<3>&, ShapesOf<3>);
template void WorldState<2>::update_mass(std::uint32_t);
template void WorldState<3>::update_mass(std::uint32_t);

}  // namespace carom::detail
