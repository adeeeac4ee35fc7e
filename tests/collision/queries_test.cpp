#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "carom/collide.hpp"
#include "carom/error.hpp"
#include "random.hpp"

namespace carom {
namespace {

using test::Random;

template <class T>
class QueriesTest : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(QueriesTest, Dimensions);

template <int D>
Vec<D> along(int axis, double value) {
    Vec<D> v;
    v[axis] = value;
    return v;
}

template <int D>
Solid<D> cube(double size) {
    Box<D> box;
    for (int i = 0; i < D; ++i) box.size[i] = size;
    return Solid<D>(Geometry<D>(box));
}

template <int D>
Solid<D> ball(double radius) {
    return Solid<D>(Geometry<D>(Ball{radius}));
}

template <int D>
Solid<D> plane(const Vec<D>& normal, double offset) {
    return Solid<D>(Geometry<D>(Plane<D>{normal, offset}));
}

TYPED_TEST(QueriesTest, answers_in_the_outer_frame) {
    constexpr int D = TypeParam::value;
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        // The balls' centres are off their bodies' origins, and the bodies are turned.
        ShapeDefinition<D> definition{.geometry = Ball{1}};
        definition.center = random.in_cube<D>(3);
        const Solid<D> a(definition), b(definition);
        const Transform<D> a_placed = random.placement<D>(5), b_placed = random.placement<D>(5);
        const Vec<D> from = apply(a_placed, definition.center), to = apply(b_placed, definition.center);
        const double gap = length(to - from) - 2;
        const auto found = separation<D>(a, a_placed, b, b_placed);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->distance, gap, 1e-13);
        EXPECT_NEAR(length(found->axis - normalized(to - from)), 0, 1e-12);
        EXPECT_EQ(overlap<D>(a, a_placed, b, b_placed), gap <= 0);
        const Manifold<D> m = collide<D>(a, a_placed, b, b_placed, 2);
        ASSERT_EQ(m.count, gap <= 2 ? 1 : 0);
        if (m.count == 1) {
            EXPECT_NEAR(length(m.points[0].position - 0.5 * (from + to)), 0, 1e-12);
            EXPECT_NEAR(m.points[0].separation, gap, 1e-13);
            EXPECT_NEAR(length(m.normal - normalized(to - from)), 0, 1e-12);
        }
    }
}

TYPED_TEST(QueriesTest, touching_counts_as_overlap) {
    constexpr int D = TypeParam::value;
    const Vec<D> far = along<D>(0, 1e7);
    for (int axis = 0; axis < D; ++axis) {
        for (const Vec<D>& origin : {Vec<D>{}, far, -far}) {
            const Transform<D> here{origin, {}}, touching{origin + along<D>(axis, 1), {}},
                apart{origin + along<D>(axis, 1 + 0x1p-20), {}};
            EXPECT_TRUE(overlap<D>(cube<D>(1), here, cube<D>(1), touching));
            EXPECT_FALSE(overlap<D>(cube<D>(1), here, cube<D>(1), apart));
            EXPECT_TRUE(overlap<D>(cube<D>(1), here, ball<D>(0.5), touching));
            EXPECT_FALSE(overlap<D>(ball<D>(0.5), here, cube<D>(1), apart));
            EXPECT_TRUE(overlap<D>(ball<D>(0.5), here, ball<D>(0.5), touching));
            EXPECT_FALSE(overlap<D>(ball<D>(0.5), here, ball<D>(0.5), apart));
            EXPECT_EQ(separation<D>(cube<D>(1), here, cube<D>(1), apart)->distance, 0x1p-20);
            EXPECT_EQ(collide<D>(cube<D>(1), here, cube<D>(1), touching).count, Manifold<D>::capacity);
            EXPECT_EQ(collide<D>(cube<D>(1), here, cube<D>(1), apart).count, 0);
            EXPECT_EQ(collide<D>(cube<D>(1), here, cube<D>(1), apart, 0x1p-20).count, Manifold<D>::capacity);
        }
    }
}

TYPED_TEST(QueriesTest, two_planes_have_no_axis) {
    constexpr int D = TypeParam::value;
    const Vec<D> up = along<D>(1, 1);
    const Transform<D> origin, raised{along<D>(1, 2), {}};
    const Solid<D> floor = plane<D>(up, 0.5), ceiling = plane<D>(-up, 0.5),
                   wall = plane<D>(along<D>(0, 1), 0);
    EXPECT_FALSE(separation<D>(floor, origin, wall, origin));
    EXPECT_EQ(collide<D>(floor, origin, ceiling, origin).count, 0);
    EXPECT_TRUE(overlap<D>(floor, origin, wall, raised));
    EXPECT_TRUE(overlap<D>(floor, origin, floor, raised));
    EXPECT_TRUE(overlap<D>(floor, origin, ceiling, origin));
    EXPECT_FALSE(overlap<D>(floor, origin, ceiling, raised));
    EXPECT_TRUE(overlap<D>(ceiling, origin, floor, raised));
}

/// The message of the error that the call throws.
template <class Call>
std::string refusal(Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "not refused";
}

TYPED_TEST(QueriesTest, refuses_what_has_no_answer) {
    constexpr int D = TypeParam::value;
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    const Solid<D> a = cube<D>(1);
    const Transform<D> origin, lost{along<D>(1, nan), {}}, endless{along<D>(0, -infinity), {}};
    Transform<D> stretched;
    if constexpr (D == 2)
        stretched.rotation = {2, 0};
    else
        stretched.rotation = {0, 0, 0, 2};

    EXPECT_EQ(refusal([] { ball<D>(-1); }), "radius: -1 is not positive");
    EXPECT_EQ(refusal([&] { overlap<D>(a, lost, a, origin); }), "a_placed.position[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { separation<D>(a, origin, a, endless); }),
              "b_placed.position[0]: -inf is not finite");
    EXPECT_EQ(refusal([&] { collide<D>(a, origin, a, stretched); }),
              "b_placed.rotation: its length is 2, not 1");
    EXPECT_EQ(refusal([&] { collide<D>(a, origin, a, origin, -0.5); }),
              "reach: -0.5 is negative or not a number");
    EXPECT_EQ(refusal([&] { collide<D>(a, origin, a, origin, nan); }),
              "reach: nan is negative or not a number");
    EXPECT_EQ(collide<D>(a, origin, a, {along<D>(0, 100), {}}, infinity).count, Manifold<D>::capacity);
}

TYPED_TEST(QueriesTest, rotations_need_unit_length_only_roughly) {
    constexpr int D = TypeParam::value;
    Transform<D> placed{along<D>(0, 1), {}};
    if constexpr (D == 2)
        placed.rotation.c = 1.00005;
    else
        placed.rotation.w = 1.00005;
    EXPECT_EQ(separation<D>(cube<D>(1), placed, cube<D>(1), Transform<D>{})->distance, 0);
    EXPECT_EQ(separation<D>(cube<D>(1), placed, cube<D>(1), Transform<D>{})->axis, along<D>(0, -1));
}

}  // namespace
}  // namespace carom
