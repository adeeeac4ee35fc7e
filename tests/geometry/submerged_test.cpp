#include "geometry/submerged.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../collision/random.hpp"
#include "carom/mass.hpp"
#include "math/dim.hpp"

namespace carom::detail {
namespace {

using test::Random;

template <int D>
Geometry<D> random_geometry(Random& random, int kind) {
    if (kind == 0) return Ball{random.between(0.1, 2)};
    if (kind == 1) return Capsule<D>{random.in_cube<D>(1), random.in_cube<D>(1), random.between(0.1, 1)};
    if (kind == 2 || kind == 3) {
        Box<D> box;
        double least = 10;
        for (int i = 0; i < D; ++i) {
            box.size[i] = random.between(0.2, 2);
            least = std::min(least, box.size[i]);
        }
        if (kind == 3) box.rounding = random.between(0.01, 0.49) * least;
        return box;
    }
    if (kind == 4 || kind == 5) {
        Hull<D> hull;
        for (int i = 0; i < 12; ++i) hull.points.push_back(random.in_cube<D>(1));
        if (kind == 5) hull.rounding = random.between(0.01, 0.5);
        return hull;
    }
    if constexpr (D == 3) {
        if (kind == 6) return Cylinder{random.between(0.1, 1), random.between(0.1, 2)};
        return Cone{random.between(0.1, 1), random.between(0.1, 2)};
    }
    return Ball{1};
}

template <int D>
constexpr int kinds = D == 2 ? 6 : 8;

/// A shape somewhere on its body, and what its whole volume is.
template <int D>
struct Sample {
    ShapeDefinition<D> definition;
    Shape<D> shape;
    MassProperties<D> whole;

    Sample(Random& random, int kind) {
        definition.geometry = random_geometry<D>(random, kind);
        definition.center = random.in_cube<D>(2);
        definition.rotation = random.rotation<D>();
        definition.material.density = 1;
        shape = make_shape(definition);
        whole = mass_properties(definition);
    }
    /// Corners of hulls stand out of their faces a little, and what lies between them is no matter of
    /// definition.
    double tolerance() const {
        if constexpr (D == 3) {
            if (shape.core) return 1e-9 + 10 * shape.core->unevenness;
        }
        return 1e-9;
    }
    /// A height between the lowest and the highest point, and a bit beyond.
    double surface(Random& random, const Vec<D>& up) const {
        const double reach = length(bounds(shape, {}).upper - bounds(shape, {}).lower);
        return dot(up, whole.center) + random.between(-0.5, 0.5) * reach;
    }
};

template <class T>
class SubmergedIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SubmergedIn, Dimensions);

TYPED_TEST(SubmergedIn, WhollyUnderWaterIsTheWholeShape) {
    constexpr int D = TypeParam::value;
    Random random(11);
    for (int i = 0; i < 50 * kinds<D>; ++i) {
        const Sample<D> s(random, i % kinds<D>);
        const Vec<D> up = random.direction<D>();
        const Submerged<D> all = submerged(s.shape, up, 20);
        EXPECT_NEAR(all.volume, s.whole.mass, 1e-10 * s.whole.mass) << i % kinds<D>;
        EXPECT_LT(length(all.center - s.whole.center), 1e-10) << i % kinds<D>;
        EXPECT_EQ(submerged(s.shape, up, -20).volume, 0) << i % kinds<D>;
    }
}

TYPED_TEST(SubmergedIn, TheTwoSidesOfTheSurfaceAreTheWhole) {
    constexpr int D = TypeParam::value;
    Random random(12);
    for (int i = 0; i < 200 * kinds<D>; ++i) {
        const Sample<D> s(random, i % kinds<D>);
        // Upright and lying bodies are as frequent in games as they are special.
        Vec<D> up = random.direction<D>();
        if (i % 3 == 0) {
            up = {};
            up[i % D] = i % 2 == 0 ? 1 : -1;
            up = rotate(s.definition.rotation, up);
        }
        const double surface = s.surface(random, up);
        const Submerged<D> below = submerged(s.shape, up, surface), above = submerged(s.shape, -up, -surface);
        EXPECT_NEAR(below.volume + above.volume, s.whole.mass, s.tolerance()) << i % kinds<D>;
        const Vec<D> sum = below.volume * below.center + above.volume * above.center;
        EXPECT_LT(length(sum - s.whole.mass * s.whole.center), s.tolerance()) << i % kinds<D>;
    }
}

// The energy ∫ (surface − up · x) dx over what is below changes with the surface as the volume does, and with
// the direction of up as the first moments do. With the two tests above that leaves nothing open.
TYPED_TEST(SubmergedIn, VolumeAndCenterAreTheDerivativesOfOneEnergy) {
    constexpr int D = TypeParam::value;
    Random random(13);
    const auto energy = [](const Sample<D>& s, const Vec<D>& up, double surface) {
        const Submerged<D> part = submerged(s.shape, up, surface);
        return part.volume > 0 ? part.volume * (surface - dot(up, part.center)) : 0.0;
    };
    for (int i = 0; i < 200 * kinds<D>; ++i) {
        const Sample<D> s(random, i % kinds<D>);
        const Vec<D> up = random.direction<D>();
        const double surface = s.surface(random, up), step = 1e-5;
        const Submerged<D> part = submerged(s.shape, up, surface);
        const double rise = (energy(s, up, surface + step) - energy(s, up, surface - step)) / (2 * step);
        EXPECT_NEAR(rise, part.volume, 1e-6) << i % kinds<D>;
        if (!(part.volume > 1e-3)) continue;
        for (const Vec<D>& along : tangents<D>(up)) {
            const Vec<D> one = normalized(up + step * along), other = normalized(up - step * along);
            const double turn = (energy(s, one, surface) - energy(s, other, surface)) / (2 * step);
            EXPECT_NEAR(turn, -part.volume * dot(along, part.center), 1e-6) << i % kinds<D>;
        }
    }
}

TEST(SubmergedClosedForms, HalfABallAndTheCornerOfACube) {
    const Shape<3> ball = make_shape<3>({Ball{2}});
    const Submerged<3> half = submerged(ball, {0, 1, 0}, 0);
    EXPECT_NEAR(half.volume, 2.0 / 3 * pi * 8, 1e-12);
    EXPECT_NEAR(half.center.y, -0.75, 1e-12);
    // A corner of the cube of side 2 that reaches 1 below the surface: a tetrahedron of the edge √3.
    const Shape<3> cube = make_shape<3>({Box<3>{{2, 2, 2}}});
    const Vec3 up = normalized(Vec3{1, 1, 1});
    const Submerged<3> corner = submerged(cube, up, 1 - std::sqrt(3.0));
    EXPECT_NEAR(corner.volume, std::sqrt(3.0) / 2, 1e-12);
    EXPECT_LT(length(corner.center - Vec3{1, 1, 1} * (std::sqrt(3.0) / 4 - 1)), 1e-12);
}

TEST(SubmergedClosedForms, ATiltedCylinderAndAConeOnItsTip) {
    // A plane through the middle of a cylinder halves it; the centre of the wedge-shaped difference from the
    // upright half lies at R² tan θ / (4 h) along the tilt for the half height h.
    const double r = 0.5, h = 1, tilt = 0.3;
    const Shape<3> cylinder = make_shape<3>({Cylinder{r, 2 * h}});
    const Vec3 up{std::sin(tilt), std::cos(tilt), 0};
    const Submerged<3> half = submerged(cylinder, up, 0);
    EXPECT_NEAR(half.volume, pi * r * r * h, 1e-12);
    EXPECT_NEAR(half.center.x, -r * r * std::tan(tilt) / (4 * h), 1e-12);
    EXPECT_NEAR(half.center.y, -h / 2 + r * r * std::tan(tilt) * std::tan(tilt) / (8 * h), 1e-12);
    // A cone cut across its axis is a smaller one.
    const Shape<3> cone = make_shape<3>({Cone{1, 2}});
    const Submerged<3> tip = submerged(cone, {0, -1, 0}, 0);
    EXPECT_NEAR(tip.volume, pi / 12, 1e-12);
    EXPECT_NEAR(tip.center.y, 0.25, 1e-12);
}

TEST(SubmergedClosedForms, NothingOfWhatHasNoVolume) {
    EXPECT_EQ(submerged(make_shape<3>({Plane<3>{{0, 1, 0}, 0}}), {0, 1, 0}, 5).volume, 0);
    EXPECT_EQ(submerged(make_shape<2>({Chain{{{0, 0}, {1, 0}}}}), {0, 1}, 5).volume, 0);
}

}  // namespace
}  // namespace carom::detail
