#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

namespace carom::app {
namespace {

constexpr int rows = 10;

/// A pyramid of cubes of 1 m on a fixed slab, all moved from the origin by `away`. The cubes stand on one
/// another at the start and settle.
template <int D>
class Pyramid {
  public:
    explicit Pyramid(const Vec<D>& away) : away_(away) {
        BodyDefinition<D> slab;
        slab.type = BodyType::fixed;
        Vec<D> size{};
        for (int i = 0; i < D; ++i) size[i] = 40;
        size.y = 1;
        slab.shapes.push_back({Box<D>{size}});
        slab.position = away + in_plane<D>(0, -0.5);
        world_.add_body(slab);
        for (int row = 0; row < rows; ++row) {
            const int side = rows - row;
            for (int i = 0; i < side; ++i)
                for (int k = 0; k < (D == 2 ? 1 : side); ++k) add_cube(row, i, k);
        }
    }

    void step() { world_.step(frame); }
    bool asleep() const { return world_.counts().awake == 0; }
    std::size_t count() const { return cubes_.size(); }
    /// Place of a cube against the point that the pyramid was moved to.
    Vec<D> place(std::size_t cube) const { return world_.position(cubes_[cube]) - away_; }

  private:
    void add_cube(int row, int i, int k) {
        constexpr double pitch = 1.1;
        const double middle = 0.5 * (rows - row - 1);
        BodyDefinition<D> cube;
        Vec<D> size{};
        for (int axis = 0; axis < D; ++axis) size[axis] = 1;
        cube.shapes.push_back({Box<D>{size}});
        cube.position = in_plane<D>(pitch * (i - middle), 0.5 + row);
        if constexpr (D == 3) cube.position.z = pitch * (k - middle);
        cube.position += away_;
        cubes_.push_back(world_.add_body(cube));
    }

    World<D> world_;
    Vec<D> away_;
    std::vector<BodyId<D>> cubes_;
};

template <int D>
void add_pyramid(std::vector<Result>& results) {
    Vec<D> away{};
    for (int i = 0; i < D; ++i) away[i] = 1e7;
    Pyramid<D> near(Vec<D>{}), far(away);
    double worst = 0;
    int near_asleep = 0, far_asleep = 0;
    for (int step = 1; step <= 1200 && (near_asleep == 0 || far_asleep == 0); ++step) {
        near.step();
        far.step();
        if (near_asleep == 0 && near.asleep()) near_asleep = step;
        if (far_asleep == 0 && far.asleep()) far_asleep = step;
        for (std::size_t i = 0; i < near.count(); ++i)
            worst = std::max(worst, length(far.place(i) - near.place(i)));
    }
    const std::string what = fmt::format("{}D, pyramid of {} cubes: ", D, near.count());
    results.push_back(absolute(what + "largest difference of places (m)", 0, worst, {1e-3}));
    results.push_back(absolute(what + "step of falling asleep", near_asleep, far_asleep, {0}));
    results.push_back(absolute(what + "asleep within 20 s (1: yes)", 1, near_asleep > 0 ? 1 : 0, {0}));
}

}  // namespace

std::vector<Result> far_away() {
    std::vector<Result> results;
    add_pyramid<2>(results);
    add_pyramid<3>(results);
    return results;
}

}  // namespace carom::app
