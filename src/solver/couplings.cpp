#include "solver/couplings.hpp"

#include <cmath>

#include "solver/drive.hpp"
#include "solver/joint_load.hpp"

namespace carom::detail {

template <int D>
void Couplings<D>::prepare(const JointInput<D>& input) {
    rows_.clear();
    step_ = joint_step(input.substep);
    for (const std::uint32_t i : input.active_couplings) {
        CouplingRecord<D>& c = input.couplings[i];
        Row row;
        row.coupling = i;
        row.is_rope = c.is_rope;
        row.impulse = c.kept;
        row.before = c.before;
        double sum = -c.sum;
        for (int k = 0; k < 2; ++k) {
            JointRecord<D>& joint = c.ends[k];
            const JointPose<D> pose = pose_of<D>(joint, input.states, input.masses);
            DriveSettings& drive = joint.drives[0];
            const Measured<D> now = measure(drive, pose);
            drive.coordinate = now.value;
            sum += c.factors[k] * now.value;
            row.ends[k] = {kind_of(drive.measure),
                           input.slot_of(joint.body_a),
                           input.slot_of(joint.body_b),
                           {narrow<float>(pose.arm_a), narrow<float>(pose.arm_b), narrow<float>(pose.gap)},
                           narrow<float>(now.axis),
                           static_cast<float>(c.factors[k])};
        }
        row.error = static_cast<float>(sum);
        const View view = look_at<false>(row, input.bodies);
        row.effects = view.effects;
        rows_.push_back(row);
    }
    for (const Row& row : rows_) push(row.effects, input.bodies, row.impulse);
}

template <int D>
void Couplings<D>::store(const JointInput<D>& input) const {
    for (const Row& row : rows_) {
        CouplingRecord<D>& c = input.couplings[row.coupling];
        c.kept = row.impulse;
        c.before = row.before;
        input.joints[c.joint].total = {row.total * row.on_last.force, row.on_last.on_a * row.total,
                                       row.on_last.on_b * row.total};
    }
}

/// A body that two ends share is pushed by both.
template <int D>
void Couplings<D>::add(View& view, const Effect& effect) {
    for (int i = 0; i < view.count; ++i) {
        Effect& known = view.effects[i];
        if (known.slot != effect.slot) continue;
        known.push += effect.push;
        known.twist = known.twist + effect.twist;
        return;
    }
    view.effects[view.count++] = effect;
}

/// Adds what an end contributes, and returns the change of its coordinate since the step began.
template <int D>
template <bool biased>
float Couplings<D>::look_at_end(const End& end, const RecordView<D>& bodies, View& view) const {
    Body<D, float> a = gather<float>(bodies, &end.a), b = gather<float>(bodies, &end.b);
    const Turning<D, float> ta(a.motion, step_.h), tb(b.motion, step_.h);
    Wrench<D, float> unused{};
    const Link<D, float> link{a.motion, b.motion, a.weight, b.weight, unused};
    const Geometry<D, float> g = geometry<biased>(end.anchors, ta, tb, a.motion, b.motion);
    Turned<D, float> n;
    Wrench<D, float> w;
    float speed, change;
    if (end.kind == DriveKind::stretch) {
        n = {normalized(g.gap), normalized(g.gap_middle), normalized(g.gap_end)};
        w = g.at_anchors(n.middle);
        speed = dot(n.end, g.speed(link));
        change = length(g.gap) - length(end.anchors.gap);
    } else if (end.kind == DriveKind::slide) {
        n = turned<biased>(end.axis, ta);
        w = g.at_b(n.middle);
        speed = dot(n.end, g.speed_along_line(link));
        change = dot(n.now, g.gap) - dot(end.axis, end.anchors.gap);
    } else {
        const Angular<D, float> turn = relative_turn<D, float>(a.motion.turned, b.motion.turned);
        if constexpr (D == 2) {
            w = {{}, 1, 1};
            speed = link.spin();
            change = turn;
        } else {
            n = turned<biased>(end.axis, ta);
            w = {{}, n.middle, n.middle};
            speed = dot(n.end, link.spin());
            change = 0.5f * dot(end.axis + n.now, turn);
        }
    }
    view.speed += end.factor * speed;
    add(view, {end.a, -end.factor * w.force, -end.factor * w.on_a});
    add(view, {end.b, end.factor * w.force, end.factor * w.on_b});
    view.on_last = {end.factor * w.force, end.factor * w.on_a, end.factor * w.on_b};
    return end.factor * change;
}

template <int D>
template <bool biased>
auto Couplings<D>::look_at(const Row& row, const RecordView<D>& bodies) const -> View {
    View view;
    view.error = row.error;
    for (const End& end : row.ends) view.error += look_at_end<biased>(end, bodies, view);
    return view;
}

template <int D>
float Couplings<D>::compliance(const View& view, const RecordView<D>& bodies) {
    float sum = 0;
    for (int i = 0; i < view.count; ++i) {
        const Effect& e = view.effects[i];
        const Weight<D, float> weight = gather<float>(bodies, &e.slot).weight;
        sum += dot(e.push, each(weight.mass, e.push)) + angular_dot(e.twist, weight.inertia * e.twist);
    }
    return sum;
}

template <int D>
void Couplings<D>::push(std::span<const Effect> effects, const RecordView<D>& bodies, float impulse) {
    for (const Effect& e : effects) {
        if (e.slot < bodies.first_movable) continue;
        Body<D, float> body = gather<float>(bodies, &e.slot);
        body.motion.v += impulse * each(body.weight.mass, e.push);
        body.motion.w = body.motion.w + impulse * (body.weight.inertia * e.twist);
        write_record(bodies, &e.slot, body);
    }
}

template <int D>
void Couplings<D>::shift(const View& view, const RecordView<D>& bodies, float impulse) {
    for (const Effect& e : std::span(view.effects).first(view.count)) {
        if (e.slot < bodies.first_movable) continue;
        Body<D, float> body = gather<float>(bodies, &e.slot);
        body.motion.moved += impulse * each(body.weight.mass, e.push);
        body.motion.turned = body.motion.turned + impulse * (body.weight.inertia * e.twist);
        write_record(bodies, &e.slot, body);
    }
}

template <int D>
template <bool biased>
void Couplings<D>::pass(const RecordView<D>& bodies) {
    for (Row& row : rows_) {
        const View view = look_at<biased>(row, bodies);
        if constexpr (biased) {
            // A blow is not kept: it would strike again.
            const float kept =
                steady_share(row.impulse * row.impulse, row.impulse * row.before) * row.impulse;
            row.before = row.impulse;
            // The impulses turn into their new directions (see JointPass::re_aim).
            push(row.effects, bodies, -row.impulse);
            row.impulse = kept;
            push(view.effects, bodies, row.impulse);
            row.effects = view.effects;
        }
        const float mass = inverse_or_zero(compliance(view, bodies));
        const float speed = biased ? look_at<biased>(row, bodies).speed : view.speed;
        const bool is_slack = row.is_rope && view.error < 0;
        float next = row.impulse - mass * (speed + (is_slack ? view.error * step_.inverse_h : 0.0f));
        if (row.is_rope) next = minimum(0.0f, next);
        push(view.effects, bodies, next - row.impulse);
        row.impulse = next;
        row.on_last = view.on_last;
        if constexpr (!biased) row.total += next;
        if constexpr (biased) {
            if (!is_slack) shift(view, bodies, -mass * step_.share * cut_to(view.error, step_.most_way));
        }
    }
}

template class Couplings<2>;
template class Couplings<3>;

}  // namespace carom::detail
