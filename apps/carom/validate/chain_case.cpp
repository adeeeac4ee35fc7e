#include <fmt/format.h>

#include <array>

#include "validate/cases.hpp"
#include "validate/setup.hpp"

// Chains of hinged rods.

namespace carom::app {
namespace {

/// Thin rods along x from the origin, each hinged to the one before.
template <int D>
struct Chain {
    World<D> world;
    BodyId<D> last{};

    Chain(int rods, double length, double mass, int substeps) : world(definition(substeps)) {
        std::optional<BodyId<D>> before;
        for (int i = 0; i < rods; ++i) {
            BodyDefinition<D> rod;
            rod.position = in_plane<D>((i + 0.5) * length, 0);
            rod.mass = mass;
            const double inertia = mass * length * length / 12;
            if constexpr (D == 2) {
                rod.inertia = inertia;
            } else {
                rod.inertia = Symmetric3<double>{0.1 * inertia, inertia, inertia};
            }
            rod.shapes.push_back(
                {Capsule<D>{in_plane<D>(-0.45 * length, 0), in_plane<D>(0.45 * length, 0), 0.05 * length}});
            last = world.add_body(rod);
            JointDefinition<D> hinge;
            hinge.kind = HingeJoint<D>{.anchor = in_plane<D>(i * length, 0)};
            hinge.a = before;
            hinge.b = last;
            world.add_joint(hinge);
            before = last;
        }
        half_ = 0.5 * length;
    }

    Vec<D> tip() const { return apply(world.transform(last), in_plane<D>(half_, 0)); }

  private:
    static WorldDefinition<D> definition(int substeps) {
        WorldDefinition<D> definition;
        definition.substeps = substeps;
        return definition;
    }

    double half_ = 0;
};

template <int D>
void add_falling_chain(std::vector<Result>& results, int substeps) {
    constexpr std::array<std::array<double, 3>, 4> known{{{0.25, 0.877462525, -0.306656671},
                                                          {0.5, -0.264645111, -0.863546757},
                                                          {0.75, -0.908445211, -0.383978764},
                                                          {1.0, -0.894316853, -0.146565067}}};
    Chain<D> chain(10, 0.1, 0.1, substeps);
    for (const auto& [time, x, y] : known) {
        run_until(chain.world, time);
        const Vec<D> error = chain.tip() - in_plane<D>(x, y);
        // The tip cracks like a whip at 0.5 s.
        results.push_back(
            {fmt::format("{}D, {} sub-steps, tip at {} s: x (m), error of both", D, substeps, time),
             x,
             chain.tip().x,
             length(error),
             {time < 0.5 ? 0.02 : 0.2, 1e-3}});
    }
}

}  // namespace

std::vector<Result> falling_chain() {
    std::vector<Result> results;
    for (const int substeps : {4, 16}) {
        add_falling_chain<2>(results, substeps);
        add_falling_chain<3>(results, substeps);
    }
    return results;
}

}  // namespace carom::app
