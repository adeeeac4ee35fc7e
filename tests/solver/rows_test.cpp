#include "solver/contact_rows.hpp"

#include <gtest/gtest.h>

#include "collision/random.hpp"

namespace carom::detail {
namespace {

using test::Random;

constexpr float rounding = 2e-5f;  // of a few operations on numbers up to about 10
constexpr SubStep<float> sub{240, 3, {20, 0.8f, 0.2f}, {40, 0.9f, 0.1f}};

template <class T>
class RowsIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RowsIn, Dimensions);

template <int D>
Vec<D, float> random_vec(Random& random, double half) {
    return narrow<float>(random.in_cube<D>(half));
}
template <int D>
Angular<D, float> random_spin(Random& random) {
    if constexpr (D == 2)
        return static_cast<float>(random.between(-3, 3));
    else
        return random_vec<3>(random, 3);
}
template <class T>
float size(const T& angular) {
    return std::sqrt(angular_dot(angular, angular));
}

template <int D>
Motion<D, float> random_motion(Random& random) {
    Motion<D, float> m;
    m.v = random_vec<D>(random, 3);
    m.w = random_spin<D>(random);
    return m;
}

/// Inverse mass and inertia of a random body that turns freely.
template <int D>
Weight<D, float> random_weight(Random& random) {
    Weight<D, float> weight;
    const double k = random.between(0.2, 2);
    for (int i = 0; i < D; ++i) weight.mass[i] = static_cast<float>(k);
    const double a = random.between(0.2, 2), b = random.between(0.2, 2), c = random.between(0.2, 2);
    if constexpr (D == 2)
        weight.inertia = static_cast<float>(a);
    else
        weight.inertia = narrow<float>(inverse(rotated(diagonal(b + c, a + c, a + b), random.rotation<3>())));
    return weight;
}

/// Two random bodies and a contact of one point in the middle of its patch.
template <int D>
struct Touch {
    Motion<D, float> a, b;
    Weight<D, float> wa, wb;
    Vec<D, float> arm_a, arm_b;  ///< of the point
    ContactRows<D, float> rows;

    explicit Touch(Random& random)
        : a(random_motion<D>(random)),
          b(random_motion<D>(random)),
          wa(random_weight<D>(random)),
          wb(random_weight<D>(random)),
          arm_a(random_vec<D>(random, 1)),
          arm_b(random_vec<D>(random, 1)) {
        set_normal(rows, narrow<float>(random.direction<D>()));
        const ContactFrame<D, float> frame = frame_of(rows);
        const auto& t = frame.tangents;
        rows.arm_a = to_frame(frame, arm_a);
        rows.arm_b = to_frame(frame, arm_b);
        weigh();
        NormalRow<D, float>& p = rows.points[0];
        p.mass = 1 / softness_along(rows.normal);
        const float k11 = softness_along(t[0]);
        if constexpr (D == 2) {
            rows.patch_mass[0] = 1 / k11;
        } else {
            const float k22 = softness_along(t[1]);
            // The mixed entry from that of the sum: (t1 + t2)ᵀ K (t1 + t2) = k11 + 2 k12 + k22.
            const float k12 = 0.5f * (softness_along(t[0] + t[1]) - k11 - k22);
            const float det = k11 * k22 - k12 * k12;
            rows.patch_mass = {k22 / det, -k12 / det, k11 / det};
            rows.twist_mass = 1 / dot(rows.normal, (wa.inertia + wb.inertia) * rows.normal);
        }
        rows.rolling_mass = inverse(wa.inertia + wb.inertia);
    }
    void weigh() {
        if constexpr (D == 3) {
            const ContactFrame<3, float> frame = frame_of(rows);
            rows.response = response_of(rows, wa, wb, inertia_to_frame(frame, wa.inertia),
                                        inertia_to_frame(frame, wb.inertia));
        }
    }
    float softness_along(const Vec<D, float>& n) const { return compliance(n, arm_a, arm_b, wa, wb); }
    Vec<D, float> velocity() const { return relative_velocity(a, b, arm_a, arm_b); }
    Vec<D, float> slip() const { return velocity() - dot(velocity(), rows.normal) * rows.normal; }
    float approach() const { return -dot(rows.normal, velocity()); }
};

TYPED_TEST(RowsIn, ComplianceIsTheVelocityThatAUnitImpulseMakes) {
    constexpr int D = TypeParam::value;
    Random random(1);
    for (int i = 0; i < 100; ++i) {
        Touch<D> t(random);
        const float before = -t.approach();
        push(t.a, t.b, t.wa, t.wb, t.arm_a, t.arm_b, t.rows.normal);
        EXPECT_NEAR(-t.approach() - before, 1 / t.rows.points[0].mass, rounding);
    }
}

TYPED_TEST(RowsIn, APushIsEqualAndOpposite) {
    constexpr int D = TypeParam::value;
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        Touch<D> t(random);
        const Motion<D, float> a = t.a, b = t.b;
        push(t.a, t.b, t.wa, t.wb, t.arm_a, t.arm_b, random_vec<D>(random, 2));
        const Vec<D, float> on_a = (t.a.v - a.v) / t.wa.mass.x, on_b = (t.b.v - b.v) / t.wb.mass.x;
        EXPECT_LT(length(on_a + on_b), rounding);
        // Neither body gets angular momentum about the point of contact.
        const Angular<D, float> la = inverse(t.wa.inertia) * (t.a.w - a.w) - cross(t.arm_a, on_a);
        const Angular<D, float> lb = inverse(t.wb.inertia) * (t.b.w - b.w) - cross(t.arm_b, on_b);
        EXPECT_LT(size(la) + size(lb), rounding);
    }
}

TYPED_TEST(RowsIn, AHardContactStopsTheApproachAndNeverPulls) {
    constexpr int D = TypeParam::value;
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        Touch<D> t(random);
        const float before = t.approach();
        solve_normals<false>(t.rows, t.a, t.b, t.wa, t.wb, sub);
        EXPECT_NEAR(t.approach(), std::min(before, 0.0f), rounding);
        EXPECT_GE(t.rows.points[0].impulse, 0);
        EXPECT_EQ(t.rows.points[0].impulse > 0, before > 0);
    }
}

TYPED_TEST(RowsIn, AGapIsLeftToClose) {
    constexpr int D = TypeParam::value;
    Random random(4);
    for (int i = 0; i < 200; ++i) {
        Touch<D> t(random);
        t.rows.points[0].separation = 0.01f;
        const float before = t.approach();
        solve_normals<true>(t.rows, t.a, t.b, t.wa, t.wb, sub);
        EXPECT_NEAR(t.approach(), std::min(before, 0.01f * 240), rounding)
            << "as fast as closes it in a sub-step";
    }
}

TYPED_TEST(RowsIn, AnOverlapIsPushedApartNotFasterThanAllowed) {
    constexpr int D = TypeParam::value;
    Random random(5);
    for (int i = 0; i < 100; ++i) {
        Touch<D> t(random);
        t.a = t.b = {};
        const bool firm = i % 4 < 2, slight = i % 2;
        t.rows.firm = firm ? 1 : 0;
        t.rows.points[0].separation = slight ? -0.01f : -100;
        solve_normals<true>(t.rows, t.a, t.b, t.wa, t.wb, sub);
        EXPECT_NEAR(-t.approach(), !slight ? 3 : firm ? 0.01 * 40 * 0.9 : 0.01 * 20 * 0.8, rounding);
    }
}

/// Between its points a contact keeps only the motion at its centre up to date. What comes out is what comes
/// out when the bodies get each impulse at once.
TYPED_TEST(RowsIn, PointsAreSolvedOneAfterTheOther) {
    constexpr int D = TypeParam::value;
    Random random(13);
    int pushing = 0;
    for (int i = 0; i < 200; ++i) {
        Touch<D> t(random);
        const ContactFrame<D, float> frame = frame_of(t.rows);
        std::array<Vec<D, float>, max_points<D>> arms_a, arms_b;
        for (int k = 0; k < max_points<D>; ++k) {
            const Vec<D, float> place = random_vec<D>(random, 0.5);
            t.rows.points[k].mass = 1;
            arms_a[k] = t.arm_a + place;
            arms_b[k] = t.arm_b + place;
        }
        place_points(t.rows, frame, arms_a, arms_b);
        t.weigh();
        Motion<D, float> a = t.a, b = t.b;
        std::array<float, max_points<D>> impulses;
        for (int k = 0; k < max_points<D>; ++k) {
            NormalRow<D, float>& p = t.rows.points[k];
            EXPECT_LT(length(arm_a(t.rows, p) - arms_a[k]) + length(arm_b(t.rows, p) - arms_b[k]), 1e-6f);
            p.mass = 1 / compliance(frame.normal, arms_a[k], arms_b[k], t.wa, t.wb);
            p.impulse = static_cast<float>(random.between(0, 1));
            const float speed = dot(frame.normal, relative_velocity(a, b, arms_a[k], arms_b[k]));
            impulses[k] = std::max(p.impulse - p.mass * speed, 0.0f);
            push(a, b, t.wa, t.wb, arms_a[k], arms_b[k], (impulses[k] - p.impulse) * frame.normal);
        }
        solve_normals<false>(t.rows, t.a, t.b, t.wa, t.wb, sub);
        for (int k = 0; k < max_points<D>; ++k) {
            EXPECT_NEAR(t.rows.points[k].impulse, impulses[k], rounding);
            pushing += impulses[k] > 0;
        }
        EXPECT_LT(length(a.v - t.a.v) + length(b.v - t.b.v), rounding);
        EXPECT_LT(size(Angular<D, float>(a.w - t.a.w)) + size(Angular<D, float>(b.w - t.b.w)), rounding);
    }
    EXPECT_GT(pushing, 100);
}

/// A gap grows as the ends of the arms part.
TYPED_TEST(RowsIn, GapsGrowAsTheArmsPart) {
    constexpr int D = TypeParam::value;
    Random random(14);
    for (int i = 0; i < 100; ++i) {
        Touch<D> t(random);
        NormalRow<D, float>& p = t.rows.points[0];
        p.place = random_vec<D>(random, 0.5);
        p.separation = 0.25f;
        const double share = 0.01;
        for (Motion<D, float>* m : {&t.a, &t.b}) {
            m->moved = random_vec<D>(random, 1);
            m->turned = random_spin<D>(random) * static_cast<float>(share);
        }
        const auto end = [](const Motion<D, float>& m, const Vec<D, float>& arm) {
            Angular<D> turned;
            if constexpr (D == 2)
                turned = m.turned;
            else
                turned = narrow<double>(m.turned);
            return narrow<double>(m.moved) +
                   (rotate(exp_rotation<D>(turned), narrow<double>(arm)) - narrow<double>(arm));
        };
        const Vec<D> parted = end(t.b, arm_b(t.rows, p)) - end(t.a, arm_a(t.rows, p));
        EXPECT_NEAR(gap(t.rows, p, t.a, t.b), 0.25 + dot(narrow<double>(t.rows.normal), parted), 3e-4)
            << "the rest of the series: angle³ / 6 a metre";
    }
}

/// Coulomb: where the impulse stays inside the cone the slip ends; else it lies on the cone. It never drives.
TYPED_TEST(RowsIn, FrictionSticksInsideTheConeAndSlipsOnIt) {
    constexpr int D = TypeParam::value;
    Random random(6);
    int stuck = 0, slid = 0;
    for (int i = 0; i < 300; ++i) {
        Touch<D> t(random);
        t.rows.friction = static_cast<float>(random.between(0, 1));
        const auto load = static_cast<float>(random.between(0, 3));
        const float limit = t.rows.friction * load;
        const Vec<D, float> slip = t.slip();
        solve_patch(t.rows, t.a, t.b, t.wa, t.wb, load);
        const Vec<D, float> impulse = along_tangents(t.rows, t.rows.friction_impulse);
        EXPECT_LE(length(impulse), limit + rounding);
        EXPECT_LE(dot(impulse, slip), rounding);
        const bool inside = length(impulse) < limit - rounding;
        (inside ? stuck : slid)++;
        EXPECT_TRUE(!inside || length(t.slip()) < rounding);
    }
    EXPECT_GT(stuck, 20);
    EXPECT_GT(slid, 20);
}

/// In space, for a ball on the ground, where an impulse in any direction changes the slip along itself: the
/// impulse is against the slip, whatever its direction.
TEST(Rows, FrictionIsACone) {
    for (int degrees = 0; degrees < 360; degrees += 15) {
        Random random(7);
        Touch<3> t(random);
        t.a = t.b = {};
        t.wa = {};
        t.wb = {{1, 1, 1}, diagonal(2.5f, 2.5f, 2.5f)};
        set_normal(t.rows, {0, 1, 0});
        t.rows.arm_a = {};
        t.rows.arm_b = to_frame(frame_of(t.rows), {0, -1, 0});
        t.rows.patch_mass = {1 / 3.5f, 0, 1 / 3.5f};
        t.rows.friction = 0.5f;
        const double angle = degrees * pi / 180;
        t.b.v = narrow<float>(Vec3{10 * std::cos(angle), 0, 10 * std::sin(angle)});
        const Vec<3, float> direction = normalized(t.b.v);
        solve_patch(t.rows, t.a, t.b, t.wa, t.wb, 2.0f);
        EXPECT_LT(length(t.b.v - 9.0f * direction), 3e-6f) << degrees;
    }
}

/// A belt: friction that holds makes the bodies move as the surfaces run, the other way round.
TYPED_TEST(RowsIn, FrictionAimsAtTheSpeedOfTheSurfaces) {
    constexpr int D = TypeParam::value;
    Random random(12);
    for (int i = 0; i < 100; ++i) {
        Touch<D> t(random);
        t.rows.friction = 1000;
        for (int k = 0; k < D - 1; ++k) t.rows.surface_speed[k] = static_cast<float>(random.between(-2, 2));
        solve_patch(t.rows, t.a, t.b, t.wa, t.wb, 1000.0f);
        EXPECT_LT(length(t.slip() + along_tangents(t.rows, t.rows.surface_speed)), rounding);
    }
}

TYPED_TEST(RowsIn, RollingResistanceEndsTheSpinWithinItsLimit) {
    constexpr int D = TypeParam::value;
    Random random(8);
    int ended = 0, limited = 0;
    for (int i = 0; i < 200; ++i) {
        Touch<D> t(random);
        t.rows.rolling = static_cast<float>(random.between(0, 3));
        const auto load = static_cast<float>(random.between(0, 3));
        const float limit = t.rows.rolling * load;
        solve_rolling(t.rows, t.a, t.b, t.wa, t.wb, load);
        const float impulse = size(t.rows.rolling_impulse);
        EXPECT_LE(impulse, limit + rounding);
        const bool inside = impulse < limit - rounding;
        (inside ? ended : limited)++;
        EXPECT_TRUE(!inside || size(Angular<D, float>(t.b.w - t.a.w)) < rounding);
    }
    EXPECT_GT(ended, 20);
    EXPECT_GT(limited, 20);
}

/// What the rows keep is what they did: applied to the bodies as they were, it gives the same motion.
TYPED_TEST(RowsIn, WarmStartRepeatsWhatTheRowsHold) {
    constexpr int D = TypeParam::value;
    Random random(9);
    for (int i = 0; i < 100; ++i) {
        Touch<D> t(random);
        t.rows.friction = 0.5f;
        t.rows.rolling = 0.2f;
        if constexpr (D == 3) t.rows.points[0].lever = 0.3f;
        Motion<D, float> a = t.a, b = t.b;
        solve_normals<false>(t.rows, t.a, t.b, t.wa, t.wb, sub);
        solve_friction(t.rows, t.a, t.b, t.wa, t.wb);
        warm_start(t.rows, a, b, t.wa, t.wb);
        EXPECT_LT(length(a.v - t.a.v) + length(b.v - t.b.v), rounding);
        EXPECT_LT(size(Angular<D, float>(b.w - t.b.w)), rounding);
    }
}

TYPED_TEST(RowsIn, SolvingNeverAddsEnergy) {
    constexpr int D = TypeParam::value;
    Random random(10);
    for (int i = 0; i < 200; ++i) {
        Touch<D> t(random);
        t.rows.friction = static_cast<float>(random.between(0, 1));
        t.rows.rolling = static_cast<float>(random.between(0, 0.5));
        if constexpr (D == 3) t.rows.points[0].lever = 0.3f;
        const auto energy = [&] {
            const auto of = [](const auto& m, const auto& w) {
                return dot(m.v, m.v) / w.mass.x + angular_dot(m.w, inverse(w.inertia) * m.w);
            };
            return of(t.a, t.wa) + of(t.b, t.wb);
        };
        const float before = energy();
        solve_normals<false>(t.rows, t.a, t.b, t.wa, t.wb, sub);
        solve_friction(t.rows, t.a, t.b, t.wa, t.wb);
        EXPECT_LE(energy(), before * (1 + 1e-5f));
    }
}

/// The height of the end of an arm after a turn is right to third order in the angle.
TYPED_TEST(RowsIn, TheRiseOfAnArmIsOfSecondOrder) {
    constexpr int D = TypeParam::value;
    Random random(11);
    for (int i = 0; i < 50; ++i) {
        const Vec<D> arm = random.in_cube<D>(1), normal = random.direction<D>();
        const Angular<D, float> turn = random_spin<D>(random);
        const auto error = [&](float share) {
            const Angular<D, float> turned = turn * share;
            Angular<D> exact;
            if constexpr (D == 2)
                exact = turned;
            else
                exact = narrow<double>(turned);
            const double expected = dot(normal, rotate(exp_rotation<D>(exact), arm) - arm);
            const Vec<D, float> n = narrow<float>(normal), r = narrow<float>(arm);
            const ContactFrame<D, float> frame{n, tangents<D>(n)};
            return std::fabs(dot(rise(frame, turned), to_frame(frame, r)) - expected);
        };
        for (const float share : {0.2f, 0.1f, 0.05f}) {
            const double angle = share * size(turn);
            EXPECT_LE(error(share), angle * angle * angle / 6 * length(arm) + 1e-6)
                << "the rest of the series";
        }
    }
}

}  // namespace
}  // namespace carom::detail
