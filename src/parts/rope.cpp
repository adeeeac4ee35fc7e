#include "carom/parts/rope.hpp"

#include <cmath>

#include "math/check.hpp"
#include "math/dim.hpp"

namespace carom {
namespace {

using namespace detail;

template <int D>
void check(const World<D>& world, const RopeDefinition<D>& rope) {
    if (rope.path.size() < 2)
        throw Error("path: " + std::to_string(rope.path.size()) + " points are fewer than 2");
    for (std::size_t i = 0; i < rope.path.size(); ++i) {
        require_finite(rope.path[i], component("path", static_cast<int>(i)));
        if (i > 0 && rope.path[i] == rope.path[i - 1])
            throw Error(component("path", static_cast<int>(i)) + ": is the same point as the one before");
    }
    require_positive(rope.link_length, "link_length");
    require_positive(rope.thickness, "thickness");
    if (rope.thickness >= rope.link_length)
        refuse("thickness", rope.thickness, "is not less than link_length, " + to_text(rope.link_length));
    require_positive(rope.width, "width");
    require_positive(rope.material.density, "material.density");
    require_not_negative(rope.friction, "friction");
    require_not_negative(rope.linear_damping, "linear_damping");
    require_not_negative(rope.angular_damping, "angular_damping");
    if (!(rope.break_force > 0)) refuse("break_force", rope.break_force, "is not positive");
    for (const auto& end : {rope.start, rope.end}) {
        if (end && !world.contains(*end)) throw Error("body: the handle names nothing in this world");
    }
}

/// The rotation that turns the x axis into the unit vector, with the z axis level where that can be.
Rotation2 along_x(const Vec2& x) { return {x.x, x.y}; }
Rotation3 along_x(const Vec3& x) {
    // First about y to the heading, then about z to the slope.
    const double level = std::sqrt(x.x * x.x + x.z * x.z);
    const Rotation3 slope = Rotation3::from_axis_angle({0, 0, 1}, atan2(x.y, level));
    if (level == 0) return slope;
    return Rotation3::from_axis_angle({0, 1, 0}, atan2(-x.z, x.x)) * slope;
}

template <int D>
ShapeDefinition<D> link_shape(const RopeDefinition<D>& rope, double length) {
    ShapeDefinition<D> shape;
    shape.material = rope.material;
    shape.filter = rope.filter;
    const double radius = 0.5 * rope.thickness;
    if (rope.kind == LinkKind::bridge) {
        Box<D> plank;
        plank.size.x = length;
        plank.size.y = rope.thickness;
        if constexpr (D == 3) plank.size.z = rope.width;
        shape.geometry = plank;
    } else {
        Vec<D> half{};
        half.x = std::max(0.5 * length - radius, 0.05 * length);
        shape.geometry = Capsule<D>{-half, half, radius};
    }
    return shape;
}

/// A joint at the point; `turned` says which of the two axes a chain's hinge has.
template <int D>
JointDefinition<D> joint_at(const RopeDefinition<D>& rope, const Vec<D>& point, const Rotation<D>& rotation,
                            bool turned) {
    JointDefinition<D> joint;
    joint.break_force = rope.break_force;
    if (D == 3 && rope.kind == LinkKind::rope) {
        BallJoint<D> ball{.anchor = point, .friction = rope.friction};
        if constexpr (D == 3) ball.axis = rotate(rotation, Vec3{1, 0, 0});
        joint.kind = ball;
        return joint;
    }
    HingeJoint<D> hinge{.anchor = point};
    if constexpr (D == 3)
        hinge.axis = rotate(rotation, rope.kind == LinkKind::chain && turned ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
    if (rope.friction > 0) hinge.motor = JointMotor{.speed = 0, .max = rope.friction};
    joint.kind = hinge;
    return joint;
}

/// Puts links in line one after the other.
template <int D>
class Strand {
  public:
    Strand(World<D>& world, const RopeDefinition<D>& definition) : world_(world), rope_(definition) {}

    void add_stretch(const Vec<D>& from, const Vec<D>& to) {
        const Vec<D> way = to - from;
        const double length = carom::length(way);
        const int count = std::max(1, static_cast<int>(length / rope_.link_length + 0.5));
        const Rotation<D> rotation = along_x(way / length);
        const ShapeDefinition<D> shape = link_shape(rope_, length / count);
        for (int i = 0; i < count; ++i) {
            const Vec<D> start = from + way * (double(i) / count);
            BodyDefinition<D> link;
            link.position = from + way * ((i + 0.5) / count);
            link.rotation = rotation;
            link.linear_damping = rope_.linear_damping;
            link.angular_damping = rope_.angular_damping;
            link.shapes.push_back(shape);
            const BodyId<D> body = world_.add_body(link);
            if (!made.links.empty())
                tie(made.links.back(), body, start, rotation);
            else if (rope_.hold_start)
                tie(rope_.start, body, start, rotation);
            made.links.push_back(body);
        }
        last_ = rotation;
    }
    void finish(const Vec<D>& end) {
        if (rope_.hold_end) tie(rope_.end, made.links.back(), end, last_);
    }

    Rope<D> made;

  private:
    void tie(std::optional<BodyId<D>> a, BodyId<D> b, const Vec<D>& point, const Rotation<D>& rotation) {
        JointDefinition<D> joint = joint_at(rope_, point, rotation, made.joints.size() % 2 == 1);
        joint.a = a;
        joint.b = b;
        made.joints.push_back(world_.add_joint(joint));
    }

    World<D>& world_;
    const RopeDefinition<D>& rope_;
    Rotation<D> last_{};
};

}  // namespace

template <int D>
Rope<D> add_rope(World<D>& world, const RopeDefinition<D>& definition) {
    check(world, definition);
    Strand<D> strand(world, definition);
    for (std::size_t i = 0; i + 1 < definition.path.size(); ++i)
        strand.add_stretch(definition.path[i], definition.path[i + 1]);
    strand.finish(definition.path.back());
    return std::move(strand.made);
}

template Rope<2> add_rope(World<2>&, const RopeDefinition<2>&);
template Rope<3> add_rope(World<3>&, const RopeDefinition<3>&);

}  // namespace carom
