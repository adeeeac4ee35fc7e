#pragma once

#include <functional>
#include <memory>

#include "brute_2.hpp"
#include "oracle_3.hpp"

namespace carom::test {

/// A placed shape next to an oracle that tells, by simple means, how far a point is from its surface.
template <int D>
struct Sample {
    Solid<D> solid;
    Transform<D> placed;
    Vec<D> base;             ///< about where it is
    Transform<D> from_base;  ///< where it was made, as seen from there
    std::function<double(const Vec<D>& from_base)> height_from_base;
    std::function<double(const Vec<D>& direction)> reach_from_base;
    double size;
    double vagueness;  ///< how far the oracle and the shape may differ
    bool plane;
    Vec<D> shift{};        ///< that it was moved by
    Rotation<D> turned{};  ///< about the base, before that

    /// Signed distance of a point from the surface, negative inside.
    double height(const Vec<D>& point) const {
        return height_from_base(unrotate(turned, point - base - shift));
    }
    /// How far it reaches from the base along the unit vector.
    double reach(const Vec<D>& direction) const {
        return reach_from_base(unrotate(turned, direction)) + dot(direction, shift);
    }
    /// Turns the shape about its base, as it was made, and moves it.
    void place(const Rotation<D>& turn, const Vec<D>& way) {
        turned = turn;
        const Vec<D> here = rotate(turned, from_base.position);
        placed = {base + here + way, normalized(turned * from_base.rotation)};
        shift = placed.position - base - here;  // as the position is rounded, so must be the oracle's
    }
    /// Moves the shape.
    void move(const Vec<D>& way) { place(turned, shift + way); }
};

template <int D>
constexpr int sample_kinds = D == 2 ? 5 : space::kinds;
template <int D>
constexpr int plane_kind = 4;

/// A shape of a kind, 0 … sample_kinds − 1, about as large as `size` and that near to `base`; turned at
/// random unless told how.
template <int D>
Sample<D> random_sample(int kind, double size, Random& random, const Vec<D>& base = {},
                        const std::optional<Rotation<D>>& turned = {}) {
    Transform<D> here = random.placement<D>(size);
    if (turned) here.rotation = *turned;
    const Transform<D> there{base + here.position, here.rotation};
    const bool plane = kind == plane_kind<D>;
    // As the position is rounded far away, so must be the oracle's.
    const Transform<D> near{there.position - base, here.rotation};
    if constexpr (D == 2) {
        if (plane) {
            const Plane2 half{random.direction<2>(), random.between(-size, size)};
            return {Geometry<2>(half),
                    there,
                    base,
                    near,
                    [=](const Vec2& p) { return dot(half.normal, apply_inverse(near, p)) - half.offset; },
                    [=](const Vec2& d) {
                        const Vec2 normal = rotate(near.rotation, half.normal);
                        return length(d - normal) < 1e-7 ? half.offset + dot(d, near.position) : 1e300;
                    },
                    size,
                    0,
                    plane};
        }
        const ShapeDefinition2 shape = random_shape(static_cast<Kind>(kind), random, 0.5 * size);
        const auto cloud = std::make_shared<Cloud>(shape, near);
        return {shape,
                there,
                base,
                near,
                [=](const Vec2& p) { return signed_distance(*cloud, p); },
                [=](const Vec2& d) { return cloud->highest(d) + cloud->radius; },
                size,
                1e-9 * size,
                plane};
    } else {
        const Geometry<3> geometry = space::random_geometry(static_cast<space::Kind>(kind), size, random);
        const auto body = std::make_shared<space::Body3>(geometry, near);
        const Solid<3> solid{geometry};
        double vagueness = body->vagueness();
        if (const auto* hull = std::get_if<Hull3>(&geometry)) {
            // Where no point was left out, only faces of more than three corners may be a little off.
            const detail::Polyhedron& core = *solid.shape().core;
            if (core.vertices.size() == hull->points.size()) vagueness = core.unevenness;
        }
        return {solid,
                there,
                base,
                near,
                [=](const Vec3& p) { return body->height(p); },
                [=](const Vec3& d) { return body->reach(d); },
                size,
                1e-9 * size + vagueness,
                plane};
    }
}

/// The place in [0, 1] where a convex function is least, by golden section.
template <class Function>
double least_at(const Function& f) {
    constexpr double ratio = 0.6180339887498949;
    double low = 0, high = 1, p = 1 - ratio, q = ratio, fp = f(p), fq = f(q);
    for (int i = 0; i < 90; ++i) {
        if (fp < fq) {
            high = q;
            q = p;
            fq = fp;
            p = high - ratio * (high - low);
            fp = f(p);
        } else {
            low = p;
            p = q;
            fp = fq;
            q = low + ratio * (high - low);
            fq = f(q);
        }
    }
    return 0.5 * (low + high);
}

}  // namespace carom::test
