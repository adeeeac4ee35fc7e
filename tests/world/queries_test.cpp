#include <thread>

#include "builders.hpp"
#include "collision/random.hpp"

namespace carom::test {
namespace {

template <class T>
class WorldQueriesTest : public testing::Test {};
TYPED_TEST_SUITE(WorldQueriesTest, BothDimensions);

template <int D>
Geometry<D> any_geometry(Random& random) {
    const double size = random.between(0.2, 1.5);
    const int kind = random.below(D == 2 ? 4 : 6);
    if (kind == 0) return Ball{0.5 * size};
    if (kind == 1) {
        Box<D> box{};
        for (int i = 0; i < D; ++i) box.size[i] = random.between(0.1, 1.5);
        box.rounding = random.below(2) ? 0.0 : 0.04;
        return box;
    }
    if (kind == 2) return Capsule<D>{random.in_cube<D>(size), random.in_cube<D>(size), 0.2 * size};
    if (kind == 3) {
        Hull<D> hull;
        for (int i = 0; i < 9; ++i) hull.points.push_back(random.in_cube<D>(size));
        hull.rounding = random.below(2) ? 0.0 : 0.05;
        return hull;
    }
    if constexpr (D == 3) {
        if (kind == 4) return Cylinder{0.5 * size, random.between(0.1, 2)};
        return Cone{0.5 * size, random.between(0.1, 2)};
    }
    return Ball{};
}

/// Bodies of all types and kinds about `base`, in a cube of the half length 20, on a plane.
template <int D>
World<D> any_world(Random& random, const Vec<D>& base, int bodies) {
    WorldDefinition<D> definition = no_gravity<D>();
    World<D> world(definition);
    BodyDefinition<D> floor = ground<D>();
    floor.position = base + vec<D>(0, -20);
    world.add_body(floor);
    for (int i = 0; i < bodies; ++i) {
        BodyDefinition<D> body;
        body.type = BodyType(random.below(3));
        body.position = base + random.in_cube<D>(20);
        body.rotation = random.rotation<D>();
        if (body.type != BodyType::fixed) body.velocity = random.in_cube<D>(5);
        for (int shapes = 1 + random.below(2); shapes > 0; --shapes) {
            ShapeDefinition<D> shape = shape_of<D>(any_geometry<D>(random));
            shape.center = random.in_cube<D>(1);
            shape.rotation = random.rotation<D>();
            shape.sensor = random.below(5) == 0 && !body.shapes.empty();
            shape.filter.category = std::uint64_t{1} << random.below(4);
            shape.filter.mask = random.below(2) ? ~std::uint64_t{0} : std::uint64_t(random.below(16));
            body.shapes.push_back(shape);
        }
        world.add_body(body);
    }
    return world;
}

template <int D>
struct Placed {
    ShapeId<D> id;
    BodyId<D> body;
    Solid<D> solid;
    Transform<D> transform;
};

/// Every shape of the world that the filter lets through, as the functions for two shapes take them.
template <int D>
std::vector<Placed<D>> all_shapes(const World<D>& world, const QueryFilter<D>& filter) {
    std::vector<Placed<D>> result;
    for (const BodyId<D>& body : world.bodies()) {
        for (const ShapeId<D>& id : world.shapes(body)) {
            const Filter& own = world.shape(id).filter;
            if (world.shape(id).sensor && !filter.sensors) continue;
            if (!(own.category & filter.mask) || !(own.mask & filter.category)) continue;
            if (filter.ignored == body || (filter.accepts && !filter.accepts(id))) continue;
            result.push_back({id, body, Solid<D>(world.shape(id)), world.transform(body)});
        }
    }
    std::sort(result.begin(), result.end(),
              [](const auto& a, const auto& b) { return a.id.index < b.id.index; });
    return result;
}

template <int D>
void expect_same(const std::optional<WorldHit<D>>& found, const std::vector<WorldHit<D>>& expected) {
    ASSERT_EQ(found.has_value(), !expected.empty());
    if (!found) return;
    EXPECT_EQ(found->shape, expected[0].shape);
    EXPECT_EQ(found->body, expected[0].body);
    // The functions for two shapes bring rotations to unit length once more.
    EXPECT_NEAR(found->fraction, expected[0].fraction, 1e-9);
    EXPECT_NEAR(length(found->point - expected[0].point), 0, 1e-7);
    EXPECT_NEAR(length(found->normal - expected[0].normal), 0, 1e-6);
}

/// Hits of single shapes, sorted as the world sorts them.
template <int D, class Cast>
std::vector<WorldHit<D>> brute_hits(const std::vector<Placed<D>>& shapes, const Cast& cast) {
    std::vector<WorldHit<D>> hits;
    for (const Placed<D>& s : shapes) {
        if (const auto hit = cast(s)) hits.push_back({s.id, s.body, hit->fraction, hit->point, hit->normal});
    }
    std::stable_sort(hits.begin(), hits.end(),
                     [](const auto& a, const auto& b) { return a.fraction < b.fraction; });
    return hits;
}

template <int D>
std::vector<ShapeId<D>> names(const std::vector<Placed<D>>& shapes, const auto& test) {
    std::vector<ShapeId<D>> result;
    for (const Placed<D>& s : shapes)
        if (test(s)) result.push_back(s.id);
    return result;
}

template <int D>
void expect_casts_as_brute_force(const World<D>& world, const std::vector<Placed<D>>& shapes,
                                 const QueryFilter<D>& filter, const Vec<D>& base, Random& random) {
    const Ray<D> ray{base + random.in_cube<D>(25), random.in_cube<D>(40)};
    const auto hits = brute_hits<D>(shapes, [&](const auto& s) {
        return cast_ray<D>(s.solid, s.transform, ray.origin, ray.translation);
    });
    expect_same<D>(world.cast_ray(ray, filter), hits);
    EXPECT_EQ(world.cast_ray_any(ray, filter), !hits.empty());
    const auto all = world.cast_ray_all(ray, filter);
    ASSERT_EQ(all.size(), hits.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].shape, hits[i].shape);
        EXPECT_NEAR(all[i].fraction, hits[i].fraction, 1e-9);
    }

    const Solid<D> moving{any_geometry<D>(random)};
    const Transform<D> placed{ray.origin, random.rotation<D>()};
    const auto swept = brute_hits<D>(shapes, [&](const auto& s) {
        return cast_shape<D>(moving, placed, ray.translation, s.solid, s.transform);
    });
    expect_same<D>(world.cast_shape(moving, placed, ray.translation, filter), swept);
    EXPECT_EQ(world.cast_shape_all(moving, placed, ray.translation, filter).size(), swept.size());
    EXPECT_EQ(world.overlapping(moving, placed, filter), names<D>(shapes, [&](const auto& s) {
                  return overlap<D>(moving, placed, s.solid, s.transform);
              }));
}

template <int D>
void expect_finds_as_brute_force(const World<D>& world, const std::vector<Placed<D>>& shapes,
                                 const QueryFilter<D>& filter, const Vec<D>& base, Random& random) {
    const Vec<D> point = base + random.in_cube<D>(20);
    EXPECT_EQ(world.at_point(point, filter),
              names<D>(shapes, [&](const auto& s) { return contains<D>(s.solid, s.transform, point); }));
    const double reach = random.between(0, 4);
    const auto near = world.nearest_point(point, reach, filter);
    double least = std::numeric_limits<double>::infinity();
    for (const Placed<D>& s : shapes) {
        const auto found =
            closest_points<D>(Geometry<D>(Ball{1e-9}), Transform<D>{point, {}}, s.solid, s.transform);
        least = std::min(least, found.distance);
    }
    const double rounding = 1e-8 + 1e-15 * length(base);
    if (least > reach + rounding) {
        EXPECT_FALSE(near);
    }
    if (least < reach - rounding) {
        ASSERT_TRUE(near);
        EXPECT_NEAR(near->distance, least, rounding);
        EXPECT_NEAR(length(near->point - point), near->distance, rounding);
        EXPECT_EQ(world.body_of(near->shape), near->body);
    }
}

TYPED_TEST(WorldQueriesTest, answer_as_trying_every_shape_does) {
    constexpr int D = TypeParam::value;
    for (const double away : {0.0, 1e7}) {
        Random random(7);
        Vec<D> base{};
        for (int i = 0; i < D; ++i) base[i] = away * (i + 1);
        World<D> world = any_world<D>(random, base, 300);
        const BodyId<D> ignored = world.bodies()[5];
        const QueryFilter<D> filters[] = {
            {},
            {.category = 2, .mask = 5},
            {.sensors = true, .ignored = ignored},
            {.accepts = [](ShapeId<D> id) { return id.index % 3 == 0; }},
        };
        for (int round = 0; round < 60; ++round) {
            SCOPED_TRACE("round " + std::to_string(round));
            const QueryFilter<D>& filter = filters[round % 4];
            const auto shapes = all_shapes<D>(world, filter);
            expect_casts_as_brute_force<D>(world, shapes, filter, base, random);
            expect_finds_as_brute_force<D>(world, shapes, filter, base, random);
            if (round % 3 == 0) world.step(frame_time);
            if (round % 10 == 5) {
                const BodyId<D> moved = world.bodies()[std::size_t(1 + random.below(300))];
                world.set_transform(moved, {base + random.in_cube<D>(20), random.rotation<D>()});
            }
        }
    }
}

TYPED_TEST(WorldQueriesTest, in_box_goes_by_exact_bounds) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    BodyDefinition<D> ball = body_of<D>(Ball{0.5});
    ball.velocity = vec<D>(100, 0);
    const BodyId<D> body = world.add_body(ball);
    const BodyId<D> floor = world.add_body(ground<D>());
    world.step(1e-3);
    const double x = world.position(body).x;
    const ShapeId<D> shape = world.shapes(body)[0], plane = world.shapes(floor)[0];
    const auto box = [](double from, double to) {
        return Aabb<D>{vec<D>(from, 0.1, -0.1), vec<D>(to, 0.2, 0.1)};
    };
    EXPECT_EQ(world.in_box(box(x + 0.4, x + 9)), (std::vector{shape}));
    EXPECT_EQ(world.in_box(box(x + 0.500001, x + 9)).size(), 0u)
        << "the tree's box is larger than the ball's";
    EXPECT_EQ(world.in_box({vec<D>(x - 1, -1, -1), vec<D>(x + 1, 1, 1)}), (std::vector{shape, plane}));
}

/// A box at rest is struck so that it leaves its fat box within the step.
TYPED_TEST(WorldQueriesTest, see_what_was_struck_where_it_is_now) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    const BodyId<D> target = world.add_body(body_of<D>(cube<D>(1)));
    BodyDefinition<D> bullet = body_of<D>(Ball{0.4}, vec<D>(-1, 0), {.density = 100000});
    bullet.velocity = vec<D>(60, 0);
    world.add_body(bullet);
    for (int i = 0; i < 3; ++i) {
        world.step(frame_time);
        EXPECT_EQ(world.at_point(world.position(target)).size(), 1u);
        const Vec<D> above = world.position(target) + vec<D>(0.45, 5);
        const auto hit = world.cast_ray({above, vec<D>(0, -10)});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->body, target);
        EXPECT_NEAR(hit->point.y, 0.5, 0.05);
    }
    EXPECT_GT(world.position(target).x, 1);
}

TYPED_TEST(WorldQueriesTest, of_several_threads_at_once_give_the_same_answers) {
    constexpr int D = TypeParam::value;
    Random random(11);
    const World<D> world = any_world<D>(random, {}, 400);
    std::vector<Ray<D>> rays;
    for (int i = 0; i < 5000; ++i) rays.push_back({random.in_cube<D>(25), random.in_cube<D>(40)});
    using Hits = std::vector<std::optional<WorldHit<D>>>;
    Hits one(rays.size()), shared(rays.size());
    world.cast_rays(rays, one);
    world.cast_rays(rays, shared, {}, 4);
    std::vector<Hits> own(3, Hits(rays.size()));
    {
        std::vector<std::jthread> threads;
        for (Hits& hits : own) {
            threads.emplace_back([&] {
                for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = world.cast_ray(rays[i]);
            });
        }
    }
    own.push_back(shared);
    for (const Hits& hits : own) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(hits[i].has_value(), one[i].has_value());
            if (one[i]) {
                ASSERT_EQ(hits[i]->shape, one[i]->shape);
                ASSERT_EQ(hits[i]->fraction, one[i]->fraction);
            }
        }
    }
}

/// Whatever the tree looks like: of several shapes at the same place the one with the lowest index is found.
TYPED_TEST(WorldQueriesTest, ties_go_to_the_lowest_index) {
    constexpr int D = TypeParam::value;
    World<D> world(no_gravity<D>());
    std::vector<BodyId<D>> bodies;
    for (int i = 0; i < 40; ++i) {
        BodyDefinition<D> body = body_of<D>(cube<D>(1));
        body.type = i % 2 ? BodyType::fixed : BodyType::dynamic;
        bodies.push_back(world.add_body(body));
    }
    for (int lowest = 0; lowest < 39; ++lowest) {
        const ShapeId<D> expected = world.shapes(bodies[std::size_t(lowest)])[0];
        EXPECT_EQ(world.cast_ray({vec<D>(-5, 0.25), vec<D>(9, 0)})->shape, expected);
        EXPECT_EQ(world.cast_ray_all({vec<D>(-5, 0.25), vec<D>(9, 0)})[1].shape,
                  world.shapes(bodies[std::size_t(lowest + 1)])[0]);
        EXPECT_EQ(world.cast_shape(Geometry<D>(Ball{1}), {vec<D>(-5, 0.25), {}}, vec<D>(9, 0))->shape,
                  expected);
        EXPECT_EQ(world.nearest_point(vec<D>(3, 3), 10)->shape, expected);
        EXPECT_EQ(world.nearest_point({}, 10)->shape, expected);
        world.remove_body(bodies[std::size_t(lowest)]);
    }
}

TYPED_TEST(WorldQueriesTest, find_nothing_in_an_empty_world) {
    constexpr int D = TypeParam::value;
    const World<D> world;
    EXPECT_FALSE(world.cast_ray({{}, vec<D>(1, 1)}));
    EXPECT_TRUE(world.cast_ray_all({{}, vec<D>(1, 1)}).empty());
    EXPECT_FALSE(world.cast_ray_any({{}, vec<D>(1, 1)}));
    EXPECT_FALSE(world.nearest_point({}, std::numeric_limits<double>::infinity()));
    EXPECT_TRUE(world.at_point({}).empty());
    world.cast_rays({}, {});
}

TYPED_TEST(WorldQueriesTest, refuse_what_has_no_answer) {
    constexpr int D = TypeParam::value;
    const World<D> world;
    const auto refusal = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const Error& error) {
            return error.what();
        }
        return "not refused";
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vec<D> lost = vec<D>(0, nan);
    const Solid<D> ball{Geometry<D>(Ball{})};
    EXPECT_EQ(refusal([&] { world.cast_ray({lost, {}}); }), "origin[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { world.cast_ray_any({{}, lost}); }), "translation[1]: nan is not finite");
    EXPECT_EQ(refusal([&] {
                  world.cast_ray_all({vec<D>(1e101, 0), {}});
              }),
              "origin[0]: 1e+101 is not between -1e+100 and 1e+100");
    EXPECT_EQ(refusal([&] {
                  world.cast_shape(ball, {lost, {}}, {});
              }),
              "placed.position[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { world.cast_shape(ball, {}, lost); }), "translation[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { world.overlapping(ball, {lost, {}}); }), "placed.position[1]: nan is not finite");
    EXPECT_EQ(refusal([&] {
                  world.in_box({vec<D>(1, 0), {}});
              }),
              "box.upper[0]: 0 is less than box.lower, 1");
    EXPECT_EQ(refusal([&] { world.at_point(lost); }), "point[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { world.nearest_point({}, -1); }), "max_distance: -1 is negative or not a number");
    const std::vector<Ray<D>> rays{{}, {{}, lost}};
    std::vector<std::optional<WorldHit<D>>> hits(2);
    EXPECT_EQ(refusal([&] { world.cast_rays(rays, hits); }), "rays[1].translation[1]: nan is not finite");
    EXPECT_EQ(refusal([&] { world.cast_rays(rays, hits, {}, 0); }), "threads: 0 is not between 1 and 256");
    hits.pop_back();
    EXPECT_EQ(refusal([&] { world.cast_rays(rays, hits); }), "hits: 1 are not as many as the 2 rays");
}

}  // namespace
}  // namespace carom::test
