#include "io/scene_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/shape.hpp"
#include "io/scene_check_joints.hpp"

namespace carom::io {
namespace {

// Where the suspicious begins. Sizes are those at which contact tolerances of some millimetres and speeds of
// some metres a second make sense.
constexpr double smallest_size = 0.01, largest_size = 100;  // m
constexpr double strongest_gravity = 50;                    // m/s²
constexpr double longest_step = 0.05;                       // s
constexpr double least_density = 1, most_density = 25'000;  // kg/m³: air, osmium
constexpr double most_mass_ratio = 100;
constexpr double least_overlap = 0.002;  // m
constexpr double overlap_of_size = 0.01;
constexpr double thinnest_size = 0.001;     // m: as thick as what contacts give way by
constexpr double most_friction = 5;         // rubber on rubber has 1 to 2
constexpr double most_acceleration = 1000;  // m/s²

double length_of(double w) { return std::fabs(w); }
double length_of(const Vec3& w) { return length(w); }

template <int D>
class Checker {
  public:
    explicit Checker(const Scene& scene)
        : scene_(scene), data_(std::get<SceneData<D>>(scene.data)), built_(build<D>(scene)) {}

    std::vector<Suspicion> check() {
        check_world();
        for (std::size_t i = 0; i < data_.bodies.size(); ++i) check_body(i);
        check_neighbours();
        for (std::size_t i = 0; i < data_.forces.size(); ++i) check_force(i);
        check_joints<D>(scene_, built_, found_);
        return std::move(found_);
    }

  private:
    void add(std::string place, std::string what) { found_.push_back({std::move(place), std::move(what)}); }

    std::string label(std::size_t body) const { return body_label(data_.bodies[body].name, body); }
    double mass(std::size_t body) const { return built_.world.mass_properties(built_.bodies[body]).mass; }
    bool is_dynamic(std::size_t body) const { return data_.bodies[body].type == BodyType::dynamic; }

    /// Lengths of the body's box along its own axes.
    Vec<D> extents(std::size_t body) const {
        Aabb<D> box;
        bool first = true;
        for (const ShapeDefinition<D>& shape : data_.bodies[body].shapes) {
            const Aabb<D> part = detail::bounds(detail::make_shape(shape), Transform<D>{});
            for (int k = 0; k < D; ++k) {
                box.lower[k] = first ? part.lower[k] : std::min(box.lower[k], part.lower[k]);
                box.upper[k] = first ? part.upper[k] : std::max(box.upper[k], part.upper[k]);
            }
            first = false;
        }
        return box.upper - box.lower;
    }

    static std::pair<double, double> least_and_most(const Vec<D>& v) {
        double least = v[0], most = v[0];
        for (int k = 1; k < D; ++k) {
            least = std::min(least, v[k]);
            most = std::max(most, v[k]);
        }
        return {least, most};
    }

    void check_world() {
        if (const double g = length(data_.world.gravity); g > strongest_gravity)
            add("world.gravity",
                fmt::format("{:g} m/s² is {:.0f} times that of the Earth; are lengths in metres?", g,
                            g / 9.81));
        if (data_.world.gravity.y > 0)
            add("world.gravity", fmt::format("{:g} m/s² pulls upwards; y points up here, so give it a minus",
                                             data_.world.gravity.y));
        if (scene_.step > longest_step)
            add("world.step",
                fmt::format("{:g} s is long; contacts want 1/60 s or less; take shorter steps", scene_.step));
    }

    void check_body(std::size_t i) {
        const BodyDefinition<D>& body = data_.bodies[i];
        const std::string place = fmt::format("bodies[{}]", i);
        const bool moves = length(body.velocity) > 0 || length_of(body.angular_velocity) > 0;
        if (body.type == BodyType::fixed && moves) add(place + ".velocity", "has no effect on a fixed body");
        if (!is_dynamic(i) && (body.mass || body.inertia || body.center_of_mass))
            add(place + ".mass", "has no effect: only dynamic bodies have a mass");
        check_materials(i);
        if (!is_dynamic(i) || body.shapes.empty()) return;

        const auto [thinnest, longest] = least_and_most(extents(i));
        if (longest < smallest_size || longest > largest_size)
            add(place,
                fmt::format(
                    "\"{}\" is {:.3g} m long; sizes from {} to {} m simulate best. Are lengths in metres?",
                    label(i), longest, smallest_size, largest_size));
        else if (thinnest < thinnest_size)
            add(place, fmt::format("\"{}\" is {:.3g} m thin, less than contacts give way by: it will sink "
                                   "into others; make it {} m or thicker",
                                   label(i), thinnest, thinnest_size));
        if (const double way = length(body.velocity) * scene_.step; way > thinnest && !body.bullet)
            add(place + ".velocity", fmt::format("\"{}\" moves {:.3g} m a step and is {:.3g} m thin: it may "
                                                 "pass through others; a shorter "
                                                 "step or \"bullet\": true helps",
                                                 label(i), way, thinnest));
        if (const double turn = length_of(body.angular_velocity) * scene_.step; turn > 1)
            add(place + ".angular_velocity",
                fmt::format("\"{}\" turns {:.3g} rad a step; is it in radians a second?", label(i), turn));
        if (const double share = std::max(body.linear_damping, body.angular_damping) * scene_.step; share > 1)
            add(place,
                fmt::format("damping takes {:.0f} % of the speed of \"{}\" in a step, as if it moved in "
                            "tar; is it in 1/s? Air takes less than 1",
                            100 * (1 - std::exp(-share)), label(i)));
        if (D == 3) check_densities(i);
        check_inertia(i);
    }

    void check_materials(std::size_t i) {
        const auto& shapes = data_.bodies[i].shapes;
        for (std::size_t s = 0; s < shapes.size(); ++s)
            if (const double friction = shapes[s].material.friction; friction > most_friction)
                add(fmt::format("bodies[{}].shapes[{}].friction", i, s),
                    fmt::format("{:g} is more than anything has; rubber has 1 to 2", friction));
    }

    /// Moments of inertia that no body of this size, or no body at all, can have.
    void check_inertia(std::size_t i) {
        if (!data_.bodies[i].inertia) return;
        const std::string place = fmt::format("bodies[{}].inertia", i);
        const Vec<D> size = extents(i);
        const double bound = mass(i) * dot(size, size) / 4;  // all of it at the corners of the box
        double largest = 0;
        if constexpr (D == 2) {
            largest = *data_.bodies[i].inertia;
        } else {
            const Symmetric3<double>& m = *data_.bodies[i].inertia;
            largest = std::max({m.xx, m.yy, m.zz});
            if (largest > (m.xx + m.yy + m.zz - largest) * (1 + 1e-6))
                return add(place,
                           "of the three moments one is more than the sum of the others, which no solid "
                           "has; leave it out, and the shapes give it");
        }
        if (largest > bound)
            add(place,
                fmt::format("{:g} kg·m² is more than \"{}\" can have, {:.3g} kg·m² at its mass and size; "
                            "leave it out, and the shapes give it",
                            largest, label(i), bound));
    }

    void check_densities(std::size_t i) {
        const auto& shapes = data_.bodies[i].shapes;
        if (data_.bodies[i].mass) {
            double volume = 0;
            for (const ShapeDefinition<D>& shape : shapes) volume += measure<D>(shape.geometry);
            if (const double density = mass(i) / volume; density < least_density || density > most_density)
                add(fmt::format("bodies[{}].mass", i),
                    fmt::format("\"{}\" would have {:.3g} kg/m³, as no solid has; is the mass in kilograms?",
                                label(i), density));
            return;
        }
        for (std::size_t s = 0; s < shapes.size(); ++s)
            if (const double density = shapes[s].material.density;
                density < least_density || density > most_density)
                add(fmt::format("bodies[{}].shapes[{}]", i, s),
                    fmt::format("a density of {:g} kg/m³ is that of no solid; is it in kg/m³?", density));
    }

    /// What touches at the start: the contacts after a step too short for anything to move.
    void check_neighbours() {
        constexpr double instant = 1e-9;
        Scene still = scene_;
        auto& data = std::get<SceneData<D>>(still.data);
        data.forces.clear();
        data.world.gravity = {};
        for (BodyDefinition<D>& body : data.bodies) {
            body.velocity = {};
            body.angular_velocity = {};
        }
        SceneWorld<D> at_start = build<D>(still);
        at_start.world.step(instant);

        std::vector<std::size_t> index_of;
        for (std::size_t i = 0; i < at_start.bodies.size(); ++i) {
            const std::size_t slot = at_start.bodies[i].index;
            if (slot >= index_of.size()) index_of.resize(slot + 1);
            index_of[slot] = i;
        }
        for (const Contact<D>& contact : at_start.world.contacts()) {
            const auto [a, b] = std::minmax(index_of[contact.body_a.index], index_of[contact.body_b.index]);
            check_overlap(a, b, contact);
            check_mass_ratio(a, b);
        }
    }

    void check_overlap(std::size_t a, std::size_t b, const Contact<D>& contact) {
        double depth = 0;
        for (int k = 0; k < contact.count; ++k)
            depth = std::max(depth, -contact.points[static_cast<std::size_t>(k)].separation);
        double size = largest_size;
        for (const std::size_t body : {a, b})
            if (is_dynamic(body)) size = std::min(size, least_and_most(extents(body)).first);
        if (depth > std::max(least_overlap, overlap_of_size * size))
            add(fmt::format("bodies[{}]", b),
                fmt::format(
                    "\"{}\" begins {:.3g} m deep inside \"{}\", and will be pushed out; move it by as "
                    "much",
                    label(b), depth, label(a)));
    }

    void check_mass_ratio(std::size_t a, std::size_t b) {
        if (!is_dynamic(a) || !is_dynamic(b)) return;
        if (mass(a) < mass(b)) std::swap(a, b);
        if (const double ratio = mass(a) / mass(b); ratio > most_mass_ratio)
            add(fmt::format("bodies[{}]", a),
                fmt::format("\"{}\" ({:.3g} kg) touches \"{}\" ({:.3g} kg), "
                            "{:.0f} times lighter: stacks of such bodies "
                            "are soft; make them more alike, or take more sub-steps",
                            label(a), mass(a), label(b), mass(b), ratio));
    }

    void check_force(std::size_t i) {
        const std::string place = fmt::format("forces[{}]", i);
        const auto check_pushed = [&](std::size_t body, const char* key) {
            if (!is_dynamic(body))
                add(place + "." + key, fmt::format("\"{}\" is not dynamic: no force moves it", label(body)));
        };
        const auto visit = [&](const auto& force) {
            using Force = std::decay_t<decltype(force)>;
            if constexpr (std::is_same_v<Force, ConstantForce<D>> || std::is_same_v<Force, TimedImpulse<D>>)
                check_strength(place, force);
            if constexpr (std::is_same_v<Force, Spring<D>>)
                check_spring(place, force);
            else if constexpr (std::is_same_v<Force, Buoyancy<D>>)
                check_water(place, force);
            else if constexpr (std::is_same_v<Force, Drag<D>>) {
                if (force.body) check_pushed(force.body->index, "body");
            } else if constexpr (requires { force.body; })
                check_pushed(force.body.index, "body");
        };
        std::visit(visit, data_.forces[i].kind);
    }

    void check_strength(const std::string& place, const ConstantForce<D>& force) {
        const std::size_t body = force.body.index;
        if (!is_dynamic(body)) return;
        if (const double a = length(force.value) / mass(body); a > most_acceleration)
            add(place + ".value",
                fmt::format("{:.3g} N on {:.3g} kg is {:.0f} times the weight of \"{}\"; is it in "
                            "newtons?",
                            length(force.value), mass(body), a / 9.81, label(body)));
    }
    void check_strength(const std::string& place, const TimedImpulse<D>& blow) {
        const std::size_t body = blow.body.index;
        if (!is_dynamic(body) || data_.bodies[body].shapes.empty() || data_.bodies[body].bullet) return;
        const double speed = length(blow.value) / mass(body);
        if (speed * scene_.step > least_and_most(extents(body)).first)
            add(place + ".value",
                fmt::format("{:.3g} N·s make \"{}\" {:.3g} m/s fast, more than its thickness a "
                            "step; a smaller blow or \"bullet\": true helps",
                            length(blow.value), label(body), speed));
    }

    void check_water(const std::string& place, const Buoyancy<D>& water) {
        const Vec<D>& gravity = data_.world.gravity;
        if (length(gravity) == 0) return add(place, "has no effect without gravity");
        if (dot(normalized(water.up), normalized(gravity)) > -0.9)
            add(place + ".surface", "is far from level: gravity does not pull the water against its normal");
        if (D == 3 && (water.density < least_density || water.density > most_density))
            add(place + ".density", fmt::format("{:g} kg/m³ is that of no liquid", water.density));
    }

    /// A spring is evaluated once a step, which is stable while its angular frequency times the step is below
    /// 2 and accurate well below 1.
    void check_spring(const std::string& place, const Spring<D>& spring) {
        double inverse_mass = 0;
        if (spring.a && is_dynamic(spring.a->index)) inverse_mass += 1 / mass(spring.a->index);
        if (is_dynamic(spring.b.index)) inverse_mass += 1 / mass(spring.b.index);
        if (inverse_mass == 0) return add(place, "neither end of the spring is dynamic: it moves nothing");
        const double phase = std::sqrt(spring.stiffness * inverse_mass) * scene_.step;
        if (phase > 1)
            add(place + ".stiffness", fmt::format("{:g} N/m on {:.3g} kg swings by {:.3g} rad a step and "
                                                  "will explode or ring; below 1 it is "
                                                  "well; take a shorter step or a softer spring",
                                                  spring.stiffness, 1 / inverse_mass, phase));
        if (const double decay = spring.damping * inverse_mass * scene_.step; decay > 1)
            add(place + ".damping",
                fmt::format("{:g} N·s/m on {:.3g} kg takes more speed than there is in a step",
                            spring.damping, 1 / inverse_mass));
    }

    const Scene& scene_;
    const SceneData<D>& data_;
    SceneWorld<D> built_;
    std::vector<Suspicion> found_;
};

}  // namespace

std::vector<Suspicion> check_scene(const Scene& scene) {
    return scene.dimension() == 2 ? Checker<2>(scene).check() : Checker<3>(scene).check();
}

}  // namespace carom::io
