#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Rotation in space that no torque disturbs. Spins are given and read along the axes of the body.

namespace carom::app {
namespace {

constexpr double short_step = 1.0 / 240;

/// One body of 1 kg that spins in empty space; its axes and the world's agree at the start.
class Spinner {
  public:
    Spinner(const Geometry<3>& shape, const std::optional<Vec3>& moments, const Vec3& spin) {
        world_.set_gravity({});
        BodyDefinition3 body;
        body.mass = 1;
        if (moments) body.inertia = Symmetric3<double>{moments->x, moments->y, moments->z};
        body.shapes.push_back({shape});
        body.angular_velocity = spin;
        id_ = world_.add_body(body);
        energy_ = energy();
        momentum_ = momentum();
    }

    void step(double h) {
        world_.step(h);
        worst_energy_ = std::max(worst_energy_, std::fabs(energy() / energy_ - 1));
        worst_momentum_ = std::max(worst_momentum_, length(momentum() - momentum_) / length(momentum_));
    }
    void run_until(double end, double h) {
        while (time() < end - 0.5 * h) step(h);
    }

    double time() const { return world_.time(); }
    Rotation3 rotation() const { return world_.rotation(id_); }
    Vec3 spin() const { return unrotate(rotation(), world_.angular_velocity(id_)); }
    double energy() const { return world_.energy().kinetic; }
    /// Angular momentum along the axes of the world.
    Vec3 momentum() const { return rotate(rotation(), world_.mass_properties(id_).inertia * spin()); }
    double worst_energy() const { return worst_energy_; }      ///< largest |ΔE/E| until now
    double worst_momentum() const { return worst_momentum_; }  ///< largest |ΔL|/|L| until now

  private:
    World3 world_;
    BodyId3 id_;
    double energy_ = 0, worst_energy_ = 0, worst_momentum_ = 0;
    Vec3 momentum_{};
};

/// An angle that is followed over many turns.
class Phase {
  public:
    explicit Phase(double angle) : last_(angle) {}
    void follow(double angle) {
        total_ += std::remainder(angle - last_, 2 * pi);
        last_ = angle;
    }
    double total() const { return total_; }

  private:
    double last_, total_ = 0;
};

/// The angle between two orientations.
double angle_between(const Rotation3& a, const Rotation3& b) {
    const Rotation3 d = inverse(a) * b;
    return 2 * std::asin(std::min(1.0, length(Vec3{d.x, d.y, d.z})));
}

/// The known motion of a symmetric top that spins with (0.5, 0, 3).
struct Top {
    Vec3 moments;
    double body_rate, space_rate, half_angle, period;
};

/// Ten periods of a symmetric top. Its axis goes around the angular momentum L, which stands still, and the
/// spin goes around the axis: the orientation is a turn about the axis and then one about L.
void add_symmetric_top(std::vector<Result>& results, const Top& top) {
    const Vec3 start{0.5, 0, 3}, axis{0, 0, 1};
    Spinner body(Ball{0.5}, top.moments, start);
    const Vec3 along = normalized(body.momentum());
    const Vec3 across = normalized(cross(along, axis)), third = cross(along, across);
    const auto azimuth = [&] {
        const Vec3 a = rotate(body.rotation(), axis);
        return std::atan2(dot(a, third), dot(a, across));
    };
    const auto half_angle = [&] { return std::acos(dot(along, rotate(body.rotation(), axis))); };

    Phase in_body(0), in_space(azimuth());
    double worst_angle = 0;
    while (body.time() < 10 * top.period) {
        body.step(short_step);
        in_body.follow(std::atan2(body.spin().y, body.spin().x));
        in_space.follow(azimuth());
        worst_angle = std::max(worst_angle, std::fabs(half_angle() / (top.half_angle * degree) - 1));
    }
    const double t = body.time();
    const Rotation3 truth = Rotation3::from_axis_angle(along, top.space_rate * t) *
                            Rotation3::from_axis_angle(axis, -top.body_rate * t);

    const std::string what =
        fmt::format("3D, I = ({:g}, {:g}, {:g}): ", top.moments.x, top.moments.y, top.moments.z);
    constexpr Bounds bounds{1e-2, 1e-4}, drift{1e-2, 1e-6};
    results.push_back(relative(what + "body precession (rad/s)", top.body_rate, in_body.total() / t, bounds));
    results.push_back(
        relative(what + "space precession (rad/s)", top.space_rate, in_space.total() / t, bounds));
    results.push_back({what + "half-angle of the axis about L (deg), worst", top.half_angle,
                       half_angle() / degree, worst_angle, bounds});
    results.push_back(absolute(what + "turned away from the true place after 10 periods (rad)", 0,
                               angle_between(body.rotation(), truth), bounds));
    results.push_back(absolute(what + "max |ΔE/E|", 0, body.worst_energy(), drift));
    results.push_back(absolute(what + "max |ΔL|/|L|", 0, body.worst_momentum(), drift));
}

constexpr Bounds flip_bounds{1e-2, 1e-4}, energy_bounds{1e-2, 1e-5};

/// Round-off: a unit of rounding a step.
Bounds momentum_bounds(double steps) { return {1e-2, steps * std::numeric_limits<double>::epsilon()}; }

/// A body that spins about its middle axis turns over; that is when the third component of its spin, which
/// grew in the meantime, comes back to zero.
void add_flips(std::vector<Result>& results, double disturbance, std::optional<double> period, double flip) {
    Spinner body(Ball{0.5}, Vec3{1, 2, 3}, {disturbance, 1, 0});
    std::vector<double> crossings;
    Vec3 at_flip{};
    double before = 0;
    for (body.step(short_step); body.time() < 100;) {
        before = body.spin().z;
        body.step(short_step);
        const double now = body.spin().z;
        if ((before < 0) == (now < 0)) continue;
        crossings.push_back(body.time() - short_step * now / (now - before));
        if (crossings.size() == 1) at_flip = body.spin();
    }
    crossings.resize(2, 0.0);  // 0 s stands for a flip that never came
    const std::string what = fmt::format("3D, I = (1, 2, 3), ω = ({:g}, 1, 0): ", disturbance);
    results.push_back(relative(what + "flip (s)", flip, crossings[0], flip_bounds));
    if (period) results.push_back(relative(what + "full period (s)", *period, crossings[1], flip_bounds));
    results.push_back(relative(what + "middle spin at the flip (rad/s)", -1, at_flip.y, flip_bounds));
    results.push_back(absolute(what + "max |ΔE/E| in 100 s", 0, body.worst_energy(), energy_bounds));
    results.push_back(absolute(what + "max |ΔL|/|L| in 100 s", 0, body.worst_momentum(),
                               momentum_bounds(100 / short_step)));
}

/// A box of half extents (0.1, 0.2, 0.3).
void add_box(std::vector<Result>& results, double h, std::string_view name) {
    Spinner body(Box3{{0.2, 0.4, 0.6}}, {}, {1, 2, 3});
    const std::string what = fmt::format("3D, box, h = {}: ", name);
    if (h == frame) {
        results.push_back(relative("3D, box: energy (J)", 0.163333333, body.energy(), {1e-2, 1e-8}));
        results.push_back(
            relative("3D, box: |L| (N m s)", 0.093926685, length(body.momentum()), {1e-2, 1e-8}));
    }
    const auto add_spin = [&](double t, const Vec3& truth) {
        body.run_until(t, h);
        const Vec3 w = body.spin();
        results.push_back({fmt::format("{}spin at {:g} s, 2nd component (rad/s)", what, t), truth.y, w.y,
                           length(w - truth) / length(truth), flip_bounds});
    };
    add_spin(1, {1.086100443, -1.904311561, 3.046341758});
    add_spin(5, {0.280861941, -2.432266940, 2.750101480});
    body.run_until(100, h);
    results.push_back(absolute(what + "max |ΔE/E| in 100 s", 0, body.worst_energy(), energy_bounds));
    results.push_back(
        absolute(what + "max |ΔL|/|L| in 100 s", 0, body.worst_momentum(), momentum_bounds(100 / h)));
}

}  // namespace

std::vector<Result> symmetric_top() {
    std::vector<Result> results;
    add_symmetric_top(results, {{2, 2, 1}, -1.5, 1.581138830, 18.434948823, 3.973835306});
    add_symmetric_top(results, {{1, 1, 1.8}, 2.4, 5.423098745, 5.290081205, 1.158596884});
    return results;
}

std::vector<Result> tennis_racket() {
    std::vector<Result> results;
    add_flips(results, 0.01, 41.509219529, 20.754609765);
    add_flips(results, 0.001, {}, 28.731424437);
    add_box(results, frame, "1/60");
    add_box(results, short_step, "1/240");
    return results;
}

}  // namespace carom::app
