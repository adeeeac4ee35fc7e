#include "solver/direct_rows.hpp"

#include <algorithm>
#include <cmath>

#include "solver/prepare.hpp"

namespace carom::detail {

namespace {

template <int D>
Vec<D> unit(int i) {
    Vec<D> v{};
    v[i] = 1;
    return v;
}

/// Turning about the direction i.
template <int D>
Angular<D> unit_turn(int i) {
    if constexpr (D == 2) {
        return 1;
    } else {
        return unit<3>(i);
    }
}

template <int D>
double component(const Angular<D>& v, int i) {
    if constexpr (D == 2) {
        return v;
    } else {
        return v[i];
    }
}

template <int D>
Wrench<D, double> twist(const Angular<D>& axis) {
    return {{}, axis, axis};
}

SpringRow<double> widen(const SpringRow<float>& s) { return {s.pull, s.keep, s.most}; }

}  // namespace

template <int D>
int DirectJoint<D>::linear_rows() const {
    return detail::linear_rows(rows().linear, D);
}
template <int D>
int DirectJoint<D>::angular_rows() const {
    return detail::angular_rows(rows().angular, D);
}

template <int D>
bool DirectJoint<D>::is_rigid() const {
    const Layout& l = rows();
    if (l.linear == LinearPart::held || l.angular == AngularPart::held) return false;
    for (int i = 0; i < l.drive_count; ++i) {
        const DriveBase<D, float>& d = drives[static_cast<std::size_t>(i)];
        if (d.high > d.low || d.spring.keep > 0 || d.motor_most > 0) return false;
    }
    return true;
}

template <int D>
void DirectJoint<D>::load(JointRecord<D>& record, std::span<const BodyState<D>> states,
                          std::span<const BodyMass<D>> masses, double h) {
    const JointPose<D> pose = pose_of<D>(record, states, masses, rows().drive_count > 0);
    anchors = {pose.arm_a, pose.arm_b, pose.gap};
    wrench = {narrow<double>(record.wrench.force), narrow<double>(record.wrench.on_a),
              narrow<double>(record.wrench.on_b)};
    before = total = {};
    const Layout& l = rows();
    const float* kept = record.kept.data();
    std::size_t row = 0;
    for (int i = 0; i < linear_rows(); ++i) impulses[row++] = *kept++;
    for (int i = 1; i < D; ++i) across[static_cast<std::size_t>(i - 1)] = pose.axis_a(i);
    axis_a = pose.axis_a(0);
    axis_b = l.angular == AngularPart::square ? pose.axis_b(1) : pose.axis_b(0);
    if (l.linear == LinearPart::held) {
        linear_spring = spring_row(record.held.linear, h, 1);
        for (int i = 0; i < D; ++i) before_speed[static_cast<std::size_t>(i)] = pose.speed()[i];
    }
    if (l.angular == AngularPart::square) {
        impulses[row++] = *kept++;
    } else if (l.angular != AngularPart::none) {
        if (l.angular != AngularPart::across) turn = turn_between<D>(pose);
        Angular<D> all{};
        for (int i = 0; i < turns; ++i) all = all + unit_turn<D>(i) * static_cast<double>(*kept++);
        if (l.angular == AngularPart::held) {
            rubbed = {};
            for (int i = 0; i < turns; ++i) rubbed = rubbed + unit_turn<D>(i) * static_cast<double>(*kept++);
            all = all + rubbed;
            angular_spring = spring_row(record.held.angular, h, 1);
            friction = std::min(record.held.friction * h, 1e37);
            for (int i = 0; i < turns; ++i)
                before_speed[row + static_cast<std::size_t>(i)] = component<D>(pose.spin_b - pose.spin_a, i);
        }
        across_impulse = all;
        for (int i = 0; i < angular_rows(); ++i) impulses[row++] = component<D>(all, i);
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(l.drive_count); ++i, kept += 4) {
        drives[i] = drive_row<D>(record.drives[i], record, pose, states, masses, h);
        before_speed[row] = drives[i].before;
        impulses[row++] = static_cast<double>(kept[0]) + kept[1] + kept[2] - kept[3];
    }
}

template <int D>
void DirectJoint<D>::store(JointRecord<D>& record) const {
    const auto narrowed = [](const Wrench<D, double>& w) -> Wrench<D, float> {
        return {narrow<float>(w.force), narrow<float>(w.on_a), narrow<float>(w.on_b)};
    };
    record.wrench = narrowed(wrench);
    record.before = narrowed(before);
    record.total = narrowed(total);
    const Layout& l = rows();
    float* kept = record.kept.data();
    std::size_t row = 0;
    const auto put = [&](double impulse) { *kept++ = static_cast<float>(impulse); };
    for (int i = 0; i < linear_rows(); ++i) put(impulses[row++]);
    if (l.angular == AngularPart::square) {
        put(impulses[row++]);
    } else if (l.angular != AngularPart::none) {
        const bool held = l.angular == AngularPart::held;
        const Angular<D> all = held ? Angular<D>(across_impulse - rubbed) : across_impulse;
        for (int i = 0; i < turns; ++i) put(component<D>(all, i));
        for (int i = 0; held && i < turns; ++i) put(component<D>(rubbed, i));
        row += static_cast<std::size_t>(angular_rows());
    }
    // What a limit holds and what a spring does is told apart anew in each sub-step.
    for (int i = 0; i < l.drive_count; ++i) {
        put(impulses[row++]);
        for (int k = 0; k < 3; ++k) put(0);
    }
}

template <int D>
void DirectJoint<D>::set_offsets(std::span<const DirectRow<D>> all) {
    for (int r = 0; r < row_count(); ++r) {
        const int part = part_of(r);
        const auto i = static_cast<std::size_t>(r);
        if (!is_sprung(part)) continue;
        const SpringRow<double> spring = widen(spring_of(part));
        const double rest = part < 2 ? 0.0 : drives[static_cast<std::size_t>(part - 2)].rest;
        offset[i] = spring.pull / spring.keep * (all[i].coordinate - rest) + before_speed[i];
    }
}

namespace {

/// Where a joint is in the middle of a pass, and the rows of its parts.
template <bool biased, int D>
class RowLayer {
  public:
    RowLayer(const DirectJoint<D>& joint, const Motion<D, double>& a, const Motion<D, double>& b,
             const JointStep<double>& step, std::span<DirectRow<D>> rows)
        : joint_(joint),
          a_(a),
          b_(b),
          step_(step),
          turn_a_(a, step.h),
          turn_b_(b, step.h),
          next_(rows.data()) {
        g_ = geometry<biased>(joint.anchors, turn_a_, turn_b_, a, b);
    }

    JointArms<D> lay() {
        lay_linear();
        lay_angular();
        for (int i = 0; i < joint_.rows().drive_count; ++i) lay_drive(i);
        return {g_.arm_a.middle, g_.arm_b.middle, g_.gap_middle};
    }

  private:
    void put(const Wrench<D, double>& middle, const Wrench<D, double>& end, double error) {
        next_->middle = middle;
        next_->end = end;
        next_->error = error;
        next_->coordinate = 0;
        ++next_;
    }
    template <class V>
    V to_mend(const V& error) const {
        if constexpr (std::is_same_v<V, double>) {
            return step_.share * cut_to(error, step_.most_way);
        } else {
            return step_.share * cut_to(error, step_.most_way);
        }
    }
    Turned<D, double> turned_with_a(const Vec<D>& v) const { return turned<biased>(v, turn_a_); }

    Wrench<D, double> at_anchors(const Vec<D>& n, const Vec<D>& arm_a, const Vec<D>& arm_b) const {
        return {n, cross(arm_a, n), cross(arm_b, n)};
    }
    /// A force that holds anchor b to something that is fixed in a.
    void put_at_b(const Turned<D, double>& n, double error) {
        put(at_anchors(n.middle, g_.arm_a.middle + g_.gap_middle, g_.arm_b.middle),
            at_anchors(n.end, g_.arm_a.end + g_.gap_end, g_.arm_b.end), error);
    }

    void lay_linear() {
        const LinearPart part = joint_.rows().linear;
        if (part == LinearPart::point || part == LinearPart::held) {
            const bool firm = part == LinearPart::point;
            const Vec<D> error = firm ? to_mend(g_.gap) : Vec<D>{};
            for (int i = 0; i < D; ++i) {
                const Vec<D> e = unit<D>(i);
                put(at_anchors(e, g_.arm_a.middle, g_.arm_b.middle),
                    at_anchors(e, g_.arm_a.end, g_.arm_b.end), error[i]);
                next_[-1].coordinate = g_.gap[i];
            }
        } else if (part == LinearPart::line) {
            std::array<Turned<D, double>, D - 1> n;
            double squared = 0;
            for (std::size_t i = 0; i < n.size(); ++i) {
                n[i] = turned_with_a(joint_.across[i]);
                const double error = dot(n[i].now, g_.gap);
                squared += error * error;
            }
            const double size = std::sqrt(squared);
            const double share = size > step_.most_way ? step_.share * step_.most_way / size : step_.share;
            for (const Turned<D, double>& axis : n) put_at_b(axis, share * dot(axis.now, g_.gap));
        }
    }

    void lay_angular() {
        const AngularPart part = joint_.rows().angular;
        if (part == AngularPart::locked || part == AngularPart::held) {
            const Angular<D> error = joint_.turn + relative_turn<D, double>(a_.turned, b_.turned);
            const bool firm = part == AngularPart::locked;
            const Angular<D> mended = firm ? to_mend(error) : Angular<D>{};
            for (int i = 0; i < DirectJoint<D>::turns; ++i) {
                const Wrench<D, double> w = twist<D>(unit_turn<D>(i));
                put(w, w, component<D>(mended, i));
                next_[-1].coordinate = component<D>(error, i);
            }
        }
        if constexpr (D == 3) {
            if (part == AngularPart::across) {
                const Turned<3, double> a = turned_with_a(joint_.axis_a);
                const Vec3 b = joint_.axis_b + turn_b_.change(joint_.axis_b);
                const Vec3 error = to_mend(cross(a.now, b));
                for (const Vec3& t : tangents<3>(a.middle))
                    put(twist<3>(t), twist<3>(t - dot(a.end, t) * a.end), dot(t, error));
            } else if (part == AngularPart::square) {
                const Turned<3, double> a = turned_with_a(joint_.axis_a);
                const Turned<3, double> b = turned<biased>(joint_.axis_b, turn_b_);
                put(twist<3>(cross(b.middle, a.middle)), twist<3>(cross(b.end, a.end)),
                    to_mend(dot(a.now, b.now)));
            }
        }
    }

    /// The coordinate of a turn counts from the start of the step.
    void lay_drive(int i) {
        const DriveBase<D, float>& base = joint_.drives[static_cast<std::size_t>(i)];
        const DriveKind kind = joint_.rows().drives[static_cast<std::size_t>(i)];
        const Vec<D> axis = narrow<double>(base.axis);
        double now;
        if (kind == DriveKind::stretch) {
            const auto unit_along = [](const Vec<D>& v) {
                const double size = length(v);
                return size > 1e-6 ? v / size : unit<D>(0);
            };
            const Vec<D> middle = unit_along(g_.gap_middle), end = unit_along(g_.gap_end);
            now = dot(unit_along(g_.gap), g_.gap);
            put(at_anchors(middle, g_.arm_a.middle, g_.arm_b.middle),
                at_anchors(end, g_.arm_a.end, g_.arm_b.end), 0);
        } else if (kind == DriveKind::slide) {
            const Turned<D, double> n = turned_with_a(axis);
            now = dot(n.now, g_.gap);
            put_at_b(n, 0);
        } else {
            const Angular<D> turn = relative_turn<D, double>(a_.turned, b_.turned);
            if constexpr (D == 2) {
                now = turn;
                put(twist<2>(1), twist<2>(1), 0);
            } else {
                const Turned<3, double> n = turned_with_a(axis);
                now = 0.5 * dot(axis + n.now, turn);
                put(twist<3>(n.middle), twist<3>(n.end), 0);
            }
        }
        const double above = now - base.low, below = base.high - now;
        const double error = base.high > base.low ? std::min(above, 0.0) - std::min(below, 0.0) : above;
        next_[-1].error = to_mend(error);
        next_[-1].coordinate = now;
    }

    const DirectJoint<D>& joint_;
    const Motion<D, double>&a_, &b_;
    const JointStep<double>& step_;
    Turning<D, double> turn_a_, turn_b_;
    Geometry<D, double> g_;
    DirectRow<D>* next_;
};

}  // namespace

template <bool biased, int D>
JointArms<D> lay_rows(const DirectJoint<D>& joint, const Motion<D, double>& a, const Motion<D, double>& b,
                      const JointStep<double>& step, std::span<DirectRow<D>> rows) {
    return RowLayer<biased, D>(joint, a, b, step, rows).lay();
}

template <int D>
DriveLaw drive_law(const DirectJoint<D>& joint, int drive, double coordinate, const JointStep<double>& step) {
    const DriveBase<D, float>& base = joint.drives[static_cast<std::size_t>(drive)];
    DriveLaw law;
    law.two_way = !(base.high > base.low);
    law.has_limits = base.low > -2e17f || base.high < 2e17f;
    law.low = -std::max(coordinate - base.low, 0.0) * step.inverse_h;
    law.high = std::max(base.high - coordinate, 0.0) * step.inverse_h;
    law.motor_speed = base.motor_speed;
    law.motor_most = base.motor_most;
    const SpringRow<double> spring = widen(base.spring);
    if (spring.keep > 0) {
        law.softness = (1 - spring.keep) / spring.keep;
        law.spring_speed = -joint.offset[static_cast<std::size_t>(joint.first_drive() + drive)];
        law.spring_most = spring.most;
    }
    return law;
}

/// Where the law of spring and motor, which pushes with `motor`, meets the line along which the speed changes
/// by `slope` for an impulse.
DriveLaw::Point DriveLaw::with_spring(double motor, double speed, double impulse, double slope,
                                      double alone) const {
    if (softness == 0) return {speed + slope * (motor - impulse), {false, 0, 0, motor}};
    const double soft = softness * alone;
    const double at = (speed + slope * (spring_speed / soft + motor - impulse)) / (1 + slope / soft);
    const double force = (spring_speed - at) / soft;
    if (std::fabs(force) <= spring_most) return {at, {true, softness, spring_speed, motor}};
    const double given = motor + std::copysign(spring_most, force);
    return {speed + slope * (given - impulse), {false, 0, 0, given}};
}

/// Any slope finds the piece in the end. With a steep one a motor that has to let go or turn round tries
/// first whether it holds; with a flat one a limit takes hold only where the speed itself leaves its range,
/// and not where the impulse of another piece would throw a joint that stood alone.
RowLaw DriveLaw::piece_at(double speed, double impulse, double compliance, double alone) const {
    constexpr double steep = 100, flat = 1e-3;
    if (two_way) return {true, 0, 0, 0};
    const auto meet = [&](double motor, double slope) {
        return with_spring(motor, speed, impulse, slope * compliance, alone);
    };
    double motor = motor_most;
    bool sticks = false;
    if (motor_most > 0 && meet(motor_most, steep).speed > motor_speed) {
        motor = -motor_most;
        sticks = meet(motor, steep).speed < motor_speed;
    }
    const Point p = sticks ? Point{motor_speed, {true, 0, motor_speed, 0}} : meet(motor, flat);
    if (has_limits && p.speed < low) return {true, 0, low, 0};
    if (has_limits && p.speed > high) return {true, 0, high, 0};
    return p.law;
}

DriveLaw DriveLaw::let_go() const {
    DriveLaw free = *this;
    free.has_limits = false;
    free.motor_most = 0;
    return free;
}

#define CAROM_INSTANTIATE(D)                                                                     \
    template struct DirectJoint<D>;                                                              \
    template JointArms<D> lay_rows<true, D>(const DirectJoint<D>&, const Motion<D, double>&,     \
                                            const Motion<D, double>&, const JointStep<double>&,  \
                                            std::span<DirectRow<D>>);                            \
    template JointArms<D> lay_rows<false, D>(const DirectJoint<D>&, const Motion<D, double>&,    \
                                             const Motion<D, double>&, const JointStep<double>&, \
                                             std::span<DirectRow<D>>);                           \
    template DriveLaw drive_law(const DirectJoint<D>&, int, double, const JointStep<double>&);
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
