#include "carom/parts/masonry.hpp"

#include <algorithm>
#include <cmath>

#include "math/check.hpp"

namespace carom {
namespace {

using namespace detail;

/// Where two faces lie on each other: how much, how wide at its narrowest, and its middle.
template <int D>
struct Face {
    double area = 0, width = 0;
    Vec<D> middle{};
};

Face<2> face_of(const Manifold<2>& m) {
    if (m.count < 2) return {};
    const Vec2 a = m.points[0].position, b = m.points[1].position;
    const double width = length(b - a);
    return {width, width, 0.5 * (a + b)};
}

Face<3> face_of(const Manifold<3>& m) {
    if (m.count < 3) return {};
    const auto at = [&](int i) { return m.points[static_cast<std::size_t>(i)].position; };
    Face<3> face;
    double longest = 0;
    for (int i = 0; i < m.count; ++i) {
        face.middle += at(i) / m.count;
        for (int j = 0; j < i; ++j) longest = std::max(longest, length(at(i) - at(j)));
    }
    // The points lie in a plane, in any order: of the three ways to pair four corners the diagonals give
    // most.
    const auto half_cross = [](const Vec3& u, const Vec3& v) { return 0.5 * length(cross(u, v)); };
    if (m.count == 3) {
        face.area = half_cross(at(1) - at(0), at(2) - at(0));
    } else {
        face.area =
            std::max({half_cross(at(1) - at(0), at(3) - at(2)), half_cross(at(2) - at(0), at(3) - at(1)),
                      half_cross(at(3) - at(0), at(2) - at(1))});
    }
    // Of a rectangle with the sides w ≤ l: area w l, diagonal √(w² + l²).
    const double square = longest * longest;
    const double root = std::sqrt(std::max(0.0, square * square - 4 * face.area * face.area));
    face.width = std::sqrt(std::max(0.0, 0.5 * (square - root)));
    return face;
}

/// The largest face that the shapes of two bodies have in common.
template <int D>
Face<D> common_face(const World<D>& world, BodyId<D> a, BodyId<D> b,
                    const std::vector<std::vector<Solid<D>>>& solids, std::size_t i, std::size_t j,
                    double reach) {
    Face<D> best;
    for (const Solid<D>& one : solids[i]) {
        for (const Solid<D>& other : solids[j]) {
            const Face<D> face = face_of(collide(one, world.transform(a), other, world.transform(b), reach));
            if (face.area > best.area) best = face;
        }
    }
    return best;
}

}  // namespace

template <int D>
std::vector<JointId<D>> glue(World<D>& world, std::span<const BodyId<D>> bodies, const Mortar<D>& mortar) {
    require_positive(mortar.strength, "strength");
    require_positive(mortar.reach, "reach");
    std::vector<std::vector<Solid<D>>> solids;
    for (const BodyId<D> body : bodies) {
        solids.emplace_back();
        for (const ShapeId<D> shape : world.shapes(body)) {
            if (!world.shape(shape).sensor) solids.back().emplace_back(world.shape(shape));
        }
    }
    std::vector<JointId<D>> joints;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        for (std::size_t j = i + 1; j < bodies.size(); ++j) {
            const bool any_moves =
                world.type(bodies[i]) == BodyType::dynamic || world.type(bodies[j]) == BodyType::dynamic;
            if (!any_moves || bodies[i] == bodies[j]) continue;
            const Face<D> face = common_face(world, bodies[i], bodies[j], solids, i, j, mortar.reach);
            if (!(face.width > mortar.reach)) continue;
            JointDefinition<D> weld;
            weld.kind = WeldJoint<D>{.anchor = face.middle};
            weld.a = bodies[i];
            weld.b = bodies[j];
            weld.break_force = mortar.strength * face.area;
            weld.break_torque = mortar.strength * face.area * face.width / 6;
            joints.push_back(world.add_joint(weld));
        }
    }
    return joints;
}

template std::vector<JointId2> glue(World2&, std::span<const BodyId2>, const Mortar<2>&);
template std::vector<JointId3> glue(World3&, std::span<const BodyId3>, const Mortar<3>&);

}  // namespace carom
