#pragma once

#include "joints/builder.hpp"

/// The joints that couple two coordinates.
namespace carom::detail {

/// A joint that another one names.
template <int D>
struct CoupledJoint {
    const JointDefinition<D>& definition;
    const JointRecord<D>& record;
};

template <int D>
CouplingRecord<D> couple(const PulleyJoint<D>& joint, const JointSite<D>& site);
template <int D>
CouplingRecord<D> couple(const GearJoint<D>& joint, const CoupledJoint<D>& a, const CoupledJoint<D>& b);
template <int D>
CouplingRecord<D> couple(const RackJoint<D>& joint, const CoupledJoint<D>& a, const CoupledJoint<D>& b);

}  // namespace carom::detail
