#include "math/dim.hpp"

#include <gtest/gtest.h>

#include "../collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

template <int D>
void expect_near(const Vec<D>& a, const Vec<D>& b, double tolerance) {
    for (int i = 0; i < D; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

double size_of(const Rotation2& q) { return std::sqrt(q.c * q.c + q.s * q.s); }
double size_of(const Rotation3& q) { return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w); }

TEST(Rotation, FromAngleAndBack) {
    Random random(1);
    for (int k = 0; k < 1000; ++k) {
        const double angle = random.between(-pi, pi);
        EXPECT_NEAR(Rotation2::from_angle(angle).angle(), angle, 1e-15);
        EXPECT_NEAR(Rotation2::from_angle(angle + 4 * pi).angle(), angle, 1e-14);
    }
    EXPECT_EQ(Rotation2{}.angle(), 0);
    EXPECT_EQ((Rotation2{-1, 0}.angle()), pi);
    EXPECT_EQ((Rotation2{-1, -0.0}.angle()), pi);
    expect_near<2>(rotate(Rotation2::from_angle(pi / 2), Vec2{1, 0}), {0, 1}, 1e-16);
}

/// Rodrigues' formula.
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
    const Vec3 u = normalized(axis);
    return std::cos(angle) * v + std::sin(angle) * cross(u, v) + (1 - std::cos(angle)) * dot(u, v) * u;
}

TEST(Rotation, FromAxisAndAngle) {
    Random random(2);
    for (int k = 0; k < 1000; ++k) {
        const Vec3 axis = random.in_cube<3>(3), v = random.in_cube<3>(1);
        const double angle = random.between(-20, 20);
        const Rotation3 q = Rotation3::from_axis_angle(axis, angle);
        EXPECT_NEAR(size_of(q), 1, 1e-15);
        expect_near<3>(rotate(q, v), turned(v, axis, angle), 1e-14);
        expect_near<3>(unrotate(q, rotate(q, v)), v, 3e-15);
    }
    // Axes of any length, even where the square of it over- or underflows.
    for (const double size : {1e-320, 1e-200, 1e200, 1e308}) {
        const Rotation3 q = Rotation3::from_axis_angle({0, size, size}, 1);
        expect_near<3>(rotate(q, Vec3{1, 0, 0}), turned({1, 0, 0}, {0, 1, 1}, 1), 1e-15);
    }
}

TEST(Rotation, OfARotationVector) {
    Random random(3);
    for (int k = 0; k < 2000; ++k) {
        const double angle = random.between(1e-9, k % 2 == 0 ? 1 : 30);
        const Vec3 axis = random.direction<3>(), v = random.in_cube<3>(1);
        const Rotation3 q = exp_rotation<3>(angle * axis);
        EXPECT_NEAR(size_of(q), 1, 5e-16);
        expect_near<3>(rotate(q, v), turned(v, axis, angle), 2e-14);
        const Rotation2 p = exp_rotation<2>(angle);
        EXPECT_NEAR(size_of(p), 1, 5e-16);
        expect_near<2>(rotate(p, Vec2{1, 0}), {std::cos(angle), std::sin(angle)}, 1e-15);
    }
    EXPECT_EQ(exp_rotation<3>({}), Rotation3{});
    EXPECT_EQ(exp_rotation<2>(0), Rotation2{});
    // Half a quarter turn, where the series ends.
    for (const double angle : {pi / 2, std::nextafter(pi / 2, 2), std::nextafter(pi / 2, 1)}) {
        EXPECT_NEAR(exp_rotation<3>({angle, 0, 0}).x, std::sqrt(0.5), 2e-16);
        EXPECT_NEAR(exp_rotation<3>({angle, 0, 0}).w, std::sqrt(0.5), 2e-16);
    }
    EXPECT_EQ(exp_rotation<3>({0, 1e-170, 0}), (Rotation3{0, 5e-171, 0, 1}));
}

TEST(Tangents, CompleteARightHandedFrame) {
    Random random(4);
    for (int k = 0; k < 2000; ++k) {
        const Vec3 n =
            k < 6 ? Vec3{k % 3 == 0 ? 1. : 0, k % 3 == 1 ? 1. : 0, k % 3 == 2 ? 1. : 0} * (k < 3 ? 1. : -1.)
                  : random.direction<3>();
        const auto [t, b] = tangents(n);
        EXPECT_NEAR(dot(t, t), 1, 1e-15);
        EXPECT_NEAR(dot(b, b), 1, 1e-15);
        EXPECT_NEAR(dot(t, n), 0, 1e-15);
        EXPECT_NEAR(dot(b, t), 0, 1e-15);
        expect_near<3>(cross(t, b), n, 1e-15);
        const auto in_floats = tangents(narrow<float>(n));
        expect_near<3>(narrow<double>(in_floats[0]), t, 1e-6);
        const Vec2 m = random.direction<2>();
        EXPECT_EQ(tangents(m)[0], (Vec2{-m.y, m.x}));
        EXPECT_NEAR(cross(m, tangents<2>(m)[0]), 1, 1e-15);
    }
}

TEST(Tangents, AreSteadyAroundTheAxes) {
    Random random(5);
    for (int k = 0; k < 6; ++k) {
        Vec3 axis{};
        axis[k % 3] = k < 3 ? 1 : -1;
        for (int i = 0; i < 100; ++i) {
            const Vec3 near = normalized(axis + random.in_cube<3>(1e-6));
            expect_near<3>(tangents(near)[0], tangents(axis)[0], 1e-5);
            expect_near<3>(tangents(near)[1], tangents(axis)[1], 1e-5);
        }
    }
}

Symmetric3<double> random_tensor(Random& random) {
    // A sum of squares is positive definite.
    Symmetric3<double> m;
    for (int k = 0; k < 4; ++k) m = m + outer_square(random.in_cube<3>(1));
    return m;
}

TEST(Symmetric, Inverse) {
    Random random(6);
    for (int k = 0; k < 1000; ++k) {
        const auto m = random_tensor(random);
        const Vec3 v = random.in_cube<3>(1);
        expect_near<3>(inverse(m) * (m * v), v, 1e-12 * trace(m) * trace(m) / determinant(m));
    }
    EXPECT_EQ(inverse(diagonal(1.0, 2.0, 4.0)), diagonal(1.0, 0.5, 0.25));
    EXPECT_EQ(inverse(Symmetric3<double>{}), Symmetric3<double>{});
    EXPECT_EQ(inverse(4.0), 0.25);
    EXPECT_EQ(inverse(0.0), 0.0);
    EXPECT_EQ(determinant(Symmetric3<double>{1, 1, 1, 0.5, 0, 0}), 0.75);
    EXPECT_DOUBLE_EQ(determinant(Symmetric3<double>{2, 3, 5, 0.5, 0.25, -1}),
                     2 * (15 - 1) - 0.5 * (2.5 + 0.25) + 0.25 * (-0.5 - 0.75));
}

TEST(Symmetric, RotatedActsLikeTheTensor) {
    Random random(7);
    for (int k = 0; k < 1000; ++k) {
        const auto m = random_tensor(random);
        const Rotation3 q = random.rotation<3>();
        const Vec3 v = random.in_cube<3>(1);
        expect_near<3>(rotated(m, q) * v, rotate(q, m * unrotate(q, v)), 1e-14);
    }
    const auto m = random_tensor(random);
    EXPECT_EQ(rotated(m, Rotation3{}), m);
    EXPECT_EQ(rotated(3.0, Rotation2::from_angle(1)), 3.0);
}

TEST(Symmetric, PositiveDefinite) {
    Random random(8);
    for (int k = 0; k < 1000; ++k) {
        EXPECT_TRUE(is_positive_definite(random_tensor(random)));
        const Rotation3 q = random.rotation<3>();
        EXPECT_FALSE(is_positive_definite(rotated(diagonal(1.0, random.between(1, 2), -0.1), q)));
        EXPECT_FALSE(is_positive_definite(rotated(diagonal(-1.0, -random.between(1, 2), 3.0), q)));
    }
    EXPECT_FALSE(is_positive_definite(Symmetric3<double>{}));
    EXPECT_FALSE(is_positive_definite(Symmetric3<double>{1, 1, 1, 2, 0, 0}));
}

TEST(Seam, BothDimensionsSpeakTheSameWords) {
    EXPECT_EQ(angular_dot(2.0, 3.0), 6.0);
    EXPECT_EQ(angular_dot(Vec3{1, 2, 3}, Vec3{4, 5, 6}), 32.0);
    EXPECT_EQ(angular_cross(2.0, 3.0), 0.0);
    EXPECT_EQ(angular_cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}), (Vec3{0, 0, 1}));
    EXPECT_EQ(rotate_angular(Rotation2::from_angle(1), 5.0), 5.0);
    expect_near<3>(rotate_angular(Rotation3::from_axis_angle({0, 0, 1}, pi / 2), Vec3{1, 0, 0}), {0, 1, 0},
                   1e-15);
    // The torque of a force, and the velocity of a point.
    EXPECT_EQ(cross(Vec2{2, 0}, Vec2{0, 3}), 6.0);
    EXPECT_EQ(cross(2.0, Vec2{3, 0}), (Vec2{0, 6}));
    EXPECT_EQ(max_points<2>, 2);
    EXPECT_EQ(max_points<3>, 4);
}

TEST(Seam, SteinerOfPointMasses) {
    // Two masses at ± d have the inertia of the offset.
    Random random(9);
    for (int k = 0; k < 100; ++k) {
        const Vec3 d = random.in_cube<3>(2), w = random.in_cube<3>(1);
        // Angular momentum m d × (w × d).
        expect_near<3>(steiner(3.0, d) * w, 3.0 * cross(d, cross(w, d)), 1e-13);
    }
    EXPECT_EQ(steiner(2.0, Vec2{3, 4}), 50.0);
}

TEST(Seam, Narrowing) {
    EXPECT_EQ(narrow<float>(Vec2{0.1, 0.2}), (Vec<2, float>{0.1f, 0.2f}));
    EXPECT_EQ(narrow<float>(Vec3{0.1, 0.2, 0.3}), (Vec<3, float>{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(narrow<float>(0.1), 0.1f);
    EXPECT_EQ(narrow<float>(Rotation2{0.6, 0.8}), (Rotation<2, float>{0.6f, 0.8f}));
    EXPECT_EQ(narrow<float>(Rotation3{0.1, 0.2, 0.3, 0.4}), (Rotation<3, float>{0.1f, 0.2f, 0.3f, 0.4f}));
    EXPECT_EQ(narrow<float>(Symmetric3<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}),
              (Symmetric3<float>{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}));
}

}  // namespace
}  // namespace carom::detail
