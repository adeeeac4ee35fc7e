#include "joints/path.hpp"

#include "geometry/curve.hpp"
#include "joints/types.hpp"

namespace carom::detail {

namespace {

/// A path that bends less than this is taken for one that bends so: within a step the difference is a
/// hundredth of a millimetre.
constexpr double most_radius = 300;  // m

template <int D>
std::shared_ptr<const Curve<D>> curve_of(const PathJoint<D>& joint, const JointSite<D>& site) {
    if (joint.points.size() < 2) throw Error("points: there are fewer than two");
    std::vector<Vec<D>> points;
    for (const Vec<D>& p : joint.points) {
        require_finite(p, "points");
        points.push_back(apply_inverse(site.a, p));
    }
    const std::size_t pieces = joint.loop ? points.size() : points.size() - 1;
    for (std::size_t i = 0; i < pieces; ++i) {
        if (length(points[(i + 1) % points.size()] - points[i]) < 1e-6)
            throw Error("points: two neighbours are the same");
    }
    return std::make_shared<const Curve<D>>(std::move(points), joint.loop, joint.smooth);
}

}  // namespace

/// The way along the path is a coordinate. Across it anchor b stays at its distance from the centre about
/// which the path bends where it is, and in space in the plane in which it does.
template <int D>
JointRecord<D> place(const PathJoint<D>& joint, const JointSite<D>& site) {
    const Vec<D> anchor = joint.anchor.value_or(site.center_b);
    require_finite(anchor, "anchor");
    JointBuilder<D> builder(site);
    builder.anchors(anchor, anchor).frame({}).drive(Measure::along).drive(Measure::stretch);
    if constexpr (D == 3) builder.drive(Measure::along_y);
    JointRecord<D> record = builder.record;
    record.path.curve = curve_of(joint, site);
    record.path.place = record.path.curve->nearest(record.anchor_a);
    follow_path(record, record.anchor_a);
    return record;
}

template <int D>
void configure(const PathJoint<D>& joint, JointRecord<D>& record) {
    DriveSettings& along = record.drives[0];
    set_limits(along, joint.limits, "limits");
    if (!joint.limits && !joint.loop) {
        along.low = 0;
        along.high = record.path.curve->length();
    }
    set_motor_and_spring(along, joint.motor, joint.spring, 0);
    if constexpr (D == 2) {
        set_layout<2, layout(LinearPart::none, AngularPart::none, DriveKind::slide, DriveKind::stretch)>(
            record);
    } else {
        set_layout<3, layout(LinearPart::none, AngularPart::none, DriveKind::slide, DriveKind::stretch,
                             DriveKind::slide)>(record);
    }
}

/// The way on a closed path counts on from round to round.
template <int D>
void follow_path(JointRecord<D>& record, const Vec<D>& point) {
    PathState<D>& path = record.path;
    const double before = path.place;
    path.place = path.curve->nearest(point, before);
    if (path.curve->loop()) {
        const double half = 0.5 * path.curve->last_place();
        if (path.place - before > half) --path.rounds;
        if (before - path.place > half) ++path.rounds;
    }
    const CurvePlace<D> at = path.curve->at(path.place);
    const double bend = length(at.bend);
    // Where the path is straight, it bends to the side to which it bent before.
    Vec<D> normal = path.normal - dot(path.normal, at.tangent) * at.tangent;
    if (bend > 1 / most_radius || length(normal) < 1e-3)
        normal = bend > 1e-9 ? at.bend : tangents<D>(at.tangent)[0];
    normal = normalized(normal);
    const bool turned_over = dot(normal, path.normal) < 0;
    path.normal = normal;
    const double radius = 1 / std::max(bend, 1 / most_radius);
    record.anchor_a = at.point + radius * normal;
    if constexpr (D == 2) {
        record.frame_a = frame_along(at.tangent);
    } else {
        record.frame_a = frame_along(at.tangent, cross(at.tangent, normal));
    }
    record.drives[0].zero = -(at.way + path.rounds * path.curve->length());
    record.drives[1].low = record.drives[1].high = radius;
    if constexpr (D == 3) record.drives[2].low = record.drives[2].high = 0;
    if (turned_over) {
        for (std::size_t i = kept_of_drive(1); i < kept_of_drive(D); ++i) record.kept[i] = -record.kept[i];
    }
}

CAROM_INSTANTIATE_JOINT(PathJoint)
template void follow_path(JointRecord<2>&, const Vec<2>&);
template void follow_path(JointRecord<3>&, const Vec<3>&);

}  // namespace carom::detail
