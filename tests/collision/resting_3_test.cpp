#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "carom/collide.hpp"
#include "random.hpp"

namespace carom::test::space {

namespace {

/// A shape and how it is turned, with the height of its centre over the floor that it lies on, and of its
/// top.
struct Posture {
    std::string name;
    Geometry<3> geometry;
    Rotation3 turn;
    double below;  ///< from the lowest point up to the centre
    double above;
    int on_flat;  ///< points of contact on a wide flat face
    int on_line;  ///< on a long thing lying along the z axis
};

const Rotation3 upright{};
const Rotation3 upside_down = Rotation3::from_axis_angle({1, 0, 0}, 3.14159265358979323846);
const Rotation3 along_z = Rotation3::from_axis_angle({1, 0, 0}, 0.5 * 3.14159265358979323846);

std::vector<Vec3> wheel_corners(int count, double half_height, double radius) {
    std::vector<Vec3> corners;
    for (int i = 0; i < count; ++i) {
        const Vec3 out = rotate(Rotation3::from_axis_angle({0, 1, 0}, 2 * 3.14159265358979323846 * i / count),
                                Vec3{radius, 0, 0});
        for (const double y : {-half_height, half_height}) corners.push_back({out.x, y, out.z});
    }
    return corners;
}

std::vector<Vec3> prism_corners(double half_height, double radius) {
    std::vector<Vec3> corners;
    for (const Vec2& p : {Vec2{1, 0}, {0.5, 0.8}, {-0.5, 0.8}, {-1, 0}, {-0.5, -0.8}, {0.5, -0.8}}) {
        for (const double y : {-half_height, half_height}) corners.push_back({radius * p.x, y, radius * p.y});
    }
    return corners;
}

/// Lies on its side: a cone's generator line is tilted against its axis by atan(radius/height), here 30
/// degrees.
Rotation3 cone_on_its_side() {
    return Rotation3::from_axis_angle({1, 0, 0}, (0.5 + 1.0 / 6) * 3.14159265358979323846);
}

std::vector<Posture> postures() {
    const double root_3 = std::sqrt(3.0);
    return {
        {"ball", Ball{0.5}, upright, 0.5, 0.5, 1, 1},
        {"box", Box3{{1, 1, 1}}, upright, 0.5, 0.5, 4, 2},
        {"thin plate", Box3{{2, 0.01, 2}}, upright, 0.005, 0.005, 4, 2},
        {"rounded box", Box3{{1, 1, 1}, 0.1}, upright, 0.5, 0.5, 4, 2},
        {"standing capsule", Capsule3{{0, -0.5, 0}, {0, 0.5, 0}, 0.3}, upright, 0.8, 0.8, 1, 1},
        {"lying capsule", Capsule3{{0, 0, -0.5}, {0, 0, 0.5}, 0.3}, upright, 0.3, 0.3, 2, 2},
        {"prism", Hull3{prism_corners(0.4, 0.6)}, upright, 0.4, 0.4, 4, 2},
        {"rounded prism", Hull3{prism_corners(0.3, 0.6), 0.1}, upright, 0.4, 0.4, 4, 2},
        {"tetrahedron", Hull3{{{-0.6, -0.3, -0.5}, {0.6, -0.3, -0.5}, {0, -0.3, 0.7}, {0, 0.6, 0}}}, upright,
         0.3, 0.6, 3, 2},
        {"standing cylinder", Cylinder{0.4, 1}, upright, 0.5, 0.5, 4, 2},
        {"lying cylinder", Cylinder{0.4, 1}, along_z, 0.4, 0.4, 2, 2},
        {"standing cone", Cone{0.5, 1}, upright, 0.5, 0.5, 4, 2},
        {"cone on its tip", Cone{0.5, 1}, upside_down, 0.5, 0.5, 1, 1},
        {"lying cone", Cone{1 / root_3, 1}, cone_on_its_side(), 0.25, 0.25, 2, 2},
    };
}

/// Wide flat tops to lie on, each with its top at y = 0.
struct Ground {
    std::string name;
    Geometry<3> geometry;
    Transform3 placed;
    double off_center = 0;  ///< how far from the middle, across, things are put down
};

std::vector<Ground> flat_grounds() {
    return {
        {"plane", Plane3{{0, 1, 0}, 0}, {}, 0.01},
        {"box", Box3{{6, 1, 6}}, {{0, -0.5, 0}, upright}, 0.01},
        {"rounded box", Box3{{6, 1, 6}, 0.2}, {{0, -0.5, 0}, upright}, 0.01},
        {"hull", Hull3{prism_corners(0.5, 4)}, {{0, -0.5, 0}, upright}, 0.01},
        {"cylinder", Cylinder{4, 1}, {{0, -0.5, 0}, upright}, 0.01},
        {"cone", Cone{4, 2}, {{0, -1, 0}, upside_down}, 0.01},
    };
}

std::vector<Ground> long_grounds() {
    return {
        {"capsule", Capsule3{{0, 0, -4}, {0, 0, 4}, 0.5}, {{0, -0.5, 0}, upright}},
        {"cylinder", Cylinder{0.5, 8}, {{0, -0.5, 0}, along_z}},
    };
}

std::set<std::uint32_t> features(const Manifold<3>& manifold) {
    std::set<std::uint32_t> ids;
    for (int i = 0; i < manifold.count; ++i) ids.insert(manifold.points[static_cast<std::size_t>(i)].feature);
    return ids;
}

/// Places the shape a little deeper or higher and a little tilted, again and again.
void expect_steady(const Posture& posture, const Ground& ground, int count) {
    SCOPED_TRACE(posture.name + " on " + ground.name);
    const Solid<3> a(ground.geometry), b(posture.geometry);
    Random random(7);
    std::set<std::uint32_t> first;
    for (int n = 0; n < 40; ++n) {
        const double depth = random.between(-1e-4, 1e-3), tremble = n % 2 ? 1e-7 : 0;
        const Rotation3 tilt = Rotation3::from_axis_angle(random.direction<3>(), tremble);
        const Vec3 center =
            Vec3{ground.off_center, posture.below - depth, 0.02} + tremble * random.direction<3>();
        const Manifold<3> found = collide<3>(a, ground.placed, b, {center, tilt * posture.turn}, 0.01);
        ASSERT_EQ(found.count, count) << "depth " << depth;
        EXPECT_NEAR(found.normal.y, 1, 1e-9);
        for (int i = 0; i < found.count; ++i) {
            EXPECT_NEAR(found.points[static_cast<std::size_t>(i)].separation, -depth, 1e-6);
            EXPECT_NEAR(found.points[static_cast<std::size_t>(i)].position.y, -0.5 * depth, 1e-6);
        }
        EXPECT_EQ(features(found).size(), static_cast<std::size_t>(count))
            << "every point has its own feature";
        if (n == 0) first = features(found);
        EXPECT_EQ(features(found), first) << "features stay the same, depth " << depth;
    }
}

TEST(Resting3, OnFlatGround) {
    for (const Ground& ground : flat_grounds()) {
        for (const Posture& posture : postures()) expect_steady(posture, ground, posture.on_flat);
    }
}

TEST(Resting3, OnALyingCapsuleOrCylinder) {
    for (const Ground& ground : long_grounds()) {
        for (const Posture& posture : postures()) expect_steady(posture, ground, posture.on_line);
    }
}

/// Two things that touch, and how many points hold them.
struct Touching {
    std::string name;
    Geometry<3> below, above;
    Transform3 below_placed, above_placed;  ///< so that they just touch, one over the other along y
    int count;
};

Rotation3 about_y(double angle) { return Rotation3::from_axis_angle({0, 1, 0}, angle); }

std::vector<Touching> touching() {
    const Geometry<3> cube = Box3{{1, 1, 1}}, plank = Box3{{4, 0.1, 0.3}}, barrel = Cylinder{0.4, 1};
    const Geometry<3> prism = Hull3{prism_corners(0.4, 0.6)}, rounded = Box3{{1, 1, 1}, 0.1};
    const Transform3 here{};
    const auto at = [](double x, double y, double z, const Rotation3& turn = {}) {
        return Transform3{{x, y, z}, turn};
    };
    return {
        {"equal cubes, one on the other", cube, cube, here, at(0, 1, 0), 4},
        {"equal cubes, shifted", cube, cube, here, at(0.3, 1, 0), 4},
        {"equal cubes, shifted both ways", cube, cube, here, at(0.3, 1, -0.2), 4},
        {"equal cubes, turned by 45 degrees", cube, cube, here, at(0, 1, 0, about_y(0.78539816339744831)), 4},
        {"equal rounded boxes", rounded, rounded, here, at(0, 1, 0), 4},
        {"equal prisms", prism, prism, here, at(0, 0.8, 0), 4},
        {"prism on a cube of its width", cube, prism, here, at(0, 0.9, 0), 4},
        {"wheels with more corners than there is room for", Hull3{wheel_corners(150, 0.2, 1)},
         Hull3{wheel_corners(140, 0.2, 1)}, here, at(0.3, 0.4, 0.1), 4},
        {"planks, crossed", plank, plank, here, at(0.2, 0.1, 0.1, about_y(1.2)), 4},
        {"planks, far out", plank, plank, here, at(1.9, 0.1, 0, about_y(1.57079632679489662)), 4},
        {"small cube on a large one's edge", Box3{{4, 1, 4}}, Box3{{0.2, 0.2, 0.2}}, here, at(2, 0.6, 0.3),
         4},
        {"equal barrels", barrel, barrel, here, at(0, 1, 0), 4},
        {"barrel on a wider one", Cylinder{0.6, 1}, barrel, here, at(0.1, 1, 0.05, about_y(0.3)), 4},
        {"barrel on a narrower one", barrel, Cylinder{0.6, 1}, here, at(0.1, 1, 0.05, about_y(0.3)), 4},
        {"barrel half over the edge of a box", Box3{{2, 1, 2}}, barrel, here, at(1, 1, 0.1), 4},
        {"box on a barrel", barrel, cube, here, at(0.1, 1, 0, about_y(0.2)), 4},
        {"box half over the edge of a barrel", barrel, cube, here, at(0.5, 1, 0, about_y(0.2)), 4},
        {"barrels lying side on side", barrel, barrel, at(0, 0, 0, along_z), at(0, 0.8, 0.1, along_z), 2},
        {"barrel lying across another", barrel, barrel, at(0, 0, 0, along_z),
         at(0, 0.8, 0.1, about_y(1) * along_z), 1},
        {"barrel lying on the end of one that stands", barrel, barrel, here, at(0, 0.9, 0.1, along_z), 2},
        {"capsule over the edge of a box", Box3{{2, 1, 2}}, Capsule3{{-1, 0, 0}, {1, 0, 0}, 0.2}, here,
         at(0.9, 0.7, 0), 2},
        {"capsule across a capsule", Capsule3{{-1, 0, 0}, {1, 0, 0}, 0.2},
         Capsule3{{0, 0, -1}, {0, 0, 1}, 0.2}, here, at(0, 0.4, 0), 1},
        {"capsules side by side", Capsule3{{-1, 0, 0}, {1, 0, 0}, 0.2}, Capsule3{{-1, 0, 0}, {1, 0, 0}, 0.3},
         here, at(0.5, 0.5, 0), 2},
        {"cone on a cone's base", Cone{0.5, 1}, Cone{0.4, 1}, at(0, 0, 0, upside_down), at(0.05, 1, 0), 4},
        {"edge of a box on a plate", Box3{{4, 0.2, 4}}, cube, here,
         at(0, 0.1 + std::sqrt(0.5), 0, Rotation3::from_axis_angle({1, 0, 0}, 0.78539816339744831)), 2},
        {"edge of a box across the edge of a box", cube, cube,
         at(0, 0, 0, Rotation3::from_axis_angle({1, 0, 0}, 0.78539816339744831)),
         at(0.1, std::sqrt(2.0), 0.05, Rotation3::from_axis_angle({0, 0, 1}, 0.78539816339744831)), 1},
        {"corner of a box on a plate", Box3{{4, 0.2, 4}},
         Hull3{{{0, 0, 0}, {1, 1, 0}, {-1, 1, 1}, {0, 1.2, -1}}}, here, at(0, 0.1, 0), 1},
    };
}

TEST(Resting3, StacksKeepTheirPointsAndFeatures) {
    for (const Touching& pair : touching()) {
        SCOPED_TRACE(pair.name);
        const Solid<3> below(pair.below), above(pair.above);
        Random random(11);
        std::set<std::uint32_t> first;
        for (int n = 0; n < 40; ++n) {
            const double depth = random.between(-1e-4, 1e-3), tremble = n % 2 ? 1e-7 : 0;
            Transform3 placed = pair.above_placed;
            placed.position += Vec3{0, -depth, 0} + tremble * random.direction<3>();
            placed.rotation = Rotation3::from_axis_angle(random.direction<3>(), tremble) * placed.rotation;
            const Manifold<3> found = collide<3>(below, pair.below_placed, above, placed, 0.01);
            ASSERT_EQ(found.count, pair.count) << "depth " << depth;
            EXPECT_NEAR(found.normal.y, 1, 1e-9);
            for (int i = 0; i < found.count; ++i)
                EXPECT_NEAR(found.points[static_cast<std::size_t>(i)].separation, -depth, 1e-6);
            if (n == 0) first = features(found);
            EXPECT_EQ(features(found), first) << "features stay the same, depth " << depth;
        }
    }
}

/// Two boxes, the upper one shifted by half its width and tilted about the z axis. Tilted one way its lower
/// face is the one that parts the two best, tilted the other way the lower box's upper face.
Manifold<3> tilted_boxes(double angle) {
    const Geometry<3> lower = Box3{{1, 1, 1}}, upper = Box3{{1, 1, 0.8}};
    const Transform3 placed{{0.5, 0.999, 0}, Rotation3::from_axis_angle({0, 0, 1}, angle)};
    return collide<3>(lower, {}, upper, placed, 0.01);
}

TEST(Resting3, PointsKeepTheirNamesWhenTheOtherFaceIsClipped) {
    const Manifold<3> on_lower = tilted_boxes(1e-3), on_upper = tilted_boxes(-1e-3);
    EXPECT_EQ(on_lower.normal, (Vec3{0, 1, 0}));
    EXPECT_NEAR(on_upper.normal.x, 1e-3, 1e-9);
    EXPECT_EQ(on_lower.count, 4);
    EXPECT_EQ(features(on_lower), features(on_upper));
}

TEST(Resting3, OfFacesThatAreNearlyAsGoodTheFirstShapesIsTaken) {
    for (const double angle : {-5e-5, -1e-5, -1e-7, 0.0, 1e-7, 1e-5, 5e-5})
        EXPECT_EQ(tilted_boxes(angle).normal, (Vec3{0, 1, 0}));
}

}  // namespace

}  // namespace carom::test::space
