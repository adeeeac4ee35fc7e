#include "solver/reflect.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

/// A matrix G Gᵀ, with G of `columns` columns: singular where these are fewer than the rows.
std::vector<double> square_of_random(Random& random, std::size_t rows, std::size_t columns) {
    std::vector<double> g(rows * columns), matrix(rows * rows);
    for (double& value : g) value = random.between(-1, 1);
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t j = 0; j < rows; ++j)
            matrix[i * rows + j] = std::inner_product(g.begin() + i * columns, g.begin() + (i + 1) * columns,
                                                      g.begin() + j * columns, 0.0);
    return matrix;
}

TEST(Complementarity, IsMetWithFullAndWithSingularMatrices) {
    Random random(1);
    for (int trial = 0; trial < 300; ++trial) {
        const std::size_t rows = 1 + trial % 24;
        const std::size_t columns = trial % 3 == 0 ? std::max<std::size_t>(1, rows / 2) : rows + 2;
        const auto matrix = square_of_random(random, rows, columns);
        // b = A c lies where the matrix can reach it.
        std::vector<double> c(rows), b(rows), x(rows);
        for (double& value : c) value = random.between(-1, 1);
        for (std::size_t i = 0; i < rows; ++i)
            b[i] = std::inner_product(c.begin(), c.end(), matrix.begin() + i * rows, 0.0);
        solve_complementarity(matrix, b, x);
        for (std::size_t i = 0; i < rows; ++i) {
            const double speed = std::inner_product(x.begin(), x.end(), matrix.begin() + i * rows, b[i]);
            EXPECT_GE(x[i], 0);
            EXPECT_GE(speed, -1e-7);
            EXPECT_NEAR(x[i] * speed, 0, 1e-6);
        }
    }
}

/// Equal balls of 1 kg in a row along x, each in touch with the next.
std::vector<ImpactBody<2>> row_of_balls(const std::vector<double>& speeds) {
    std::vector<ImpactBody<2>> balls;
    for (const double speed : speeds) {
        ImpactBody<2> ball;
        ball.motion.v = {speed, 0};
        ball.weight = {{1, 1}, 2};
        balls.push_back(ball);
    }
    return balls;
}

ImpactPoint<2> touch_of(std::uint32_t a, std::uint32_t b, double restitution, double friction = 0) {
    ImpactPoint<2> p;
    p.a = a, p.b = b;
    p.normal = {1, 0};
    p.tangents = {Vec2{0, 1}};
    p.arm_a = {1, 0};
    p.arm_b = {-1, 0};
    p.restitution = restitution;
    p.friction = friction;
    return p;
}

double energy_of(const std::vector<ImpactBody<2>>& bodies) {
    double sum = 0;
    for (const auto& b : bodies) {
        if (b.weight.mass.x == 0) continue;
        sum += 0.5 * dot(b.motion.v, b.motion.v) / b.weight.mass.x +
               0.5 * b.motion.w * b.motion.w / b.weight.inertia;
    }
    return sum;
}

TEST(Reflection, EqualBallsExchangeTheirSpeeds) {
    auto balls = row_of_balls({3, 1});
    std::vector points{touch_of(0, 1, 1)};
    Reflection<2>().reflect(balls, points);
    EXPECT_NEAR(balls[0].motion.v.x, 1, 1e-14);
    EXPECT_NEAR(balls[1].motion.v.x, 3, 1e-14);
    EXPECT_NEAR(points[0].impulse, 2, 1e-14);
}

TEST(Reflection, TwoAtOnceAreStruckAlike) {
    // From both sides on to a ball at rest.
    for (const double e : {0.0, 0.5, 1.0}) {
        auto balls = row_of_balls({2, 0, -2});
        std::vector points{touch_of(0, 1, e), touch_of(1, 2, e)};
        Reflection<2>().reflect(balls, points);
        EXPECT_NEAR(balls[0].motion.v.x, -2 * e, 1e-9);
        EXPECT_NEAR(balls[1].motion.v.x, 0, 1e-9);
        EXPECT_NEAR(balls[2].motion.v.x, 2 * e, 1e-9);
    }
}

TEST(Reflection, MakesNoEnergyWhereCoefficientsDiffer) {
    Random random(2);
    for (int trial = 0; trial < 500; ++trial) {
        const int count = 2 + trial % 7;
        std::vector<double> speeds;
        for (int i = 0; i < count; ++i) speeds.push_back(random.between(-2, 2));
        auto balls = row_of_balls(speeds);
        for (auto& ball : balls) {
            ball.weight.mass.x = ball.weight.mass.y = random.between(0.1, 10);
            ball.motion.v.y = random.between(-2, 2);
            ball.motion.w = random.between(-2, 2);
        }
        if (trial % 4 == 0) balls[0].weight = {}, balls[0].motion = {};
        std::vector<ImpactPoint<2>> points;
        for (int i = 0; i + 1 < count; ++i) {
            if (balls[i].motion.v.x > balls[i + 1].motion.v.x)
                points.push_back(touch_of(i, i + 1, random.between(0, 1), trial % 2 ? 0.5 : 0));
        }
        const double before = energy_of(balls);
        Reflection<2>().reflect(balls, points);
        EXPECT_LE(energy_of(balls), before * (1 + 1e-10));
        for (const auto& p : points) {
            EXPECT_GE(p.impulse, 0);
            EXPECT_LE(std::fabs(p.tangential[0]), p.friction * p.impulse * (1 + 1e-12));
        }
    }
}

TEST(Reflection, ManyPointsKeepTheEnergyToo) {
    // More than are solved at once: a row that is pressed together, one faster than the next.
    std::vector<double> speeds;
    for (int i = 0; i < 200; ++i) speeds.push_back(-0.01 * i);
    auto balls = row_of_balls(speeds);
    std::vector<ImpactPoint<2>> points;
    for (int i = 0; i + 1 < 200; ++i) points.push_back(touch_of(i, i + 1, 1));
    const double before = energy_of(balls);
    Reflection<2>().reflect(balls, points);
    EXPECT_NEAR(energy_of(balls), before, 1e-9 * before);
}

TEST(Reflection, FrictionStopsTheSlipOfABall) {
    // Down on to something that does not move; the normal is along x.
    auto balls = row_of_balls({0, -2});
    balls[0].weight = {};
    balls[1].motion.v.y = 0.5;
    std::vector points{touch_of(0, 1, 0.5, 10)};
    Reflection<2>().reflect(balls, points);
    EXPECT_NEAR(balls[1].motion.v.x, 1, 1e-12);
    // The touch is at −x: its speed along y is v.y − w.
    EXPECT_NEAR(balls[1].motion.v.y - balls[1].motion.w, 0, 1e-9);
    points[0] = touch_of(0, 1, 0.5, 0.01);
    balls[1].motion = {};
    balls[1].motion.v = {-2, 0.5};
    Reflection<2>().reflect(balls, points);
    EXPECT_NEAR(points[0].tangential[0], -0.01 * points[0].impulse, 1e-12);
}

}  // namespace
}  // namespace carom::detail
