#include "carom/mass.hpp"

#include "geometry/polytope_mass.hpp"
#include "geometry/shape.hpp"
#include "geometry/terrain.hpp"
#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace detail {
namespace {

/// A box with half lengths h, grown by the radius r: ball (h = 0), capsule (all h but one zero) and rounded
/// box. By symmetry only ∫ xᵢ² are needed, from one slab |x| ≤ h and what lies beyond it on both sides, which
/// is what is left of the cross sections when x runs from 0 to r: ∫ (h + |x|)² = h² A + 2 h B + C.
MassProperties2 rounded_box_mass(const Vec2& h, double r) {
    const double disk = pi * r * r;
    const double area = 4 * h.x * h.y + 4 * r * (h.x + h.y) + disk;
    // ∫ x² for half lengths a along x and b across.
    const auto along = [&](double a, double b) {
        const double slab = 2 * a * (2 * b + 2 * r) * a * a / 3;
        const double strips = 4 * b * ((a + r) * (a + r) * (a + r) - a * a * a) / 3;
        const double corners = a * a * disk + 2 * a * (4 * r * r * r / 3) + disk * r * r / 4;
        return slab + strips + corners;
    };
    return {area, {}, along(h.x, h.y) + along(h.y, h.x)};
}

MassProperties3 rounded_box_mass(const Vec3& h, double r) {
    const double disk = pi * r * r, ball = disk * r * 4 / 3;
    const double edges = h.x + h.y + h.z, faces = h.x * h.y + h.y * h.z + h.z * h.x;
    const double volume = 8 * h.x * h.y * h.z + 8 * r * faces + 2 * disk * edges + ball;
    // ∫ x² for half lengths a along x, b and c across.
    const auto along = [&](double a, double b, double c) {
        const double section = 4 * b * c + 4 * r * (b + c) + disk;
        const double slab = 2 * a * section * a * a / 3;
        const double faces_beyond = 8 * b * c * ((a + r) * (a + r) * (a + r) - a * a * a) / 3;
        const double edges_beyond =
            2 * (b + c) * (a * a * disk + 2 * a * (4 * r * r * r / 3) + disk * r * r / 4);
        const double corners = a * a * ball + 2 * a * (disk * r * r / 2) + ball * r * r / 5;
        return slab + faces_beyond + edges_beyond + corners;
    };
    const double xx = along(h.x, h.y, h.z), yy = along(h.y, h.z, h.x), zz = along(h.z, h.x, h.y);
    return {volume, {}, diagonal(yy + zz, zz + xx, xx + yy)};
}

/// A solid of revolution about the unit vector `axis`, of volume v, with ∫ t² along the axis and ∫ s² along
/// each line across it, about its centre.
MassProperties3 revolved(double volume, const Vec3& center, const Vec3& axis, double along, double across) {
    const double sideways = along + across;
    return {volume, center, diagonal(sideways, sideways, sideways) + outer_square(axis) * (across - along)};
}

/// Mass properties at density 1, in the frame of the body. Most shapes are found from what `make_shape` left.
template <int D>
class UnitDensity {
  public:
    explicit UnitDensity(const Shape<D>& shape) : shape_(shape) {}

    MassProperties<D> operator()(const Ball& ball) const {
        MassProperties<D> result = rounded_box_mass(Vec<D>{}, ball.radius);
        result.center = shape_.a;
        return result;
    }
    MassProperties<D> operator()(const Box<D>& box) const {
        Vec<D> half = box.size * 0.5;
        for (int i = 0; i < D; ++i) half[i] -= box.rounding;
        const MassProperties<D> result = rounded_box_mass(half, box.rounding);
        return {result.mass, shape_.a, rotated(result.inertia, shape_.rotation)};
    }
    MassProperties<D> operator()(const Capsule<D>& capsule) const {
        Vec<D> half{};
        half.x = 0.5 * length(shape_.b - shape_.a);
        MassProperties<D> result = rounded_box_mass(half, capsule.radius);
        result.center = 0.5 * (shape_.a + shape_.b);
        if constexpr (D == 3) {
            // About the axis Ixx, across it Iyy.
            const double about = result.inertia.xx, sideways = result.inertia.yy;
            result.inertia = diagonal(sideways, sideways, sideways) +
                             outer_square(normalized(shape_.b - shape_.a)) * (about - sideways);
        }
        return result;
    }
    MassProperties<D> operator()(const Hull<D>& hull) const {
        return polytope_mass(*shape_.core, hull.rounding);
    }
    MassProperties<D> operator()(const Plane<D>&) const { return {}; }
    template <class Ground>
    requires(is_terrain_type<Ground>) MassProperties<D>
    operator()(const Ground&) const { return {}; }

    MassProperties3 operator()(const Cylinder& c) const {
        const double square = c.radius * c.radius, volume = pi * square * c.height;
        return revolved(volume, shape_.a, shape_.b, volume * c.height * c.height / 12, volume * square / 4);
    }
    MassProperties3 operator()(const Cone& c) const {
        const double square = c.radius * c.radius, volume = pi * square * c.height / 3;
        const Vec3 center = shape_.a - 0.25 * c.height * shape_.b;
        return revolved(volume, center, shape_.b, volume * c.height * c.height * 3 / 80,
                        volume * square * 3 / 20);
    }

  private:
    const Shape<D>& shape_;
};

}  // namespace
}  // namespace detail

template <int D>
MassProperties<D> mass_properties(const ShapeDefinition<D>& shape) {
    // What has no mass need not be made.
    const auto is_terrain = [](const auto& g) { return detail::is_terrain_type<std::decay_t<decltype(g)>>; };
    if (std::visit(is_terrain, shape.geometry)) return {};
    const detail::Shape<D> made = detail::make_shape(shape);
    MassProperties<D> result = std::visit(detail::UnitDensity<D>(made), shape.geometry);
    result.mass *= shape.material.density;
    result.inertia = result.inertia * shape.material.density;
    return result;
}

template <int D>
MassProperties<D> combine(std::span<const MassProperties<D>> parts) {
    MassProperties<D> sum;
    for (const MassProperties<D>& part : parts) {
        detail::require_not_negative(part.mass, "mass");
        detail::require_finite(part.center, "center");
        detail::require_finite(part.inertia, "inertia");
        sum.mass += part.mass;
    }
    if (sum.mass > 0) {
        for (const MassProperties<D>& part : parts) sum.center += part.center * (part.mass / sum.mass);
    }
    for (const MassProperties<D>& part : parts) {
        sum.inertia = sum.inertia + part.inertia + detail::steiner(part.mass, part.center - sum.center);
    }
    return sum;
}

template <int D>
double measure(const Geometry<D>& geometry) {
    ShapeDefinition<D> shape;
    shape.geometry = geometry;
    shape.material.density = 1;
    return mass_properties(shape).mass;
}

template MassProperties2 mass_properties(const ShapeDefinition2&);
template MassProperties3 mass_properties(const ShapeDefinition3&);
template MassProperties2 combine(std::span<const MassProperties2>);
template MassProperties3 combine(std::span<const MassProperties3>);
template double measure<2>(const Geometry<2>&);
template double measure<3>(const Geometry<3>&);

}  // namespace carom
