#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <utility>

#include "collision/random.hpp"
#include "simd/width.hpp"
#include "world/builders.hpp"

// The same calls give the same bits, and the hash tells worlds apart.

namespace carom::test {
namespace {

/// Bodies of many kinds that fall into a heap, with springs and wind.
template <int D>
World<D> heap(const WorldDefinition<D>& definition = {}) {
    Random random(12);
    World<D> world(definition);
    world.add_body(ground<D>());
    for (int i = 0; i < 25; ++i) {
        const Vec<D> half = vec<D>(0.2, 0.1);
        Geometry<D> geometry = Ball{0.3};
        if (i % 3 == 1) geometry = cube<D>(0.5);
        if (i % 3 == 2) geometry = Capsule<D>{-half, half, 0.2};
        BodyDefinition<D> d = body_of<D>(geometry, random.in_cube<D>(0.5));
        d.position.y = 1 + 0.6 * i;
        d.rotation = random.rotation<D>();
        world.add_body(d);
    }
    world.add_force({Wind<D>{vec<D>(2, 0), 1.2}, 0.5, 1});
    Spring<D> spring;
    spring.b = world.bodies()[3];
    spring.stiffness = 500;
    world.add_force({spring});
    return world;
}

template <class T>
class Determinism : public testing::Test {};
TYPED_TEST_SUITE(Determinism, BothDimensions);

TYPED_TEST(Determinism, RepeatedRunsAreEqualInEveryStep) {
    constexpr int D = TypeParam::value;
    World<D> first = heap<D>(), second = heap<D>();
    std::set<std::uint64_t> seen;
    for (int i = 0; i < 240; ++i) {
        ASSERT_EQ(first.hash(), second.hash()) << "step " << i;
        EXPECT_TRUE(seen.insert(first.hash()).second) << "no two steps are alike";
        first.step(frame_time);
        second.step(frame_time);
    }
}

/// The lanes are 1, 4, 8 or 16 wide, as far as this processor goes.
TYPED_TEST(Determinism, AnyLaneWidthGivesTheSameBits) {
    constexpr int D = TypeParam::value;
    std::vector<std::uint64_t> hashes;
    for (const int width : {1, 4, 8, 16}) {
        if (!detail::can_run_lanes(width)) continue;
        detail::set_lane_width(width);
        World<D> world = heap<D>();
        run(world, 240);
        hashes.push_back(world.hash());
    }
    detail::set_lane_width(0);
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

/// A crowd that is large enough for several threads.
template <int D>
World<D> crowd() {
    World<D> world;
    world.add_body(ground<D>());
    Random random(3);
    for (int i = 0; i < 400; ++i) {
        Geometry<D> geometry = cube<D>(0.5);
        if (i % 5 == 1) geometry = Ball{0.25};
        if (i % 5 == 2) geometry = Capsule<D>{-vec<D>(0.2, 0), vec<D>(0.2, 0), 0.15};
        BodyDefinition<D> d = body_of<D>(geometry, vec<D>(0.53 * (i % 20), 0.27 + 0.53 * (i / 20)));
        d.position += random.in_cube<D>(0.02);
        d.bullet = i % 50 == 0;
        world.add_body(d);
    }
    return world;
}

TYPED_TEST(Determinism, AnyNumberOfThreadsGivesTheSameBits) {
    constexpr int D = TypeParam::value;
    World<D> alone = crowd<D>();
    run(alone, 20);
    EXPECT_GT(alone.counts().contacts, 300) << "enough that several threads are used";
    for (const int threads : {2, 4}) {
        World<D> world = crowd<D>();
        world.set_scheduler(make_thread_pool(threads));
        run(world, 20);
        EXPECT_EQ(world.hash(), alone.hash()) << threads;
    }
}

TYPED_TEST(Determinism, AMovedWorldGoesOnAsIfNothingHadBeen) {
    constexpr int D = TypeParam::value;
    World<D> stays = heap<D>(), goes = heap<D>();
    run(stays, 60);
    run(goes, 60);
    World<D> there = std::move(goes);
    EXPECT_EQ(there.hash(), stays.hash());
    run(stays, 60);
    run(there, 60);
    EXPECT_EQ(there.hash(), stays.hash());
    World<D> other;
    other = std::move(there);
    run(stays, 30);
    run(other, 30);
    EXPECT_EQ(other.hash(), stays.hash());
}

/// Reading changes nothing.
TYPED_TEST(Determinism, ReadingLeavesNoTrace) {
    constexpr int D = TypeParam::value;
    World<D> read = heap<D>(), unread = heap<D>();
    for (int i = 0; i < 120; ++i) {
        read.step(frame_time);
        unread.step(frame_time);
        read.contacts();
        read.energy();
        for (const BodyId<D>& body : read.bodies()) read.velocity_at(body, {});
    }
    EXPECT_EQ(read.hash(), unread.hash());
}

/// Handles carry generations, so a world in which a body came and went is another by its hash; but the
/// bodies move the same, bit by bit.
TYPED_TEST(Determinism, ABodyThatCameAndWentChangesNoMotion) {
    constexpr int D = TypeParam::value;
    World<D> plain, used;
    used.remove_body(used.add_body(body_of<D>(Ball{1}, vec<D>(0, 3))));
    for (World<D>* world : {&plain, &used}) {
        world->add_body(ground<D>());
        for (int i = 0; i < 6; ++i) world->add_body(body_of<D>(cube<D>(0.5), vec<D>(0.1 * i, 0.5 + 0.7 * i)));
    }
    EXPECT_NE(plain.hash(), used.hash());
    run(plain, 120);
    run(used, 120);
    for (std::size_t i = 0; i < plain.bodies().size(); ++i)
        EXPECT_EQ(plain.transform(plain.bodies()[i]), used.transform(used.bodies()[i]));
}

/// Whatever the next step depends on is in the hash.
TYPED_TEST(Determinism, TheHashTellsWorldsApart) {
    constexpr int D = TypeParam::value;
    using W = World<D>;
    const auto first = [](W& w) { return w.bodies()[1]; };
    const std::vector<std::pair<const char*, std::function<void(W&)>>> changes{
        {"gravity", [](W& w) { w.set_gravity(vec<D>(0, -9)); }},
        {"position",
         [=](W& w) {
             w.set_transform(first(w), {vec<D>(0, 40), {}});
         }},
        {"velocity", [=](W& w) { w.set_velocity(first(w), vec<D>(1e-12, 0)); }},
        {"spin", [=](W& w) { w.set_angular_velocity(first(w), spin<D>(1e-12)); }},
        {"type", [=](W& w) { w.set_type(first(w), BodyType::kinematic); }},
        {"gravity scale", [=](W& w) { w.set_gravity_scale(first(w), 0.5); }},
        {"linear damping", [=](W& w) { w.set_damping(first(w), 0.1, 0); }},
        {"angular damping", [=](W& w) { w.set_damping(first(w), 0, 0.1); }},
        {"locks",
         [=](W& w) {
             w.set_locks(first(w), {false, false, false, false, false, true});
         }},
        {"mass",
         [=](W& w) {
             w.set_mass_properties(first(w), {1, {}, unit_body<D>().inertia.value()});
         }},
        {"sleep", [=](W& w) { w.put_to_sleep(first(w)); }},
        {"force", [=](W& w) { w.apply_force(first(w), vec<D>(1, 0)); }},
        {"torque", [=](W& w) { w.apply_torque(first(w), spin<D>(1)); }},
        {"generator",
         [](W& w) {
             w.add_force({PointGravity<D>{{}, 1}});
         }},
        {"new body", [](W& w) { w.add_body(body_of<D>(Ball{1}, vec<D>(90, 0))); }},
        {"removed body", [=](W& w) { w.remove_body(first(w)); }},
        {"new shape", [=](W& w) { w.add_shape(first(w), shape_of<D>(Ball{0.1})); }},
        {"time", [](W& w) { w.step(frame_time); }},
    };
    std::set<std::uint64_t> hashes{heap<D>().hash()};
    for (const auto& [name, change] : changes) {
        World<D> world = heap<D>();
        change(world);
        EXPECT_TRUE(hashes.insert(world.hash()).second) << name;
    }
    const std::vector<std::pair<const char*, std::function<void(WorldDefinition<D>&)>>> settings{
        {"substeps", [](auto& w) { w.substeps = 5; }},
        {"integrator", [](auto& w) { w.integrator = Integrator::verlet; }},
        {"joints", [](auto& w) { w.joints = JointMethod::direct; }},
        {"sleep", [](auto& w) { w.sleep = false; }},
        {"threshold", [](auto& w) { w.restitution_threshold = 0.5; }},
    };
    for (const auto& [name, change] : settings) {
        WorldDefinition<D> definition;
        change(definition);
        EXPECT_TRUE(hashes.insert(heap<D>(definition).hash()).second) << name;
    }
    for (double Material::*const part :
         {&Material::friction, &Material::restitution, &Material::rolling_resistance}) {
        World<D> world = heap<D>();
        Material material;
        material.*part = 0.25;
        world.add_body(body_of<D>(Ball{1}, vec<D>(90, 0), material));
        EXPECT_TRUE(hashes.insert(world.hash()).second) << "a part of the material";
    }
}

/// A setup that is its own mirror image stays nearly one: what falls on the left does so on the right. The
/// points of a contact are solved one after the other, so boxes that tumble differ by millimetres.
TEST(Symmetry, AMirroredSetupStaysMirrored) {
    World2 world(sleepless<2>());
    world.add_body(ground<2>());
    std::vector<std::pair<BodyId2, BodyId2>> pairs;
    for (int i = 0; i < 4; ++i) {
        std::vector<BodyId2> both;
        for (const double side : {-1.0, 1.0}) {
            BodyDefinition2 d = body_of<2>(i % 2 ? Geometry<2>{Box2{{0.6, 0.4}}} : Geometry<2>{Ball{0.3}});
            d.position = {side * (1 + 1.5 * i), 1 + 0.2 * i};
            d.velocity = {side * 0.5, 0};
            d.angular_velocity = -side;
            both.push_back(world.add_body(d));
        }
        pairs.push_back({both[0], both[1]});
    }
    for (int i = 0; i < 120; ++i) {
        world.step(frame_time);
        for (const auto& [left, right] : pairs) {
            const Vec2 l = world.position(left), r = world.position(right);
            ASSERT_NEAR(l.x, -r.x, 2e-2) << "step " << i;
            ASSERT_NEAR(l.y, r.y, 2e-2) << "step " << i;
            ASSERT_NEAR(world.angle(left), -world.angle(right), 5e-2) << "step " << i;
        }
    }
}

}  // namespace
}  // namespace carom::test
