#include <string>

#include "joints/couplings.hpp"

namespace carom::detail {

namespace {

/// The end of a coupling that is the coordinate of a joint.
template <int D>
JointRecord<D> end_at(const JointRecord<D>& joint, std::size_t drive) {
    JointRecord<D> end = joint;
    end.drives = {joint.drives[drive]};
    return end;
}

template <int D>
JointRecord<D> turning_end(const CoupledJoint<D>& joint, const char* field) {
    const auto& kind = joint.definition.kind;
    if (std::holds_alternative<HingeJoint<D>>(kind) || std::holds_alternative<RatchetJoint<D>>(kind))
        return end_at(joint.record, 0);
    if (std::holds_alternative<WheelJoint<D>>(joint.definition.kind)) return end_at(joint.record, 1);
    throw Error(std::string(field) + ": is neither a hinge nor a wheel");
}

void check_ratio(double ratio) {
    require_finite(ratio, "ratio");
    if (ratio == 0) refuse("ratio", ratio, "is zero");
}

}  // namespace

/// angle_b + ratio · angle_a stays.
template <int D>
CouplingRecord<D> couple(const GearJoint<D>& joint, const CoupledJoint<D>& a, const CoupledJoint<D>& b) {
    check_ratio(joint.ratio);
    CouplingRecord<D> record;
    record.ends = {turning_end(a, "joint_a"), turning_end(b, "joint_b")};
    record.factors = {joint.ratio, 1};
    return record;
}

/// way_b − ratio · angle_a stays.
template <int D>
CouplingRecord<D> couple(const RackJoint<D>& joint, const CoupledJoint<D>& a, const CoupledJoint<D>& b) {
    check_ratio(joint.ratio);
    if (!std::holds_alternative<SliderJoint<D>>(b.definition.kind)) throw Error("joint_b: is not a slider");
    CouplingRecord<D> record;
    record.ends = {turning_end(a, "joint_a"), end_at(b.record, 0)};
    record.factors = {-joint.ratio, 1};
    return record;
}

#define CAROM_INSTANTIATE(D)                                                                                \
    template CouplingRecord<D> couple(const GearJoint<D>&, const CoupledJoint<D>&, const CoupledJoint<D>&); \
    template CouplingRecord<D> couple(const RackJoint<D>&, const CoupledJoint<D>&, const CoupledJoint<D>&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
