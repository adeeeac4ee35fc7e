#include "solver/solver.hpp"

#include <gtest/gtest.h>

#include <set>

#include <cstring>

#include "collision/random.hpp"
#include "simd/width.hpp"

namespace carom::detail {
namespace {

using test::Random;

std::vector<int> widths() {
    std::vector<int> all;
    for (const int width : {1, 4, 8, 16}) {
        if (can_run_lanes(width)) all.push_back(width);
    }
    return all;
}

/// Bodies and contacts without a world around them.
template <int D>
struct Scene {
    std::vector<BodyState<D>> states;
    std::vector<BodyMass<D>> masses;
    std::vector<BodyType> types;
    std::vector<Load<D>> loads;
    std::vector<ContactRecord<D>> contacts;
    double gravity = 10;

    std::uint32_t add(BodyType type, const Vec<D>& position, double mass) {
        BodyState<D> state;
        state.position = position;
        BodyMass<D> m;
        if (type == BodyType::dynamic) {
            m.mass = mass;
            m.inverse_mass = 1 / mass;
            if constexpr (D == 2) {
                m.inertia = mass / 6;
                m.inverse_inertia = 6 / mass;
            } else {
                m.inertia = diagonal(mass / 6, mass / 6, mass / 6);
                m.inverse_inertia = diagonal(6 / mass, 6 / mass, 6 / mass);
            }
        }
        states.push_back(state);
        masses.push_back(m);
        types.push_back(type);
        loads.push_back({});
        loads.back().force[1] = -gravity * m.mass;
        return static_cast<std::uint32_t>(states.size() - 1);
    }
    /// A contact at points halfway between the bodies' centres, `width` apart.
    void touch(std::uint32_t a, std::uint32_t b, double width, double gap, double friction) {
        ContactRecord<D> c;
        c.body_a = a;
        c.body_b = b;
        c.friction = static_cast<float>(friction);
        const Vec<D> way = states[b].position - states[a].position;
        c.normal = narrow<float>(normalized(way));
        const auto t = tangents<D>(normalized(way));
        c.count = D == 2 ? 2 : 4;
        for (int k = 0; k < c.count; ++k) {
            Vec<D> aside = ((k & 1) ? width : -width) * t[0];
            if constexpr (D == 3) aside += ((k & 2) ? width : -width) * t[1];
            ContactRecordPoint<D>& p = c.points[k];
            p.arm_a = narrow<float>(0.5 * way + aside);
            p.arm_b = narrow<float>(-0.5 * way + aside);
            p.separation = static_cast<float>(gap);
        }
        contacts.push_back(c);
    }
    void step(Solver<D>& solver, double dt = 1.0 / 60) {
        std::vector<std::uint32_t> awake;
        for (std::uint32_t i = 0; i < states.size(); ++i) {
            if (types[i] != BodyType::fixed) awake.push_back(i);
        }
        solver.follow(awake, types, [](std::uint32_t) {});
        for (std::uint32_t i = 0; i < contacts.size(); ++i) {
            contacts[i].place ? solver.write(contacts[i], nullptr) : solver.add(i, contacts[i], nullptr);
        }
        const std::vector<BodyState<D>> before = states;
        solver.run({states, masses, loads, nullptr, true, dt, 4, 1});
        ContactCache<D> none;
        for (ContactRecord<D>& c : contacts) solver.read(none, c);
        // As if nothing turned, which is good enough for gaps of things at rest.
        for (ContactRecord<D>& c : contacts) {
            const auto way = [&](std::uint32_t body) {
                return states[body].position - before[body].position;
            };
            const double opened = dot(narrow<double>(c.normal), way(c.body_b) - way(c.body_a));
            for (int k = 0; k < c.count; ++k) c.points[k].separation += static_cast<float>(opened);
        }
    }
};

template <class T>
class SolverIn : public testing::Test {
  protected:
    ~SolverIn() override { set_lane_width(0); }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(SolverIn, Dimensions);

template <int D>
Vec<D> at(double x, double y) {
    Vec<D> v;
    v[0] = x;
    v[1] = y;
    return v;
}

TYPED_TEST(SolverIn, ABoxOnTheGroundStaysAndThePointsCarryItsWeight) {
    constexpr int D = TypeParam::value;
    for (const int width : widths()) {
        set_lane_width(width);
        Scene<D> scene;
        const auto ground = scene.add(BodyType::fixed, at<D>(0, -0.5), 0);
        const auto box = scene.add(BodyType::dynamic, at<D>(0, 0.5), 3);
        scene.touch(ground, box, 0.5, 0, 0.5);
        Solver<D> solver;
        for (int i = 0; i < 30; ++i) scene.step(solver);
        EXPECT_LT(length(scene.states[box].velocity), 1e-4);
        EXPECT_LT(length(scene.states[box].position - at<D>(0, 0.5)), 1e-4);
        EXPECT_EQ(length(scene.states[ground].position - at<D>(0, -0.5)), 0);
        double sum = 0;
        for (const auto& p : scene.contacts[0].points) sum += p.total_impulse;
        EXPECT_NEAR(sum, 3 * 10 / 60.0, 1e-3 * 3 * 10 / 60.0);
    }
}

/// The surface of the ground runs to the right: relative to it, that of the box runs to the left.
TYPED_TEST(SolverIn, ABeltCarriesABoxAtItsSpeed) {
    constexpr int D = TypeParam::value;
    Scene<D> scene;
    const auto ground = scene.add(BodyType::fixed, at<D>(0, -0.5), 0);
    const auto box = scene.add(BodyType::dynamic, at<D>(0, 0.5), 3);
    scene.touch(ground, box, 0.5, 0, 0.5);
    scene.contacts[0].surface_velocity = narrow<float>(at<D>(-1, 0));
    Solver<D> solver;
    for (int i = 0; i < 6; ++i) scene.step(solver);
    EXPECT_NEAR(scene.states[box].velocity.x, 0.5 * 10 * 6 / 60.0, 0.01)
        << "sliding, with all the friction there is";
    for (int i = 0; i < 30; ++i) scene.step(solver);
    EXPECT_NEAR(scene.states[box].velocity.x, 1, 1e-3);
}

/// A heap that touches itself in random places: colours, overflow, kinematic and fixed bodies, contacts that
/// begin and that end.
template <int D>
Scene<D> heap(std::uint64_t seed) {
    Random random(seed);
    Scene<D> scene;
    scene.add(BodyType::fixed, at<D>(0, -1), 0);
    const auto platform = scene.add(BodyType::kinematic, at<D>(1, -1), 0);
    scene.states[platform].velocity = at<D>(0.5, 0.1);
    for (int i = 0; i < 60; ++i) {
        Vec<D> place = random.in_cube<D>(3);
        place[1] = std::fabs(place[1]);
        const auto body = scene.add(BodyType::dynamic, place, random.between(0.5, 2));
        scene.states[body].velocity = random.in_cube<D>(1);
        scene.masses[body].linear_damping = i % 3 == 0 ? 0.5 : 0;
        if (i % 7 == 0) {
            scene.masses[body].locks.x = true;
        }
    }
    for (std::uint32_t i = 2; i < 62; ++i) scene.touch(2, i == 2 ? 0 : i, 0.2, i % 2 ? 0.001 : -0.001, 0.4);
    for (int i = 0; i < 150; ++i) {
        const auto a = static_cast<std::uint32_t>(random.between(0, 61.99));
        const auto b = static_cast<std::uint32_t>(random.between(2, 61.99));
        if (a == b) continue;
        scene.touch(a, b, random.between(0, 0.3), random.between(-0.01, 0.02), random.between(0, 1));
        ContactRecord<D>& c = scene.contacts.back();
        c.count = static_cast<int>(random.between(1, c.count + 0.99));
        if (i % 5 == 0) c.restitution = 0.5f;
        if (i % 4 == 0) c.rolling = 0.1f;
        if (i % 6 == 0) c.roundness_b = 0.3f;
        if (i % 9 == 0) c.surface_velocity = narrow<float>(random.in_cube<D>(1));
    }
    return scene;
}

TYPED_TEST(SolverIn, TheBitsAreTheSameForAnyWidth) {
    constexpr int D = TypeParam::value;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        std::vector<Scene<D>> results;
        for (const int width : widths()) {
            set_lane_width(width);
            results.push_back(heap<D>(seed));
            Solver<D> solver;
            for (int i = 0; i < 5; ++i) results.back().step(solver);
        }
        const Scene<D>& first = results[0];
        EXPECT_GT(length(first.states[10].position - heap<D>(seed).states[10].position), 0);
        for (const Scene<D>& other : results) {
            for (std::size_t i = 0; i < first.states.size(); ++i) {
                EXPECT_EQ(other.states[i].position, first.states[i].position);
                EXPECT_EQ(other.states[i].velocity, first.states[i].velocity);
                EXPECT_EQ(other.states[i].angular_velocity, first.states[i].angular_velocity);
            }
            for (std::size_t i = 0; i < first.contacts.size(); ++i) {
                for (int k = 0; k < first.contacts[i].count; ++k) {
                    EXPECT_EQ(other.contacts[i].points[k].impulse, first.contacts[i].points[k].impulse);
                    EXPECT_EQ(other.contacts[i].points[k].total_impulse,
                              first.contacts[i].points[k].total_impulse);
                }
                EXPECT_EQ(other.contacts[i].total_friction, first.contacts[i].total_friction);
                EXPECT_EQ(other.contacts[i].spin_impulse, first.contacts[i].spin_impulse);
            }
        }
    }
}

/// Contacts that come and go leave nothing behind: a fresh solver goes on just the same with those that stay.
TYPED_TEST(SolverIn, WhatWasRemovedIsForgotten) {
    constexpr int D = TypeParam::value;
    for (const int width : widths()) {
        set_lane_width(width);
        Scene<D> kept = heap<D>(7), other = heap<D>(7);
        Solver<D> used;
        for (int i = 0; i < 3; ++i) {
            kept.step(used);
            Solver<D> fresh;
            other.step(fresh);
            for (std::size_t k = 0; k < kept.states.size(); ++k) {
                EXPECT_EQ(kept.states[k].position, other.states[k].position);
                EXPECT_EQ(kept.states[k].velocity, other.states[k].velocity);
            }
            // First the last, the first, and one in between; then all.
            const auto count = static_cast<std::uint32_t>(kept.contacts.size());
            std::vector<std::uint32_t> order{count - 1, 0, count / 2};
            for (std::uint32_t k = 0; k < count; ++k) order.push_back(k);
            for (const std::uint32_t k : order) {
                if (!kept.contacts[k].place) continue;
                const std::uint32_t index = kept.contacts[k].place.index;
                const std::uint32_t moved = used.remove(kept.contacts[k]);
                if (moved != Solver<D>::none) kept.contacts[moved].place.index = index;
            }
            EXPECT_EQ(used.contacts(), 0u);
            for (ContactRecord<D>& c : other.contacts) c.place = {};
        }
    }
}

/// Contacts follow their bodies as these fall asleep, wake, and are moved by the user.
TYPED_TEST(SolverIn, ContactsAreLetGoWithTheirBodies) {
    constexpr int D = TypeParam::value;
    Scene<D> scene = heap<D>(3);
    Solver<D> solver;
    scene.step(solver);
    std::vector<std::uint32_t> awake;
    for (std::uint32_t i = 1; i < scene.states.size(); ++i) {
        if (i != 20) awake.push_back(i);
    }
    std::set<std::uint32_t> let_go;
    const auto remove = [&](std::uint32_t i) {
        let_go.insert(i);
        const std::uint32_t index = scene.contacts[i].place.index;
        const std::uint32_t moved = solver.remove(scene.contacts[i]);
        if (moved != Solver<D>::none) scene.contacts[moved].place.index = index;
    };
    EXPECT_TRUE(solver.follow(awake, scene.types, remove));
    for (std::uint32_t i = 0; i < scene.contacts.size(); ++i) {
        const ContactRecord<D>& c = scene.contacts[i];
        EXPECT_EQ(let_go.contains(i), c.body_a == 20 || c.body_b == 20) << i;
        EXPECT_EQ(static_cast<bool>(c.place), !let_go.contains(i)) << i;
    }
    EXPECT_FALSE(let_go.empty());
    EXPECT_FALSE(solver.follow(awake, scene.types, remove)) << "nothing has changed since";
}

/// A body that has become non-finite spoils nothing that it does not touch.
TYPED_TEST(SolverIn, NothingPassesThroughWhatStandsStill) {
    constexpr int D = TypeParam::value;
    for (const int width : widths()) {
        set_lane_width(width);
        Scene<D> scene;
        const auto ground = scene.add(BodyType::fixed, at<D>(0, -0.5), 0);
        for (int i = 0; i < 20; ++i) {
            const auto box = scene.add(BodyType::dynamic, at<D>(0, 0.5), 1);
            scene.touch(ground, box, 0.5, 0, 0.5);
        }
        scene.states[5].velocity = at<D>(0, -std::numeric_limits<double>::infinity());
        Solver<D> solver;
        scene.step(solver);
        for (std::size_t i = 1; i < scene.states.size(); ++i) {
            if (i == 5) continue;
            EXPECT_LT(length(scene.states[i].velocity), 0.01) << i;
        }
    }
}

}  // namespace
}  // namespace carom::detail
