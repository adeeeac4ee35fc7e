#include "io/record_links.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "geometry/curve.hpp"

namespace carom::io {
namespace {

template <int D>
ReplayVector replay_vector(const Vec<D>& v) {
    if constexpr (D == 2)
        return {v.x, v.y, 0};
    else
        return {v.x, v.y, v.z};
}

/// Collects the links of one joint after another.
template <int D>
class JointDrawer {
  public:
    JointDrawer(const SceneWorld<D>& scene, std::vector<ReplayLink>& links) : scene_(scene), links_(links) {}

    void draw(JointId<D> id) {
        const JointDefinition<D>& joint = scene_.world.joint(id);
        const double never = std::numeric_limits<double>::infinity();
        if (joint.break_force < never || joint.break_torque < never) return;
        a_ = joint.a;
        b_ = joint.b;
        const auto anchors = scene_.world.anchors(id);
        anchor_a_ = anchors[0];
        anchor_b_ = anchors[1];
        std::visit([&](const auto& kind) { (*this)(kind); }, joint.kind);
    }

    void operator()(const HingeJoint<D>& joint) {
        draw_anchor();
        draw_axis(joint.axis);
    }
    void operator()(const RatchetJoint<D>& joint) {
        draw_anchor();
        draw_axis(joint.axis);
    }
    void operator()(const BallJoint<D>&) { draw_anchor(); }
    void operator()(const WeldJoint<D>&) { draw_anchor(); }
    void operator()(const WheelJoint<D>&) { draw_anchor(); }
    void operator()(const GenericJoint<D>&) { draw_anchor(); }
    void operator()(const SliderJoint<D>& joint) {
        draw_anchor();
        if (!joint.limits || !std::isfinite(joint.limits->low + joint.limits->high)) return;
        const Vec<D> axis = normalized(joint.axis);
        put("rail", a_, anchor_a_ + joint.limits->low * axis, a_, anchor_a_ + joint.limits->high * axis);
    }
    void operator()(const DistanceJoint<D>& joint) {
        put(joint.spring ? "spring" : "rod", a_, anchor_a_, b_, anchor_b_);
    }
    void operator()(const PulleyJoint<D>& joint) {
        put("rope", std::nullopt, joint.ground_a, a_, anchor_a_);
        put("rope", std::nullopt, joint.ground_a, std::nullopt, joint.ground_b);
        put("rope", std::nullopt, joint.ground_b, b_, anchor_b_);
    }
    void operator()(const PathJoint<D>& joint) {
        const detail::Curve<D> curve(joint.points, joint.loop, joint.smooth);
        const double step = joint.smooth ? 0.125 : 1;  // of a piece
        for (double at = 0; at < curve.last_place(); at += step)
            put("path", a_, curve.at(at).point, a_, curve.at(at + step).point);
    }
    void operator()(const TargetJoint<D>&) { put("spring", a_, anchor_a_, b_, anchor_b_); }
    void operator()(const MotorJoint<D>&) {}
    void operator()(const ParallelJoint<D>&) {}
    void operator()(const GearJoint<D>&) {}
    void operator()(const RackJoint<D>&) {}

  private:
    using Holder = std::optional<BodyId<D>>;  ///< none is the world

    std::int32_t index(const Holder& body) const {
        if (!body) return -1;
        return static_cast<std::int32_t>(std::ranges::find(scene_.bodies, *body) - scene_.bodies.begin());
    }
    ReplayVector local(const Holder& body, const Vec<D>& point) const {
        return replay_vector<D>(body ? apply_inverse(scene_.world.transform(*body), point) : point);
    }
    void put(const char* type, const Holder& a, const Vec<D>& from, const Holder& b, const Vec<D>& to) {
        links_.push_back({type, index(a), index(b), local(a, from), local(b, to)});
    }

    bool holds(BodyId<D> body, const Vec<D>& point) const {
        QueryFilter<D> filter;
        filter.sensors = true;
        filter.accepts = [&](ShapeId<D> shape) { return scene_.world.body_of(shape) == body; };
        return scene_.world.nearest_point(point, 1e-3, filter).has_value();
    }
    /// The point where both bodies meet, and arms to those that do not reach it.
    void draw_anchor() {
        put("anchor", a_, anchor_a_, b_, anchor_b_);
        if (!holds(b_, anchor_b_)) put("arm", a_, anchor_a_, b_, scene_.world.center_of_mass(b_));
        if (a_ && scene_.world.type(*a_) == BodyType::dynamic && !holds(*a_, anchor_a_))
            put("arm", b_, anchor_b_, a_, scene_.world.center_of_mass(*a_));
    }
    void draw_axis(const Vec3& axis) {
        if constexpr (D == 3) {
            const Vec3 half = 0.1 * normalized(axis);
            put("axis", b_, anchor_b_ - half, b_, anchor_b_ + half);
        }
    }

    const SceneWorld<D>& scene_;
    std::vector<ReplayLink>& links_;
    Holder a_;
    BodyId<D> b_;
    Vec<D> anchor_a_{}, anchor_b_{};
};

}  // namespace

template <int D>
std::vector<ReplayLink> joint_links(const SceneWorld<D>& scene) {
    std::vector<ReplayLink> links;
    JointDrawer<D> drawer(scene, links);
    for (const JointId<D> joint : scene.joints) drawer.draw(joint);
    return links;
}

template std::vector<ReplayLink> joint_links(const SceneWorld<2>&);
template std::vector<ReplayLink> joint_links(const SceneWorld<3>&);

}  // namespace carom::io
