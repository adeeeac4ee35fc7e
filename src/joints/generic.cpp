#include "joints/types.hpp"

namespace carom::detail {

/// A row for each way and each turn, along and about the axes of frame a.
template <int D>
JointRecord<D> place(const GenericJoint<D>& joint, const JointSite<D>& site) {
    require_finite(joint.anchor, "anchor");
    require_direction(joint.axis, "axis");
    JointBuilder<D> builder(site);
    builder.anchors(joint.anchor, joint.anchor);
    builder.drive(Measure::along).drive(Measure::along_y);
    if constexpr (D == 2) {
        builder.frame(frame_along(joint.axis)).drive(Measure::twist);
    } else {
        require_direction(joint.second_axis, "second_axis");
        require_direction(cross(normalized(joint.axis), normalized(joint.second_axis)),
                          "second_axis (across axis)");
        builder.frame(frame_along(joint.axis, joint.second_axis))
            .drive(Measure::along_z)
            .drive(Measure::turn_x)
            .drive(Measure::turn_y)
            .drive(Measure::turn_z);
    }
    return builder.record;
}

template <int D>
void configure(const GenericJoint<D>& joint, JointRecord<D>& record) {
    if constexpr (D == 2) {
        set_layout<2, layout(LinearPart::none, AngularPart::none, DriveKind::slide, DriveKind::slide,
                             DriveKind::turn)>(record);
    } else {
        using enum DriveKind;
        set_layout<3, layout(LinearPart::none, AngularPart::none, slide, slide, slide, turn, turn, turn)>(
            record);
    }
    for (std::size_t i = 0; i < record.drives.size(); ++i) {
        const bool is_way = i < static_cast<std::size_t>(D);
        const JointAxis& axis = is_way ? joint.ways[i] : joint.turns[i - D];
        set_limits(record.drives[i], axis.limits, is_way ? "ways.limits" : "turns.limits");
        set_motor_and_spring(record.drives[i], axis.motor, axis.spring, 0,
                             is_way ? "ways.motor" : "turns.motor");
    }
}

CAROM_INSTANTIATE_JOINT(GenericJoint)

}  // namespace carom::detail
