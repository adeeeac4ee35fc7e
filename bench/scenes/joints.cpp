#include "scenes/builders.hpp"

namespace carom::bench {
namespace {

constexpr double pi = 3.14159265358979323846;

template <int D>
void join(World<D>& world, const decltype(JointDefinition<D>::kind)& kind, BodyId<D> a, BodyId<D> b) {
    JointDefinition<D> joint;
    joint.kind = kind;
    joint.a = a;
    joint.b = b;
    world.add_joint(joint);
}

}  // namespace

/// A net of balls that hangs from its upper edge, or from the middle of that. Joints between two fixed balls,
/// which the original has as well, are left out.
template <int D>
BenchWorld<D> joint_grid() {
    constexpr int side = 100;
    WorldDefinition<D> definition = bench_world<D>();
    definition.sleep = false;
    BenchWorld<D> bench{World<D>(definition)};
    std::vector<BodyId<D>> balls;
    for (int k = 0; k < side; ++k)
        for (int i = 0; i < side; ++i) {
            BodyDefinition<D> ball;
            const bool hangs = i > 0 || (D == 2 && (k < side / 2 - 3 || k > side / 2 + 3));
            ball.type = hangs ? BodyType::dynamic : BodyType::fixed;
            ball.position = make_vec<D>(k, -i, 0);
            ShapeDefinition<D>& shape = ball.shapes.emplace_back();
            shape.geometry = Ball{0.4};
            shape.material.density = D == 2 ? 1 : 1000;
            shape.filter.category = 2;
            shape.filter.mask = ~std::uint64_t{2};
            balls.push_back(bench.world.add_body(ball));
            const auto tie = [&](int other, double x, double y) {
                const BodyId<D> a = balls[static_cast<std::size_t>(other)], b = balls.back();
                if (bench.world.type(a) == BodyType::fixed && bench.world.type(b) == BodyType::fixed) return;
                const Vec<D> anchor = make_vec<D>(x, y, 0);
                if constexpr (D == 2)
                    join<D>(bench.world, HingeJoint<D>{.anchor = anchor}, a, b);
                else
                    join<D>(bench.world, BallJoint<D>{.anchor = anchor}, a, b);
            };
            if (i > 0) tie(k * side + i - 1, k, 0.5 - i);
            if (k > 0) tie((k - 1) * side + i, k - 0.5, -i);
        }
    return bench;
}

template BenchWorld<2> joint_grid();
template BenchWorld<3> joint_grid();

BenchWorld<2> tumbler() {
    BenchWorld<2> bench{World<2>(bench_world<2>())};
    BodyDefinition<2> ground;
    ground.type = BodyType::fixed;
    const BodyId2 floor = bench.world.add_body(ground);
    BodyDefinition<2> drum;
    drum.position = {0, 10};
    for (const auto& [center, half] : {std::pair<Vec2, Vec2>{{10, 0}, {0.5, 10}},
                                       {{-10, 0}, {0.5, 10}},
                                       {{0, 10}, {10, 0.5}},
                                       {{0, -10}, {10, 0.5}}}) {
        ShapeDefinition<2>& wall = drum.shapes.emplace_back();
        wall.geometry = Box<2>{2.0 * half};
        wall.center = center;
        wall.material.density = 50;
    }
    const BodyId2 body = bench.world.add_body(drum);
    join<2>(bench.world,
            HingeJoint<2>{.anchor = {0, 10}, .motor = JointMotor{.speed = 25 * pi / 180, .max = 1e8}}, floor,
            body);
    for (int i = 0; i < 45; ++i)
        for (int j = 0; j < 45; ++j)
            bench.world.add_body(
                box_body<2>(BodyType::dynamic, {-9 + 0.4 * j, 1 + 0.4 * i}, {0.125, 0.125}, 1));
    return bench;
}

BenchWorld<2> spinner() {
    constexpr int vertices = 360, things = 6076;
    BenchWorld<2> bench{World<2>(bench_world<2>())};
    BodyDefinition<2> ground;
    ground.type = BodyType::fixed;
    Chain ring;
    ring.loop = true;
    for (int i = 0; i < vertices; ++i) {
        const Rotation2 turn = Rotation2::from_angle(-2 * pi * i / vertices);
        ring.points.push_back({40 * turn.c, 40 * turn.s + 32});
    }
    ground.shapes.emplace_back().geometry = ring;
    ground.shapes.back().material.friction = 0.1;
    const BodyId2 floor = bench.world.add_body(ground);
    BodyDefinition<2> arm;
    arm.position = {0, 12};
    arm.can_sleep = false;
    arm.shapes.emplace_back().geometry = Box<2>{{0.8 + 0.4, 40 + 0.4}, 0.2};
    arm.shapes.back().material.density = 1;
    arm.shapes.back().material.friction = 0;
    join<2>(bench.world, HingeJoint<2>{.anchor = {0, 12}, .motor = JointMotor{.speed = 5}}, floor,
            bench.world.add_body(arm));
    double x = -23, y = 2;
    for (int i = 0; i < things; ++i) {
        BodyDefinition<2> body;
        body.position = {x, y};
        ShapeDefinition<2>& shape = body.shapes.emplace_back();
        if (i % 3 == 0) shape.geometry = Capsule<2>{{-0.25, 0}, {0.25, 0}, 0.25};
        if (i % 3 == 1) shape.geometry = Ball{0.35};
        if (i % 3 == 2) shape.geometry = Box<2>{{0.7, 0.7}};
        shape.material.friction = 0.1;
        shape.material.restitution = 0.1;
        shape.material.density = 0.25;
        bench.world.add_body(body);
        x += 0.5;
        if (x < 23) continue;
        x = -23;
        y += 0.5;
    }
    return bench;
}

}  // namespace carom::bench
