#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string_view>
#include <vector>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Many bodies that strike at once.

namespace carom::app {
namespace {

constexpr double radius = 0.1, speed = 2;
constexpr Bounds bounds{5e-2, 1e-6}, exact{1e-6, 1e-9};

Material smooth(double restitution) {
    Material material;
    material.friction = 0;
    material.restitution = restitution;
    return material;
}

template <int D>
World<D> empty_space() {
    WorldDefinition<D> definition;
    definition.gravity = {};
    return World<D>(definition);
}

template <int D>
BodyDefinition<D> ball(const Vec<D>& position, const Material& material) {
    BodyDefinition<D> body;
    body.mass = 1;
    body.position = position;
    body.shapes.push_back({Ball{radius}});
    body.shapes.back().material = material;
    return body;
}

// Newton's cradle. --------------------------------------------------------------------------------------

enum class Setting { free, floor, hung };

std::string_view name_of(Setting setting) {
    return setting == Setting::free    ? "in empty space"
           : setting == Setting::floor ? "on a smooth floor"
                                       : "hung";
}

/// Balls in a row, of which the first `thrown` come with 2 m/s on to the others, which are at rest; hung ones
/// swing on to them from 35°.
template <int D>
class Cradle {
  public:
    Cradle(int balls, int thrown, double gap, Setting setting, double restitution) : setting_(setting) {
        WorldDefinition<D> definition;
        if (setting == Setting::free) definition.gravity = {};
        world_ = World<D>(definition);
        if (setting == Setting::floor) add_floor(world_, smooth(0));
        for (int i = 0; i < balls; ++i) {
            const bool comes = i < thrown;
            const double x = i * (2 * radius + gap);
            Vec<D> position = in_plane<D>(x, setting == Setting::floor ? radius : 0);
            if (comes && setting != Setting::hung) position.x -= 0.05;
            if (comes && setting == Setting::hung)
                position = in_plane<D>(x - std::sin(angle), 1 - std::cos(angle));
            BodyDefinition<D> definition_of_it = ball(position, smooth(restitution));
            if (comes && setting != Setting::hung) definition_of_it.velocity = in_plane<D>(speed, 0);
            ids_.push_back(world_.add_body(definition_of_it));
            if (setting == Setting::hung) hang(ids_.back(), x);
        }
        energy_ = energy();
    }

    /// Until all has been struck that can be.
    void run() {
        const double swing = 0.25 * 2.006066680711 * 1.0239;  // a quarter of the period from 35°
        run_until(world_, setting_ == Setting::hung ? swing + 0.1 : 0.2);
    }

    /// How far the worst ball is from what it should have: of the speed, or, hung, of the energy of one.
    double error(int thrown) const {
        const std::size_t n = ids_.size();
        const double one = energy_ / thrown;
        double worst = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const bool leaves = i + static_cast<std::size_t>(thrown) >= n;
            if (setting_ == Setting::hung)
                worst = std::max(worst, std::fabs(own_energy(ids_[i]) / one - leaves));
            else
                worst = std::max(worst,
                                 length(world_.velocity(ids_[i]) - in_plane<D>(leaves * speed, 0)) / speed);
        }
        return worst;
    }
    double gain() const { return energy() / energy_ - 1; }
    /// Relative change of the momentum along the row.
    double momentum_error(int thrown) const {
        double sum = 0;
        for (const BodyId<D> id : ids_) sum += world_.velocity(id).x;
        return std::fabs(sum / (thrown * speed) - 1);
    }

  private:
    static constexpr double angle = 35 * degree;

    void hang(BodyId<D> id, double x) {
        DistanceJoint<D> string;
        string.anchor_a = in_plane<D>(x, 1);
        JointDefinition<D> joint;
        joint.kind = string;
        joint.b = id;
        world_.add_joint(joint);
    }
    double own_energy(BodyId<D> id) const {
        const Vec<D> v = world_.velocity(id);
        const double height = setting_ == Setting::hung ? world_.position(id).y : 0;
        return 0.5 * dot(v, v) + g * height;
    }
    double energy() const {
        double sum = 0;
        for (const BodyId<D> id : ids_) sum += own_energy(id);
        return sum;
    }

    Setting setting_;
    World<D> world_;
    std::vector<BodyId<D>> ids_;
    double energy_ = 0;
};

template <int D>
void add_cradles(std::vector<Result>& results) {
    for (const Setting setting : {Setting::free, Setting::floor, Setting::hung}) {
        for (const double gap : {0.0, 1e-9, 1e-6, 1e-3}) {
            double worst = 0, change = 0;
            for (const int balls : {3, 5, 10}) {
                for (const int thrown : {1, 2, 3}) {
                    Cradle<D> cradle(balls, thrown, gap, setting, 1);
                    cradle.run();
                    worst = std::max(worst, cradle.error(thrown));
                    change = std::max(change, std::fabs(cradle.gain()));
                }
            }
            const std::string what =
                fmt::format("{}D, cradle {}, gaps of {:g} m: ", D, name_of(setting), gap);
            const char* of = setting == Setting::hung ? "energy of each ball, worst error"
                                                      : "velocity of each ball, worst error";
            results.push_back(absolute(what + of, 0, worst, bounds));
            results.push_back(absolute(what + "energy, worst change", 0, change, {1e-2, 1e-6}));
        }
    }
    for (const double restitution : {0.5, 0.9}) {
        double gain = -1, momentum = 0;
        for (const int balls : {3, 5, 10}) {
            for (const int thrown : {1, 2, 3}) {
                Cradle<D> cradle(balls, thrown, 0, Setting::free, restitution);
                cradle.run();
                gain = std::max(gain, cradle.gain());
                momentum = std::max(momentum, cradle.momentum_error(thrown));
            }
        }
        const std::string what = fmt::format("{}D, cradle in empty space, e = {:g}: ", D, restitution);
        results.push_back(absolute(what + "energy gained", 0, std::max(gain, 0.0), exact));
        results.push_back(absolute(what + "momentum, worst change", 0, momentum, bounds));
    }
}

// Mirror symmetry. --------------------------------------------------------------------------------------

/// What is thrown together: bodies in the order of their places, each with the index of its mirror image in
/// the x axis. Fixed ones have no image.
template <int D>
struct Scene {
    Vec<D> gravity{};
    std::vector<BodyDefinition<D>> bodies;
    std::vector<std::size_t> image;
    double time = 0.2;

    void add(const BodyDefinition<D>& body) {
        image.push_back(bodies.size());
        bodies.push_back(body);
    }
    /// The body and its mirror image.
    void add_pair(BodyDefinition<D> body) {
        image.push_back(bodies.size() + 1);
        image.push_back(bodies.size());
        bodies.push_back(body);
        body.position.y = -body.position.y;
        bodies.push_back(body);
    }
};

/// A ball thrown along x on to a triangle of balls that touch.
template <int D>
Scene<D> triangle(int rows, const Material& material) {
    Scene<D> scene;
    BodyDefinition<D> cue = ball(in_plane<D>(-2 * radius - 0.05, 0), material);
    cue.velocity = in_plane<D>(speed, 0);
    scene.add(cue);
    for (int row = 0; row < rows; ++row) {
        for (int k = row % 2; k <= row; k += 2) {
            const auto one = ball(in_plane<D>(row * std::sqrt(3.0) * radius, k * radius), material);
            k == 0 ? scene.add(one) : scene.add_pair(one);
        }
    }
    return scene;
}

/// A ball thrown along x into the corner between two walls.
template <int D>
Scene<D> wedge(const Material& material) {
    Scene<D> scene;
    BodyDefinition<D> one = ball(in_plane<D>(-0.05, 0), material);
    one.velocity = in_plane<D>(speed, 0);
    scene.add(one);
    for (const double side : {1.0, -1.0}) {
        BodyDefinition<D> wall;
        wall.type = BodyType::fixed;
        const Vec<D> normal = in_plane<D>(-std::sqrt(0.5), -side * std::sqrt(0.5));
        wall.shapes.push_back({Plane<D>{normal, -radius}});
        wall.shapes.back().material = material;
        scene.add(wall);
    }
    return scene;
}

/// A box thrown flat on to two balls that do not touch each other.
template <int D>
Scene<D> box_on_balls(const Material& material) {
    Scene<D> scene;
    Vec<D> half;
    for (int i = 0; i < D; ++i) half[i] = 0.3;
    half.x = 0.1;
    BodyDefinition<D> box;
    box.mass = 3;
    box.position = in_plane<D>(-0.25, 0);
    box.velocity = in_plane<D>(speed, 0);
    box.shapes.push_back({Box<D>{half}});
    box.shapes.back().material = material;
    scene.add(box);
    scene.add_pair(ball(in_plane<D>(0, 0.2), material));
    return scene;
}

/// Runs the scene with the bodies added in this order, and returns how they move in the end, by their places.
template <int D>
std::vector<std::pair<Vec<D>, Angular<D>>> run_scene(const Scene<D>& scene,
                                                     const std::vector<std::size_t>& order, double& energy) {
    World<D> world = empty_space<D>();
    std::vector<BodyId<D>> ids(order.size());
    for (const std::size_t i : order) ids[i] = world.add_body(scene.bodies[i]);
    const double before = world.energy().kinetic;
    run_until(world, scene.time);
    energy = world.energy().kinetic / before - 1;
    std::vector<std::pair<Vec<D>, Angular<D>>> motions;
    for (const BodyId<D> id : ids) motions.emplace_back(world.velocity(id), world.angular_velocity(id));
    return motions;
}

/// What part of a motion is not as in the mirror image.
double asymmetry(const std::pair<Vec2, double>& one, const std::pair<Vec2, double>& other) {
    return length(one.first - Vec2{other.first.x, -other.first.y}) +
           radius * std::fabs(one.second + other.second);
}
double asymmetry(const std::pair<Vec3, Vec3>& one, const std::pair<Vec3, Vec3>& other) {
    const Vec3 v{other.first.x, -other.first.y, other.first.z};
    const Vec3 w{-other.second.x, other.second.y, -other.second.z};
    return length(one.first - v) + radius * length(one.second - w);
}

template <int D>
void add_symmetric(std::vector<Result>& results, std::string_view name, const Scene<D>& scene,
                   const Material& material) {
    std::vector<std::size_t> order(scene.bodies.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937_64 random(7);
    double worst = 0, change = 0, gain = 0;
    std::vector<std::pair<Vec<D>, Angular<D>>> first;
    for (int round = 0; round < 6; ++round) {
        if (round == 1) std::reverse(order.begin(), order.end());
        for (std::size_t i = order.size(); round > 1 && i > 1; --i)
            std::swap(order[i - 1], order[random() % i]);
        double energy = 0;
        const auto motions = run_scene(scene, order, energy);
        if (first.empty()) first = motions;
        change = std::max(change, std::fabs(energy));
        gain = std::max(gain, energy);
        for (std::size_t i = 0; i < motions.size(); ++i) {
            worst = std::max(worst, asymmetry(motions[i], motions[scene.image[i]]) / speed);
            worst = std::max(worst, length(motions[i].first - first[i].first) / speed);
        }
    }
    const std::string what =
        fmt::format("{}D, {}, e = {:g}, friction {:g}: ", D, name, material.restitution, material.friction);
    results.push_back(absolute(what + "asymmetry of velocities, six orders", 0, worst, {5e-2, 1e-6}));
    if (material.restitution == 1 && material.friction == 0)
        results.push_back(absolute(what + "energy, worst change", 0, change, {1e-2, 1e-6}));
    else
        results.push_back(absolute(what + "energy gained", 0, gain, exact));
}

template <int D>
void add_symmetries(std::vector<Result>& results) {
    Material rough;
    rough.friction = 0.3;
    rough.restitution = 0.8;
    for (const Material& material : {smooth(1), smooth(0.5), rough}) {
        add_symmetric(results, "ball on three in a triangle", triangle<D>(2, material), material);
        add_symmetric(results, "break of fifteen balls", triangle<D>(5, material), material);
        add_symmetric(results, "ball in a wedge", wedge<D>(material), material);
        add_symmetric(results, "box flat on two balls", box_on_balls<D>(material), material);
    }
}

}  // namespace

std::vector<Result> simultaneous_impacts() {
    std::vector<Result> results;
    add_cradles<2>(results);
    add_cradles<3>(results);
    add_symmetries<2>(results);
    add_symmetries<3>(results);
    return results;
}

}  // namespace carom::app
