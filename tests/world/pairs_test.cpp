#include <random>
#include <set>

#include "world/builders.hpp"

// Who meets whom in a crowd, while bodies come, go, fall asleep, wake, are moved, and cease to collide: held
// against all pairs, which are looked at one by one.

namespace carom::test {
namespace {

template <class T>
struct Pairs : testing::Test {};
TYPED_TEST_SUITE(Pairs, BothDimensions);

/// Raw draws, the same with every standard library.
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : engine_(seed) {}
    std::size_t below(std::size_t n) { return engine_() % n; }
    double between(double low, double high) { return low + (high - low) * double(engine_() >> 11) * 0x1p-53; }

  private:
    std::mt19937_64 engine_;
};

/// Balls that fly about in a heap without gravity; one in ten is fixed, one in ten stands or is moved by the
/// user, some are sensors, and one is as large as the heap.
template <int D>
class Heap {
  public:
    Heap(int count, int threads) : world_(settings()), draws_(5) {
        if (threads > 1) world_.set_scheduler(make_thread_pool(threads));
        half_ = D == 2 ? 0.3 * std::sqrt(double(count)) : 0.3 * std::cbrt(double(count));
        for (int i = 0; i < count; ++i) add();
    }

    /// What users do between two steps.
    void change() {
        for (int i = 0; i < 6; ++i) remove(draws_.below(bodies_.size()));
        for (int i = 0; i < 6; ++i) add();
        for (int i = 0; i < 6; ++i) world_.set_transform(any(), {place(), {}});
        for (int i = 0; i < 20; ++i) {
            const BodyId<D> body = any();
            if (world_.type(body) == BodyType::dynamic) world_.put_to_sleep(body);
        }
        for (int i = 0; i < 4; ++i) world_.wake(any());
        for (int i = 0; i < 2; ++i) world_.set_type(any(), BodyType::kinematic);
        for (int i = 0; i < 20; ++i) {
            const BodyId<D> a = any(), b = any();
            if (a != b) set_collision(a, b, false);
        }
        // Neighbours, too, and some of these again.
        const std::vector<Contact<D>> contacts = world_.contacts();
        for (std::size_t i = 0; i < contacts.size(); i += 40)
            set_collision(contacts[i].body_a, contacts[i].body_b, false);
        if (parted_.size() > 100) {
            const auto [a, b] = *std::next(parted_.begin(), std::ptrdiff_t(draws_.below(parted_.size())));
            set_collision(handle(a), handle(b), true);
        }
    }

    /// A step, before which all are looked at.
    void step_and_compare() {
        const std::vector<BodyId<D>> bodies = bodies_;
        std::vector<Vec<D>> places;
        for (const BodyId<D> body : bodies) places.push_back(world_.position(body));
        std::set<Key> overlapping;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                const double gap = length(places[i] - places[k]) - radius(bodies[i]) - radius(bodies[k]);
                if (gap < -1e-6 && must_meet(bodies[i], bodies[k]))
                    overlapping.insert(key(bodies[i], bodies[k]));
            }
        }
        world_.step(frame_time);
        std::set<Key> touching;
        for (const Contact<D>& c : world_.contacts()) {
            touching.insert(key(c.body_a, c.body_b));
            ASSERT_FALSE(parted_.contains(key(c.body_a, c.body_b)));
        }
        found_ += overlapping.size();
        for (const Key& pair : overlapping)
            ASSERT_TRUE(touching.contains(pair)) << pair.first << ' ' << pair.second;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            if (!senses(bodies[i])) continue;
            std::set<std::uint32_t> seen;
            for (const ShapeId<D>& shape : world_.inside(world_.shapes(bodies[i])[0]))
                seen.insert(shape.index);
            for (std::size_t k = 0; k < bodies.size(); ++k) {
                if (i == k) continue;
                const double reach = radius(bodies[i]) + radius(bodies[k]);
                const bool was_inside = length(places[i] - places[k]) < reach;
                const bool is_inside =
                    length(world_.position(bodies[i]) - world_.position(bodies[k])) < reach;
                const bool is_seen = seen.contains(world_.shapes(bodies[k])[0].index);
                // Who is pushed into a sensor while a step is worked out may be noticed in the next.
                if (is_seen || (was_inside && may_be_sensed(bodies[i], bodies[k]))) {
                    ASSERT_EQ(is_seen, is_inside) << bodies[i].index << ' ' << bodies[k].index;
                }
                visits_ += is_seen;
            }
        }
    }

    std::uint64_t hash() const { return world_.hash(); }
    void step() {
        world_.set_profiling(true);
        world_.step(frame_time);
    }
    std::size_t pairs() const { return world_.profile().pairs; }
    /// Sends all that moves far apart.
    void scatter() {
        double x = 0;
        for (const BodyId<D> body : bodies_) world_.set_transform(body, {vec<D>(x += 100, 0), {}});
    }
    std::size_t found() const { return found_; }
    std::size_t visits() const { return visits_; }

  private:
    using Key = std::pair<std::uint32_t, std::uint32_t>;

    static WorldDefinition<D> settings() {
        WorldDefinition<D> definition = no_gravity<D>();
        definition.sleep = true;
        return definition;
    }
    static Key key(BodyId<D> a, BodyId<D> b) { return std::minmax(a.index, b.index); }
    BodyId<D> any() { return bodies_[draws_.below(bodies_.size())]; }
    BodyId<D> handle(std::uint32_t index) const {
        return *std::ranges::find(bodies_, index, &BodyId<D>::index);
    }
    Vec<D> place() {
        Vec<D> v;
        for (int i = 0; i < D; ++i) v[i] = draws_.between(-half_, half_);
        return v;
    }
    double radius(BodyId<D> body) const {
        return std::get<Ball>(world_.shape(world_.shapes(body)[0]).geometry).radius;
    }
    bool senses(BodyId<D> body) const { return world_.shape(world_.shapes(body)[0]).sensor; }
    /// Are the two sure to be looked at in the next step, if they overlap? Of several fixed shapes that
    /// overlap one may touch for all, so these are left to the sensors.
    bool must_meet(BodyId<D> a, BodyId<D> b) const {
        if (world_.type(a) == BodyType::fixed || world_.type(b) == BodyType::fixed) return false;
        const auto moves = [&](BodyId<D> body) {
            return world_.type(body) == BodyType::dynamic && world_.awake(body);
        };
        return (moves(a) || moves(b)) && !senses(a) && !senses(b) && !parted_.contains(key(a, b));
    }
    bool may_be_sensed(BodyId<D> sensor, BodyId<D> other) const {
        return !senses(other) &&
               (world_.type(sensor) != BodyType::fixed || world_.type(other) != BodyType::fixed);
    }
    void set_collision(BodyId<D> a, BodyId<D> b, bool enabled) {
        world_.set_collision(a, b, enabled);
        enabled ? void(parted_.erase(key(a, b))) : void(parted_.insert(key(a, b)));
    }
    void add() {
        const std::size_t kind = draws_.below(10);
        BodyDefinition<D> body;
        body.type = kind == 0 ? BodyType::fixed : kind == 1 ? BodyType::kinematic : BodyType::dynamic;
        body.position = place();
        body.velocity = (1 / half_) * place();
        if (body.type != BodyType::dynamic && draws_.below(2) == 0) body.velocity = {};
        if (body.type == BodyType::fixed) body.velocity = {};
        const double own = bodies_.size() == 50 ? half_ : draws_.between(0.1, 0.4);
        body.shapes.push_back({Ball{own}});
        body.shapes[0].sensor = draws_.below(30) == 0;
        bodies_.push_back(world_.add_body(body));
    }
    void remove(std::size_t which) {
        const std::uint32_t index = bodies_[which].index;
        std::erase_if(parted_, [&](const Key& pair) { return pair.first == index || pair.second == index; });
        world_.remove_body(bodies_[which]);
        bodies_.erase(bodies_.begin() + std::ptrdiff_t(which));
    }

    World<D> world_;
    Draws draws_;
    double half_ = 1;
    std::vector<BodyId<D>> bodies_;
    std::set<Key> parted_;
    std::size_t found_ = 0, visits_ = 0;
};

TYPED_TEST(Pairs, AreAllThatOverlapWhateverBecomesOfTheBodies) {
    constexpr int D = TypeParam::value;
    Heap<D> heap(700, 1);
    for (int step = 0; step < 40; ++step) {
        if (step % 3 == 1) heap.change();
        heap.step_and_compare();
        if (this->HasFatalFailure()) FAIL() << "in step " << step;
    }
    EXPECT_GT(heap.found(), 4000u);
    EXPECT_GT(heap.visits(), 1000u);
    heap.scatter();
    heap.step();
    EXPECT_EQ(heap.pairs(), 0u);
}

TYPED_TEST(Pairs, AreFoundInTheSameOrderByAnyNumberOfThreads) {
    constexpr int D = TypeParam::value;
    std::vector<Heap<D>> heaps;
    for (const int threads : {1, 2, 3, 8}) heaps.emplace_back(2500, threads);
    for (int step = 0; step < 12; ++step) {
        for (Heap<D>& heap : heaps) {
            if (step % 3 == 1) heap.change();
            heap.step();
            ASSERT_EQ(heap.pairs(), heaps[0].pairs()) << step;
            ASSERT_EQ(heap.hash(), heaps[0].hash()) << step;
        }
    }
    EXPECT_GT(heaps[0].pairs(), 2000u);
}

/// Its box is unbounded on all sides.
TYPED_TEST(Pairs, WithASlantedPlaneAreFoundWheneverBodiesCome) {
    constexpr int D = TypeParam::value;
    constexpr double radius = 0.1, slope = 0.3;
    const Vec<D> normal = vec<D>(-std::sin(slope), std::cos(slope)), along = vec<D>(normal.y, -normal.x);
    World<D> world;
    BodyDefinition<D> ground;
    ground.type = BodyType::fixed;
    ground.shapes = {shape_of<D>(Plane<D>{normal, 0})};
    world.add_body(ground);
    int balls = 0;
    for (const int more : {3, 2, 100, 1}) {  // a hundred are looked at together
        for (int i = 0; i < more; ++i, ++balls) {
            BodyDefinition<D> ball;
            ball.position = 0.5 * balls * along + radius * normal;
            ball.shapes = {shape_of<D>(Ball{radius})};
            world.add_body(ball);
        }
        world.step(frame_time);
        EXPECT_EQ(static_cast<int>(world.counts().contacts), balls);
    }
}

}  // namespace
}  // namespace carom::test
