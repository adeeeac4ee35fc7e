#pragma once

#include "joints/builder.hpp"

/// The joint types. For each, `place` makes the record from the bodies as they stand, and `configure` writes
/// limits, motors, springs and the like into it, then and whenever they change. Both throw `Error` that names
/// the field. Each type has its own file, which says what rows it is made of.
namespace carom::detail {

#define CAROM_JOINT_TYPE(Type)                                      \
    template <int D>                                                \
    JointRecord<D> place(const Type<D>&, const JointSite<D>& site); \
    template <int D>                                                \
    void configure(const Type<D>&, JointRecord<D>& record);
CAROM_JOINT_TYPE(HingeJoint)
CAROM_JOINT_TYPE(SliderJoint)
CAROM_JOINT_TYPE(BallJoint)
CAROM_JOINT_TYPE(WeldJoint)
CAROM_JOINT_TYPE(DistanceJoint)
CAROM_JOINT_TYPE(WheelJoint)
CAROM_JOINT_TYPE(MotorJoint)
CAROM_JOINT_TYPE(TargetJoint)
CAROM_JOINT_TYPE(ParallelJoint)
CAROM_JOINT_TYPE(RatchetJoint)
CAROM_JOINT_TYPE(PathJoint)
CAROM_JOINT_TYPE(GenericJoint)
#undef CAROM_JOINT_TYPE

}  // namespace carom::detail

/// At the foot of the file of a type.
#define CAROM_INSTANTIATE_JOINT(Type)                                   \
    template JointRecord<2> place(const Type<2>&, const JointSite<2>&); \
    template JointRecord<3> place(const Type<3>&, const JointSite<3>&); \
    template void configure(const Type<2>&, JointRecord<2>&);           \
    template void configure(const Type<3>&, JointRecord<3>&);
