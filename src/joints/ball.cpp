#include "joints/types.hpp"
#include "math/trig.hpp"

namespace carom::detail {

/// The anchors stay together. In space the axis may be kept within a cone about that of a (swing), and the
/// turn about it between limits (twist).
template <int D>
JointRecord<D> place(const BallJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.anchor, "anchor");
    JointBuilder<D> builder(site);
    builder.anchors(joint.anchor, joint.anchor);
    if constexpr (D == 3) {
        require_direction(joint.axis, "axis");
        if (joint.cone_axis) require_direction(*joint.cone_axis, "cone_axis");
        // The frame of a is that of b, swung by the shortest way: the twist is zero as the bodies stand.
        const Rotation3 b = frame_along(joint.axis);
        const Rotation3 swing = frame_along(unrotate(b, joint.cone_axis.value_or(joint.axis)));
        builder.frames(b * swing, b).drive(Measure::swing).drive(Measure::twist);
    } else {
        builder.frame({});
    }
    return builder.record;
}

template <int D>
void configure(const BallJoint<D>& joint, JointRecord<D>& record) {
    require_most(joint.friction, "friction");
    record.held = {};
    record.held.friction = joint.friction;
    if (joint.spring) {
        check(*joint.spring, "spring");
        record.held.angular = spring_settings(*joint.spring, 0);
    }
    const bool turns_freely = !joint.spring && joint.friction == 0 && !joint.swing_limit && !joint.twist_limits;
    if (turns_freely) {
        set_layout<D, layout(LinearPart::point, AngularPart::none)>(record);
    } else if constexpr (D == 2) {
        if (joint.swing_limit) throw Error("swing_limit: has a meaning in 3D only");
        if (joint.twist_limits) throw Error("twist_limits: have a meaning in 3D only; use a hinge");
        set_layout<D, layout(LinearPart::point, AngularPart::held)>(record);
    } else {
        if (joint.swing_limit && !(*joint.swing_limit > 0 && *joint.swing_limit <= pi))
            refuse("swing_limit", *joint.swing_limit, "is not above 0 and at most π");
        set_layout<D, layout(LinearPart::point, AngularPart::held, DriveKind::turn, DriveKind::turn)>(record);
        record.drives[0].high = joint.swing_limit.value_or(std::numeric_limits<double>::infinity());
        set_limits(record.drives[1], joint.twist_limits, "twist_limits");
    }
}

CAROM_INSTANTIATE_JOINT(BallJoint)

}  // namespace carom::detail
