#include "io/scene_check_joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace carom::io {
namespace {

constexpr double most_angle = 13;        // rad: two turns; limits beyond are hardly in radians
constexpr double most_mass_ratio = 100;  // where joints are solved one after the other
constexpr double least_swing_steps = 4;  // sub-steps within which a spring may swing once
constexpr double outside_by = 1e-3;      // rad or m
constexpr int outside = -1;              // the world, as the body of a joint

/// In how many ways a body can move, and how many of them a joint between two takes away.
template <int D>
constexpr int ways = D == 2 ? 3 : 6;

template <int D>
int held_by(const decltype(JointDefinition<D>::kind)& kind) {
    const auto visit = [](const auto& joint) {
        using Joint = std::decay_t<decltype(joint)>;
        if constexpr (std::is_same_v<Joint, HingeJoint<D>> || std::is_same_v<Joint, SliderJoint<D>>)
            return ways<D> - 1;
        else if constexpr (std::is_same_v<Joint, BallJoint<D>>)
            return D;
        else if constexpr (std::is_same_v<Joint, WeldJoint<D>>)
            return joint.spring || joint.angular_spring ? 0 : ways<D>;
        else if constexpr (std::is_same_v<Joint, DistanceJoint<D>>)
            return joint.limits || joint.spring || joint.motor ? 0 : 1;
        else if constexpr (std::is_same_v<Joint, WheelJoint<D>>)
            return D == 2 ? 1 : 4;  // it travels, turns and is steered
        else if constexpr (std::is_same_v<Joint, ParallelJoint<D>>)
            return D == 2 && joint.spring ? 0 : D - 1;
        else
            return 0;  // motors, targets and ropes give way; gears and racks name joints
    };
    return std::visit(visit, kind);
}

/// The parts that several kinds of joint have, or null.
template <class Joint>
const std::optional<JointLimits>* limits_of(const Joint& joint) {
    if constexpr (requires { joint.limits; })
        return &joint.limits;
    else
        return nullptr;
}
template <class Joint>
const std::optional<JointSpring>* spring_of(const Joint& joint) {
    if constexpr (requires { joint.spring; })
        return &joint.spring;
    else
        return nullptr;
}
template <class Joint>
const std::optional<JointMotor>* motor_of(const Joint& joint) {
    if constexpr (requires { joint.motor; })
        return &joint.motor;
    else
        return nullptr;
}

template <int D>
class JointChecker {
  public:
    JointChecker(const Scene& scene, const SceneWorld<D>& built, std::vector<Suspicion>& found)
        : scene_(scene), data_(std::get<SceneData<D>>(scene.data)), built_(built), found_(found) {}

    void check() {
        for (std::size_t i = 0; i < data_.joints.size(); ++i) {
            if (!data_.joints[i].b) continue;  // names joints
            check_masses(i);
            std::visit([&](const auto& joint) { check_parts(i, joint); }, data_.joints[i].kind);
        }
        check_pairs();
        check_groups();
    }

  private:
    void add(std::string place, std::string what) { found_.push_back({std::move(place), std::move(what)}); }

    int body_a(std::size_t joint) const {
        const auto& a = data_.joints[joint].a;
        return a ? static_cast<int>(a->index) : outside;
    }
    int body_b(std::size_t joint) const { return static_cast<int>(data_.joints[joint].b.index); }
    bool moves(int body) const {
        return body != outside && data_.bodies[static_cast<std::size_t>(body)].type == BodyType::dynamic;
    }
    std::string label(int body) const {
        if (body == outside) return "the world";
        const auto index = static_cast<std::size_t>(body);
        return fmt::format("\"{}\"", body_label(data_.bodies[index].name, index));
    }
    double mass(int body) const {
        return built_.world.mass_properties(built_.bodies[static_cast<std::size_t>(body)]).mass;
    }

    void check_masses(std::size_t i) {
        const int a = body_a(i), b = body_b(i);
        if (data_.world.joints != JointMethod::iterative || !moves(a) || !moves(b)) return;
        const double ratio = std::max(mass(a), mass(b)) / std::min(mass(a), mass(b));
        if (ratio > most_mass_ratio)
            add(fmt::format("joints[{}]", i),
                fmt::format("of {} and {} one is {:.0f} times heavier, and joints are solved one after the "
                            "other: they will stretch; take the joint method \"automatic\" or \"direct\"",
                            label(a), label(b), ratio));
    }

    template <class Joint>
    void check_parts(std::size_t i, const Joint& joint) {
        constexpr bool turns = std::is_same_v<Joint, HingeJoint<D>>;
        if (const auto* limits = limits_of(joint); limits && *limits) check_limits(i, **limits, turns);
        if (const auto* motor = motor_of(joint); motor && *motor) check_motor(i, **motor, turns);
        if (const auto* spring = spring_of(joint); spring && *spring)
            check_frequency(fmt::format("joints[{}].spring.frequency", i), (*spring)->frequency);
    }

    void check_limits(std::size_t i, const JointLimits& limits, bool angle) {
        const std::string place = fmt::format("joints[{}].limits", i);
        const auto finite_part = [](double x) { return std::isfinite(x) ? std::fabs(x) : 0; };
        const double widest = std::max(finite_part(limits.low), finite_part(limits.high));
        if (angle && widest > most_angle)
            return add(place,
                       fmt::format("{:g} rad is more than two turns; are the limits in radians?", widest));
        const double now = built_.world.coordinate(built_.joints[i]);
        if (now < limits.low - outside_by || now > limits.high + outside_by)
            add(place,
                fmt::format("the joint starts at {:.3g}, outside of its limits {:.3g} … {:.3g}, and will "
                            "snap into them; place the bodies within, or widen the limits",
                            now, limits.low, limits.high));
    }

    void check_motor(std::size_t i, const JointMotor& motor, bool angle) {
        if (motor.target) {
            check_frequency(fmt::format("joints[{}].motor.frequency", i), motor.frequency);
        } else if (const double turn = std::fabs(motor.speed) * scene_.step; angle && turn > 1) {
            add(fmt::format("joints[{}].motor.speed", i),
                fmt::format("{:g} rad/s is {:.3g} rad a step; is it in radians a second?", motor.speed,
                            turn));
        }
        if (motor.max == 0)
            add(fmt::format("joints[{}].motor.max", i), "a motor of no strength has no effect; leave it out");
    }

    /// A spring of a joint is solved implicitly, which is stable but damps what it cannot follow.
    void check_frequency(std::string place, double frequency) {
        const double fastest = data_.world.substeps / (least_swing_steps * scene_.step);
        if (frequency > fastest)
            add(std::move(place),
                fmt::format("{:g} Hz is more than the sub-steps can follow, and will act as a "
                            "damped, stiff joint; stay below {:.3g} Hz, or take more "
                            "sub-steps",
                            frequency, fastest));
    }

    /// Several joints between the same two bodies that hold more than there is to be held.
    void check_pairs() {
        std::map<std::pair<int, int>, std::pair<int, int>> held;  // how much, by how many
        for (std::size_t i = 0; i < data_.joints.size(); ++i) {
            const int rows = held_by<D>(data_.joints[i].kind);
            if (!data_.joints[i].b || rows == 0) continue;
            auto& [sum, count] = held[std::minmax(body_a(i), body_b(i))];
            sum += rows;
            ++count;
            if (count < 2 || sum <= ways<D>) continue;
            pairs_redundant_ = true;
            add(fmt::format("joints[{}]", i),
                fmt::format(
                    "the {} joints between {} and {} hold {} ways to move of {}: they are redundant, and "
                    "how they share the load is left to chance; leave this one out, or make it {}",
                    count, label(body_a(i)), label(body_b(i)), sum, ways<D>,
                    D == 2 ? "a distance joint" : "a ball or distance joint"));
        }
    }

    std::size_t root(std::size_t body) {
        while (group_[body] != body) body = group_[body] = group_[group_[body]];
        return body;
    }

    /// Bodies that hang together and are held in more ways than they have: loops that are overdetermined.
    void check_groups() {
        if (pairs_redundant_) return;
        group_.resize(data_.bodies.size());
        std::iota(group_.begin(), group_.end(), std::size_t{0});
        for (std::size_t i = 0; i < data_.joints.size(); ++i)
            if (data_.joints[i].b && moves(body_a(i)) && moves(body_b(i)))
                group_[root(static_cast<std::size_t>(body_a(i)))] = root(static_cast<std::size_t>(body_b(i)));
        std::map<std::size_t, int> freedom;
        for (std::size_t i = 0; i < data_.bodies.size(); ++i) {
            const Locks& l = data_.bodies[i].locks;
            const int locked = D == 2 ? l.x + l.y + l.rz : l.x + l.y + l.z + l.rx + l.ry + l.rz;
            if (moves(static_cast<int>(i))) freedom[root(i)] += ways<D> - locked;
        }
        for (std::size_t i = 0; i < data_.joints.size(); ++i) {
            const int body = data_.joints[i].b ? (moves(body_b(i)) ? body_b(i) : body_a(i)) : outside;
            if (!moves(body)) continue;
            int& left = freedom[root(static_cast<std::size_t>(body))];
            const bool was_free = left >= 0;
            left -= held_by<D>(data_.joints[i].kind);
            if (was_free && left < 0)
                add(fmt::format("joints[{}]", i),
                    fmt::format(
                        "with this joint, the bodies that hang together with {} are held in more ways "
                        "than they can move: the loop is redundant, and what is off by a hair will be "
                        "forced; give one joint more freedom (a ball for a hinge, a distance for a ball)",
                        label(body)));
        }
    }

    const Scene& scene_;
    const SceneData<D>& data_;
    const SceneWorld<D>& built_;
    std::vector<Suspicion>& found_;
    std::vector<std::size_t> group_;
    bool pairs_redundant_ = false;
};

}  // namespace

template <int D>
void check_joints(const Scene& scene, const SceneWorld<D>& built, std::vector<Suspicion>& found) {
    JointChecker<D>(scene, built, found).check();
}

template void check_joints(const Scene&, const SceneWorld<2>&, std::vector<Suspicion>&);
template void check_joints(const Scene&, const SceneWorld<3>&, std::vector<Suspicion>&);

}  // namespace carom::io
