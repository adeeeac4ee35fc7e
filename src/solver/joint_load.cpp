#include "solver/joint_load.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "math/trig.hpp"

namespace carom::detail {

template <int D>
JointPose<D> pose_of(const JointRecord<D>& j, std::span<const BodyState<D>> states,
                     std::span<const BodyMass<D>> masses, bool with_angle) {
    JointPose<D> p;
    const BodyState<D>& b = states[j.body_b];
    p.frame_b = b.rotation * j.frame_b;
    p.arm_b = rotate(b.rotation, j.anchor_b - masses[j.body_b].center);
    p.velocity_b = b.velocity;
    p.spin_b = b.angular_velocity;
    if (j.body_a == no_body) {
        p.frame_a = j.frame_a;
        p.gap = (b.position - j.anchor_a) + p.arm_b;
    } else {
        const BodyState<D>& a = states[j.body_a];
        p.frame_a = a.rotation * j.frame_a;
        p.arm_a = rotate(a.rotation, j.anchor_a - masses[j.body_a].center);
        p.gap = (b.position - a.position) + (p.arm_b - p.arm_a);
        p.velocity_a = a.velocity;
        p.spin_a = a.angular_velocity;
    }
    if constexpr (D == 2) {
        if (with_angle) p.angle = whole_angle(b) - (j.body_a == no_body ? 0 : whole_angle(states[j.body_a]));
    }
    return p;
}

namespace {

/// The angle that differs from `angle` by whole turns and is nearest to `before`.
double unwound(double angle, double before) {
    return angle + 2 * pi * std::floor((before - angle) / (2 * pi) + 0.5);
}

/// A component of the rotation vector θ, of which the rate is (1 − ½ θ× + c θ×²) ω, with c = (1 − ½ |θ| cot
/// ½ |θ|) / |θ|².
Measured<3> measure_turn_vector(const DriveSettings& drive, const JointPose<3>& pose) {
    const int i = static_cast<int>(drive.measure) - static_cast<int>(Measure::turn_x);
    const Vec3 turn = turn_between<3>(pose), axis = pose.axis_a(i);
    const double part = dot(turn, axis), squared = dot(turn, turn);
    double c = 1.0 / 12;
    if (squared > 1e-6) {
        const auto [sine, cosine] = sin_cos(0.5 * std::sqrt(squared));
        c = (1 - 0.5 * std::sqrt(squared) * cosine / sine) / squared;
    }
    return {axis + 0.5 * cross(turn, axis) + c * (part * turn - squared * axis),
            unwound(part - drive.zero, drive.coordinate), 0};
}

Measured<3> measure_turn(const DriveSettings& drive, const JointPose<3>& pose) {
    const Vec3 xa = pose.axis_a(0), xb = pose.axis_b(0);
    switch (drive.measure) {
        case Measure::twist: {
            // The turn about the axis that is left when the shortest turn that brings one axis to the other
            // is taken away. It changes by the spin along the sum of the axes (P. Dobrowolski 2015).
            const Rotation3 q = inverse(pose.frame_a) * pose.frame_b;
            const double angle = q.x == 0 && q.w == 0 ? 0 : 2 * atan2(q.x, q.w);
            const double share = 1 / std::max(1 + dot(xa, xb), 1e-3);
            return {share * (xa + xb), unwound(angle - drive.zero, drive.coordinate), 0};
        }
        case Measure::swing: {
            const Vec3 across = cross(xa, xb);
            const double sine = length(across);
            const Vec3 axis = sine > 1e-6 ? across / sine : pose.axis_a(1);
            return {axis, atan2(sine, dot(xa, xb)), 0};
        }
        case Measure::turn_x:
        case Measure::turn_y:
        case Measure::turn_z:
            return measure_turn_vector(drive, pose);
        case Measure::steer: {
            const Vec3 yb = pose.axis_b(1);
            return {xa, atan2(dot(yb, pose.axis_a(2)), dot(yb, pose.axis_a(1))) - drive.zero, 0};
        }
        default: {
            const Vec3 yb = pose.axis_b(1);
            const double angle = atan2(dot(cross(xa, xb), yb), dot(xa, xb));
            return {yb, unwound(angle - drive.zero, drive.coordinate), 0};
        }
    }
}

}  // namespace

template <int D>
Measured<D> measure(const DriveSettings& drive, const JointPose<D>& pose) {
    Measured<D> m;
    if (kind_of(drive.measure) == DriveKind::slide) {
        m.axis = pose.axis_a(static_cast<int>(drive.measure) - static_cast<int>(Measure::along));
        m.value = dot(m.axis, pose.gap) - drive.zero;
        m.speed = dot(m.axis, pose.speed_along_line());
    } else if (drive.measure == Measure::stretch) {
        m.value = length(pose.gap);
        m.speed = m.value > 1e-6 ? dot(pose.gap, pose.speed()) / m.value : 0;
    } else if constexpr (D == 2) {
        m.value = pose.angle - drive.zero;
        m.speed = pose.spin_b - pose.spin_a;
    } else {
        m = measure_turn(drive, pose);
        m.speed = dot(m.axis, pose.spin_b - pose.spin_a);
    }
    return m;
}

/// A unit of mass on the spring, x'' + 2 ζ ω x' + ω² x = 0, has the solutions e^(s₁ t), e^(s₂ t). The
/// trapezoidal rule turns a solution e^(s t) into one that grows by (1 + s h/2) / (1 − s h/2) a sub-step. So
/// stiffness κ = s₁' s₂' and damping γ = −(s₁' + s₂') with s' = (2/h) (z − 1) / (z + 1), z = e^(s h), make it
/// follow the true solution at any length of the sub-step (the bilinear transform, warped at both poles).
/// What swings too fast for the sub-steps is slowed down to two radians a sub-step.
void prepare_spring(SpringSettings& spring, double h) {
    if (spring.frequency == 0 || spring.substep == h) return;
    spring.substep = h;
    const double zeta = spring.damping_ratio;
    const double wh = std::min(2 * pi * spring.frequency * h, 2.0);
    const double product = exp(-2 * zeta * wh);
    double sum;
    if (zeta < 1) {
        sum = 2 * exp(-zeta * wh) * cos(wh * std::sqrt(1 - zeta * zeta));
    } else {
        const double root = std::sqrt(zeta * zeta - 1);
        sum = exp(-wh / (zeta + root)) + exp(-wh * (zeta + root));
    }
    const double scale = 4 / (product + sum + 1);
    spring.stiffness = scale * (product - sum + 1) / (h * h);
    spring.damping = scale * (1 - product) / h;
}

namespace {

/// A row over the motions of two bodies: force on b (on a the opposite), torques about the centres.
template <int D>
Wrench<D, double> at_points(const Vec<D>& force, const Vec<D>& arm_a, const Vec<D>& arm_b) {
    return {force, cross(arm_a, force), cross(arm_b, force)};
}

/// How much heavier a coordinate is for its spring because the joint's other rows bind the bodies: a rod that
/// hangs from its end turns about that end. From the compliances of the row alone and with the others solved:
/// k / (k − cᵀ K⁻¹ c).
template <int D>
class BoundMass {
  public:
    BoundMass(const JointRecord<D>& joint, std::span<const BodyState<D>> states,
              std::span<const BodyMass<D>> masses) {
        const auto weigh = [&](std::uint32_t body, double& mass, Inertia<D>& inertia) {
            if (body == no_body || masses[body].inverse_mass == 0) return;
            mass = masses[body].inverse_mass;
            inertia = world_inverse_inertia<D>(masses[body], states[body].rotation);
        };
        weigh(joint.body_a, mass_a_, inertia_a_);
        weigh(joint.body_b, mass_b_, inertia_b_);
    }

    void add_row(const Wrench<D, double>& row) { rows_[count_++] = row; }

    double share_of(const Wrench<D, double>& row) const {
        const double alone = compliance(row, row);
        double k[8][9];
        for (int i = 0; i < count_; ++i) {
            for (int j = 0; j < count_; ++j) k[i][j] = compliance(rows_[i], rows_[j]);
            k[i][count_] = compliance(rows_[i], row);
        }
        // The matrix is symmetric and positive, so that elimination needs no pivots; rows that say what
        // others say already drop out.
        double taken = 0;
        for (int i = 0; i < count_; ++i) {
            if (!(k[i][i] > 1e-9 * compliance(rows_[i], rows_[i]))) continue;
            taken += k[i][count_] * k[i][count_] / k[i][i];
            for (int r = i + 1; r < count_; ++r) {
                const double factor = k[r][i] / k[i][i];
                for (int c = i; c <= count_; ++c) k[r][c] -= factor * k[i][c];
            }
        }
        return alone - taken > 1e-6 * alone ? alone / (alone - taken) : 1;
    }

  private:
    double compliance(const Wrench<D, double>& r, const Wrench<D, double>& s) const {
        return (mass_a_ + mass_b_) * dot(r.force, s.force) + angular_dot(r.on_a, inertia_a_ * s.on_a) +
               angular_dot(r.on_b, inertia_b_ * s.on_b);
    }

    double mass_a_ = 0, mass_b_ = 0;
    Inertia<D> inertia_a_{}, inertia_b_{};
    Wrench<D, double> rows_[8];
    int count_ = 0;
};

/// A drive as a row.
template <int D>
Wrench<D, double> row_of(DriveKind kind, const Vec<D>& axis, const JointPose<D>& pose) {
    if (kind == DriveKind::slide) return at_points<D>(axis, pose.arm_a + pose.gap, pose.arm_b);
    if (kind == DriveKind::stretch) {
        const double size = length(pose.gap);
        return at_points<D>(size > 1e-6 ? pose.gap / size : Vec<D>{}, pose.arm_a, pose.arm_b);
    }
    if constexpr (D == 2)
        return {{}, 1, 1};
    else
        return {{}, axis, axis};
}

/// The spring of a drive among the joint's rows.
template <int D>
double bound_share(const JointRecord<D>& joint, const JointPose<D>& pose, const DriveSettings& drive,
                   const Vec<D>& axis, std::span<const BodyState<D>> states,
                   std::span<const BodyMass<D>> masses) {
    const Layout& L = layouts<D>[joint.layout];
    const DriveKind kind = kind_of(drive.measure);
    BoundMass<D> mass(joint, states, masses);
    const Vec<D> arm_on_line = pose.arm_a + pose.gap;
    for (const DriveSettings& other : joint.drives) {
        if (&other == &drive || !(other.low == other.high)) continue;
        mass.add_row(row_of<D>(kind_of(other.measure), measure(other, pose).axis, pose));
    }
    for (int i = 0; i < D; ++i) {
        Vec<D> unit{};
        unit[i] = 1;
        if (L.linear == LinearPart::point) mass.add_row(at_points<D>(unit, pose.arm_a, pose.arm_b));
        if (L.linear == LinearPart::line && i > 0)
            mass.add_row(at_points<D>(pose.axis_a(i), arm_on_line, pose.arm_b));
    }
    if constexpr (D == 2) {
        if (L.angular == AngularPart::locked) mass.add_row({{}, 1, 1});
    } else {
        for (int i = 0; i < 3; ++i) {
            const bool bound =
                L.angular == AngularPart::locked || (L.angular == AngularPart::across && i > 0);
            if (bound) mass.add_row({{}, pose.axis_a(i), pose.axis_a(i)});
        }
        if (L.angular == AngularPart::square) {
            const Vec3 n = cross(pose.axis_b(1), pose.axis_a(0));
            mass.add_row({{}, n, n});
        }
    }
    return kind == DriveKind::stretch ? 1 : mass.share_of(row_of<D>(kind, axis, pose));
}

}  // namespace

/// With stiffness κ and damping γ a unit of mass, and g = κ h/4 + γ/2, the impulse −h m (κ C + g (s + s'))
/// for the stretch C and the speeds s and s' at the start and the end comes out of a row with the mass m /
/// share.
SpringRow<float> spring_row(SpringSettings& spring, double h, double share) {
    if (spring.frequency == 0) return {};
    prepare_spring(spring, h);
    const double push = h * share * (0.25 * h * spring.stiffness + 0.5 * spring.damping);
    return {static_cast<float>(h * share * spring.stiffness / (1 + push)),
            static_cast<float>(push / (1 + push)), static_cast<float>(std::min(spring.most * h, 1e37))};
}

namespace {

float limited(double value) { return static_cast<float>(std::clamp(value, -1e18, 1e18)); }

}  // namespace

template <int D>
Angular<D> turn_between(const JointPose<D>& pose) {
    if constexpr (D == 2) {
        const Rotation2 q = inverse(pose.frame_a) * pose.frame_b;
        return q.angle();
    } else {
        // As a rotation vector: the axis of the quaternion with the whole angle as length.
        const Rotation3 q = pose.frame_b * inverse(pose.frame_a);
        const double sign = q.w < 0 ? -1 : 1;
        const Vec3 v = sign * Vec3{q.x, q.y, q.z};
        const double sine = length(v);
        return (sine > 1e-9 ? 2 * atan2(sine, sign * q.w) / sine : 2.0) * v;
    }
}

namespace {

/// Brings the limit of a ratchet to the last tooth that has passed.
void follow(DriveSettings& drive) {
    if (drive.pawl == Pawl::none) return;
    const double sign = drive.pawl == Pawl::holds_below ? 1 : -1;
    const double way = sign * drive.coordinate;
    const double held = sign * (drive.pitch > 0 ? drive.pitch * std::floor(way / drive.pitch) : way);
    if (drive.pawl == Pawl::holds_below)
        drive.low = std::max(drive.low, held);
    else
        drive.high = std::min(drive.high, held);
}

}  // namespace

template <int D>
DriveBase<D, float> drive_row(DriveSettings& drive, const JointRecord<D>& joint, const JointPose<D>& pose,
                              std::span<const BodyState<D>> states, std::span<const BodyMass<D>> masses,
                              double h) {
    const DriveKind kind = kind_of(drive.measure);
    const Measured<D> now = measure(drive, pose);
    DriveBase<D, float> row;
    drive.coordinate = now.value;
    follow(drive);
    row.axis = narrow<float>(now.axis);
    // After many turns an angle is too large for a float; what is left to the limits is not.
    const double start = kind == DriveKind::turn ? now.value : kind == DriveKind::slide ? -drive.zero : 0;
    row.low = limited(drive.low - start);
    row.high = limited(drive.high - start);
    if (drive.spring.frequency != 0) {
        const double share = bound_share<D>(joint, pose, drive, now.axis, states, masses);
        row.spring = spring_row(drive.spring, h, share);
        row.rest = static_cast<float>(drive.spring.rest - start);
    }
    row.before = static_cast<float>(now.speed);
    row.motor_speed = static_cast<float>(drive.motor_speed);
    row.motor_most = static_cast<float>(std::min(drive.motor_most * h, 1e37));
    return row;
}

namespace {

template <int D, Layout L>
struct Load {
    using Rows = JointRows<D, float, L>;
    static constexpr std::size_t fields = sizeof(Rows) / sizeof(float);
    static constexpr std::size_t kept = sizeof(Rows::kept) / sizeof(float);
    static_assert(kept <= most_kept && sizeof(Rows) % sizeof(float) == 0);

    static constexpr std::size_t of_wrench = sizeof(Wrench<D, float>) / sizeof(float);
    static constexpr std::size_t taken = kept + 2 * of_wrench;

    static void take(const JointRecord<D>& joint, float* to, std::size_t stride) {
        Rows rows;
        std::memcpy(static_cast<void*>(&rows.kept), joint.kept.data(), kept * sizeof(float));
        rows.wrench = joint.wrench;
        rows.before = joint.before;
        std::array<float, fields> all;
        std::memcpy(all.data(), &rows, sizeof rows);
        for (std::size_t f = 0; f < taken; ++f) to[f * stride] = all[f];
    }

    static void load(JointRecord<D>& joint, const JointPose<D>& pose, std::span<const BodyState<D>> states,
                     std::span<const BodyMass<D>> masses, double h, float* to, std::size_t stride) {
        Rows rows;
        if constexpr (has_anchors(L))
            rows.anchors = {narrow<float>(pose.arm_a), narrow<float>(pose.arm_b), narrow<float>(pose.gap)};
        set_linear(rows, joint, pose, h);
        set_angular(rows, joint, pose, h);
        if constexpr (L.drive_count > 0) {
            for (int i = 0; i < L.drive_count; ++i)
                rows.drives[i] = drive_row<D>(joint.drives[i], joint, pose, states, masses, h);
        }
        std::array<float, fields> all;
        std::memcpy(all.data(), &rows, sizeof rows);
        // The first sub-step counts the impulses that are kept, which belong to the step before.
        for (std::size_t f = 0; f < of_wrench; ++f) all[taken + f] = -to[(kept + f) * stride];
        for (std::size_t f = taken; f < fields; ++f) to[f * stride] = all[f];
    }

    static void store(JointRecord<D>& joint, const float* from, std::size_t stride) {
        std::array<float, fields> all{};
        for (std::size_t f = 0; f < taken + of_wrench; ++f) all[f] = from[f * stride];
        Rows rows;
        std::memcpy(static_cast<void*>(&rows), all.data(), sizeof rows);
        std::memcpy(joint.kept.data(), &rows.kept, kept * sizeof(float));
        joint.wrench = rows.wrench;
        joint.before = rows.before;
        joint.total = {rows.total.force + rows.wrench.force, rows.total.on_a + rows.wrench.on_a,
                       rows.total.on_b + rows.wrench.on_b};
    }

  private:
    static void set_linear(Rows& rows, JointRecord<D>& joint, const JointPose<D>& pose, double h) {
        if constexpr (L.linear == LinearPart::line) {
            for (int i = 1; i < D; ++i) rows.linear.across[i - 1] = narrow<float>(pose.axis_a(i));
        } else if constexpr (L.linear == LinearPart::held) {
            rows.linear.spring = spring_row(joint.held.linear, h, 1);
            rows.linear.before = narrow<float>(pose.speed());
        }
    }

    static void set_angular(Rows& rows, JointRecord<D>& joint, const JointPose<D>& pose, double h) {
        if constexpr (L.angular == AngularPart::locked) {
            rows.angular.turn = narrow<float>(turn_between<D>(pose));
        } else if constexpr (L.angular == AngularPart::across) {
            rows.angular = {narrow<float>(pose.axis_a(0)), narrow<float>(pose.axis_b(0))};
        } else if constexpr (L.angular == AngularPart::square) {
            rows.angular = {narrow<float>(pose.axis_a(0)), narrow<float>(pose.axis_b(1))};
        } else if constexpr (L.angular == AngularPart::held) {
            rows.angular.turn = narrow<float>(turn_between<D>(pose));
            rows.angular.spring = spring_row(joint.held.angular, h, 1);
            rows.angular.friction = static_cast<float>(std::min(joint.held.friction * h, 1e37));
            rows.angular.before = narrow<float>(Angular<D>(pose.spin_b - pose.spin_a));
        }
    }
};

template <int D>
double size_of(const Angular<D>& angle) {
    return std::sqrt(angular_dot(angle, angle));
}

template <int D, std::size_t... i>
constexpr std::array<JointLoader<D>, layouts<D>.size()> make_loaders(std::index_sequence<i...>) {
    return {JointLoader<D>{Load<D, layouts<D>[i]>::fields, Load<D, layouts<D>[i]>::take,
                           Load<D, layouts<D>[i]>::load, Load<D, layouts<D>[i]>::store}...};
}

}  // namespace

template <int D>
const std::array<JointLoader<D>, layouts<D>.size()>& joint_loaders() {
    static constexpr auto all = make_loaders<D>(std::make_index_sequence<layouts<D>.size()>());
    return all;
}

template <int D>
JointErrors errors(const JointRecord<D>& joint, const JointPose<D>& pose) {
    const Layout& rows = layouts<D>[joint.layout];
    JointErrors e;
    if (rows.linear == LinearPart::point) e.linear = length(pose.gap);
    if (rows.linear == LinearPart::line) {
        const Vec<D> axis = pose.axis_a(0);
        e.linear = length(pose.gap - dot(pose.gap, axis) * axis);
    }
    if (rows.angular == AngularPart::locked) e.angular = size_of<D>(turn_between<D>(pose));
    if constexpr (D == 3) {
        if (rows.angular == AngularPart::across) e.angular = length(cross(pose.axis_a(0), pose.axis_b(0)));
        if (rows.angular == AngularPart::square) e.angular = std::fabs(dot(pose.axis_a(0), pose.axis_b(1)));
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows.drive_count); ++i) {
        const DriveSettings& drive = joint.drives[i];
        const double value = measure(drive, pose).value;
        const double beyond = std::max({drive.low - value, value - drive.high, 0.0});
        double& error = kind_of(drive.measure) == DriveKind::turn ? e.angular : e.linear;
        error = std::max(error, beyond);
    }
    return e;
}

#define CAROM_INSTANTIATE(D)                                                                            \
    template JointPose<D> pose_of(const JointRecord<D>&, std::span<const BodyState<D>>,                 \
                                  std::span<const BodyMass<D>>, bool);                                  \
    template Measured<D> measure(const DriveSettings&, const JointPose<D>&);                            \
    template JointErrors errors(const JointRecord<D>&, const JointPose<D>&);                            \
    template Angular<D> turn_between<D>(const JointPose<D>&);                                           \
    template DriveBase<D, float> drive_row(DriveSettings&, const JointRecord<D>&, const JointPose<D>&,  \
                                           std::span<const BodyState<D>>, std::span<const BodyMass<D>>, \
                                           double);                                                     \
    template const std::array<JointLoader<D>, layouts<D>.size()>& joint_loaders<D>();
CAROM_INSTANTIATE(2)
CAROM_INSTANTIATE(3)
#undef CAROM_INSTANTIATE

}  // namespace carom::detail
