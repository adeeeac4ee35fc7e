#include <fmt/format.h>

#include <algorithm>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// 216 balls that fall into a box without a lid, or fly about in one.

namespace carom::app {
namespace {

constexpr int side = 6;
constexpr double radius = 0.25, half_box = 2;

class Heap {
  public:
    explicit Heap(double restitution, double friction, bool gravity) {
        WorldDefinition3 definition;
        definition.sleep = false;
        definition.restitution_threshold = restitution == 1 ? 0 : 1;
        if (!gravity) definition.gravity = {};
        world_ = World3(definition);
        Material material;
        material.restitution = restitution;
        material.friction = friction;
        BodyDefinition3 box;
        box.type = BodyType::fixed;
        for (const Vec3& normal :
             {Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
            box.shapes.push_back({Plane<3>{normal, normal.y > 0 ? 0 : -half_box}});
            box.shapes.back().material = material;
        }
        if (!gravity) {
            box.shapes.push_back({Plane<3>{{0, -1, 0}, -4.0}});
            box.shapes.back().material = material;
        }
        world_.add_body(box);
        for (int i = 0; i < side * side * side; ++i) {
            const int x = i % side, y = i / side % side, z = i / side / side;
            BodyDefinition3 ball;
            ball.shapes.push_back({Ball{radius}});
            ball.shapes.back().material = material;
            // Rows are shifted against each other, so that they do not stand on one another.
            ball.position = {0.6 * (x - 2.5) + 0.05 * (y % 3), 0.5 + 0.6 * y,
                             0.6 * (z - 2.5) + 0.04 * (y % 2)};
            if (!gravity) ball.velocity = {x - 2.5, 0.5 * (y - z), 2.5 - y};
            balls_.push_back(world_.add_body(ball));
        }
        start_ = world_.energy().total();
        least_ = start_;
    }

    void run(double seconds) {
        for (int i = 0; i < 60 * seconds; ++i) {
            world_.step(frame);
            const double now = world_.energy().total();
            gained_ = std::max(gained_, now - least_);
            least_ = std::min(least_, now);
        }
    }

    double start() const { return start_; }
    double energy() const { return world_.energy().total(); }
    double gained() const { return gained_; }  ///< most that was gained over the least until then, J
    double mass() const { return world_.mass_properties(balls_.front()).mass * double(balls_.size()); }
    /// Root of the mean square of the speeds, turning included.
    double speed() const { return std::sqrt(2 * world_.energy().kinetic / mass()); }
    double deepest() const {
        double least = 1;
        for (std::size_t i = 0; i < balls_.size(); ++i) {
            const Vec3 p = world_.position(balls_[i]);
            least = std::min({least, p.y - radius, half_box - std::fabs(p.x) - radius,
                              half_box - std::fabs(p.z) - radius});
            for (std::size_t k = 0; k < i; ++k)
                least = std::min(least, length(world_.position(balls_[k]) - p) - 2 * radius);
        }
        // Of what is not a number no minimum is taken.
        return std::isfinite(world_.energy().total()) ? std::max(0.0, -least) : world_.energy().total();
    }

  private:
    World3 world_;
    std::vector<BodyId3> balls_;
    double start_ = 0, least_ = 0, gained_ = 0;
};

}  // namespace

std::vector<Result> heap_of_balls() {
    std::vector<Result> results;
    for (const double restitution : {0.0, 0.5}) {
        Heap heap(restitution, 0.3, true);
        heap.run(15);
        const std::string what = fmt::format("3D, 216 balls, restitution {:g}: ", restitution);
        const double unit = heap.mass() * g;  // J: lifts all of them by a metre
        results.push_back(
            absolute(what + "energy gained in 15 s (m g · 1 m)", 0, heap.gained() / unit, {1e-2, 1e-4}));
        results.push_back(absolute(what + "speed left (m/s)", 0, heap.speed(), {5e-2, 1e-3}));
        results.push_back(absolute(what + "deepest overlap (m)", 0, heap.deepest(), {1e-2, 2e-3}));
    }
    Heap flying(1, 0, false);
    flying.run(15);
    results.push_back(absolute("3D, 216 elastic balls in a closed box: |ΔE/E| after 15 s", 0,
                               std::fabs(flying.energy() / flying.start() - 1), {1e-2, 1e-5}));
    return results;
}

}  // namespace carom::app
