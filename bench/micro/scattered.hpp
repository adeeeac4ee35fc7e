#pragma once

#include <string>
#include <vector>

#include "../../tests/collision/random.hpp"
#include "carom/carom.hpp"

namespace carom::bench {

using test::Random;

template <int D>
struct Kind {
    std::string name;
    Geometry<D> geometry;
};

/// A shape of each kind, about 1 m large.
template <int D>
std::vector<Kind<D>> kinds_of() {
    Random random(3);
    Hull<D> hull;
    for (int i = 0; i < (D == 2 ? 8 : 24); ++i) hull.points.push_back(0.5 * random.direction<D>());
    Vec<D> size, half{}, up{};
    for (int i = 0; i < D; ++i) size[i] = 1;
    half.x = 0.25;
    up.y = 1;
    std::vector<Kind<D>> kinds{{"ball", Ball{0.5}},
                               {"capsule", Capsule<D>{-half, half, 0.25}},
                               {"box", Box<D>{size}},
                               {"hull", hull},
                               {"plane", Plane<D>{up, 0}}};
    if constexpr (D == 3) {
        kinds.push_back({"cylinder", Cylinder{0.5, 1}});
        kinds.push_back({"cone", Cone{0.5, 1}});
    }
    return kinds;
}

/// Fixed boxes and balls, 0.5 to 1.5 m large, anywhere in a cube of the half length `half`.
template <int D>
World<D> scattered_world(int shapes, double half) {
    Random random(5);
    World<D> world;
    for (int i = 0; i < shapes; ++i) {
        BodyDefinition<D> body;
        body.type = BodyType::fixed;
        body.position = random.in_cube<D>(half);
        body.rotation = random.rotation<D>();
        const double size = random.between(0.5, 1.5);
        if (random.below(2)) {
            body.shapes = {{Ball{0.5 * size}}};
        } else {
            Box<D> box{};
            for (int k = 0; k < D; ++k) box.size[k] = size;
            body.shapes = {{box}};
        }
        world.add_body(body);
    }
    return world;
}

}  // namespace carom::bench
