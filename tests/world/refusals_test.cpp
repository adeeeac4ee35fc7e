#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "world/builders.hpp"

// Whatever cannot be simulated is refused: the error names the field, and the world is as before the call,
// now and later.

namespace carom::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A small world with one of everything, and handles that name nothing any more.
template <int D>
struct Scene {
    World<D> world;
    BodyId<D> floor, box, ball, lift, bare, dead;
    ShapeId<D> only_shape, dead_shape;
    ForceId<D> force, dead_force;

    Scene() {
        floor = world.add_body(ground<D>());
        box = world.add_body(body_of<D>(cube<D>(1), vec<D>(0, 0.6)));
        ball = world.add_body(body_of<D>(Ball{0.4}, vec<D>(0.3, 2)));
        BodyDefinition<D> moved = body_of<D>(cube<D>(1), vec<D>(4, 1));
        moved.type = BodyType::kinematic;
        moved.velocity = vec<D>(-0.5, 0);
        lift = world.add_body(moved);
        BodyDefinition<D> nothing;
        nothing.type = BodyType::fixed;
        bare = world.add_body(nothing);
        dead = world.add_body(body_of<D>(Ball{1}, vec<D>(50, 0)));
        dead_shape = world.shapes(dead)[0];
        only_shape = world.shapes(ball)[0];
        force = world.add_force({Drag<D>{std::nullopt, 0.1, 0.1}});
        dead_force = world.add_force({Wind<D>{}});
        world.remove_force(dead_force);
        world.remove_body(dead);
        run(world, 20);
    }
};

template <int D>
struct BadCall {
    std::string field;  ///< that the message must name
    std::function<void(Scene<D>&)> call;
};

template <int D>
void expect_refusals(const std::vector<BadCall<D>>& calls) {
    Scene<D> tried, untouched;
    ASSERT_EQ(tried.world.hash(), untouched.world.hash());
    for (std::size_t i = 0; i < calls.size(); ++i) {
        SCOPED_TRACE("call " + std::to_string(i) + ", " + calls[i].field);
        const std::uint64_t before = tried.world.hash();
        const Counts counts = tried.world.counts();
        std::string message;
        try {
            calls[i].call(tried);
            ADD_FAILURE() << "it was not refused";
            return;
        } catch (const Error& error) {
            message = error.what();
        }
        EXPECT_NE(message.find(calls[i].field), std::string::npos) << message;
        EXPECT_EQ(tried.world.hash(), before);
        EXPECT_EQ(tried.world.counts().bodies, counts.bodies);
        EXPECT_EQ(tried.world.counts().shapes, counts.shapes);
        EXPECT_EQ(tried.world.counts().forces, counts.forces);
    }
    for (int i = 0; i < 50; ++i) {
        tried.world.step(frame_time);
        untouched.world.step(frame_time);
        ASSERT_EQ(tried.world.hash(), untouched.world.hash()) << "step " << i;
    }
    // The next handles are the same, too.
    EXPECT_EQ(tried.world.add_body(body_of<D>(Ball{1})), untouched.world.add_body(body_of<D>(Ball{1})));
    EXPECT_EQ(tried.world.add_shape(tried.box, shape_of<D>(Ball{1})),
              untouched.world.add_shape(untouched.box, shape_of<D>(Ball{1})));
    EXPECT_EQ(tried.world.add_force({Wind<D>{}}), untouched.world.add_force({Wind<D>{}}));
}

/// Adding a sound body, spoilt by `spoil`.
template <int D>
BadCall<D> bad_body(const std::string& field, const std::function<void(BodyDefinition<D>&)>& spoil) {
    return {field, [=](Scene<D>& s) {
                BodyDefinition<D> d = body_of<D>(cube<D>(1), vec<D>(0, 9));
                d.shapes.push_back(shape_of<D>(Ball{0.5}));
                spoil(d);
                s.world.add_body(d);
            }};
}

/// The same shape on a new body and on one that is there.
template <int D>
void add_bad_shape(std::vector<BadCall<D>>& calls, const std::string& field,
                   const std::function<void(ShapeDefinition<D>&)>& spoil) {
    calls.push_back(bad_body<D>("shapes[1]." + field, [=](BodyDefinition<D>& d) { spoil(d.shapes[1]); }));
    calls.push_back({field, [=](Scene<D>& s) {
                         ShapeDefinition<D> shape = shape_of<D>(Ball{0.5});
                         spoil(shape);
                         s.world.add_shape(s.box, shape);
                     }});
}

template <int D>
BadCall<D> bad_force(const std::string& field, const ForceDefinition<D>& definition) {
    return {field, [=](Scene<D>& s) { s.world.add_force(definition); }};
}

template <int D>
Rotation<D> not_unit() {
    if constexpr (D == 2)
        return {2, 0};
    else
        return {0, 0, 0, 2};
}
/// A spin with one component that is not a number.
template <int D>
Angular<D> bad_spin() {
    if constexpr (D == 2)
        return nan;
    else
        return {0, nan, 0};
}
template <int D>
Inertia<D> negative_inertia() {
    if constexpr (D == 2)
        return -1;
    else
        return {1, 1, 1, 0, 2, 0};  // its determinant is negative
}

template <class T>
class Refusals : public testing::Test {};
TYPED_TEST_SUITE(Refusals, BothDimensions);

TYPED_TEST(Refusals, OfBodies) {
    constexpr int D = TypeParam::value;
    using Definition = BodyDefinition<D>;
    expect_refusals<D>({
        bad_body<D>("position[0]", [](Definition& d) { d.position.x = nan; }),
        bad_body<D>("position[1]", [](Definition& d) { d.position.y = -infinity; }),
        bad_body<D>("rotation", [](Definition& d) { d.rotation = not_unit<D>(); }),
        bad_body<D>("velocity[1]", [](Definition& d) { d.velocity.y = infinity; }),
        bad_body<D>("angular_velocity", [](Definition& d) { d.angular_velocity = bad_spin<D>(); }),
        bad_body<D>("mass", [](Definition& d) { d.mass = 0; }),
        bad_body<D>("mass", [](Definition& d) { d.mass = -2; }),
        bad_body<D>("mass", [](Definition& d) { d.mass = nan; }),
        bad_body<D>("mass", [](Definition& d) { d.mass = 1e-310; }),
        bad_body<D>("mass", [](Definition& d) { d.shapes.clear(); }),
        bad_body<D>("mass",
                    [](Definition& d) {
                        for (auto& shape : d.shapes) shape.material.density = 0;
                    }),
        bad_body<D>("center_of_mass", [](Definition& d) { d.center_of_mass = vec<D>(0, nan); }),
        bad_body<D>("inertia", [](Definition& d) { d.inertia = negative_inertia<D>(); }),
        bad_body<D>("inertia", [](Definition& d) { d.inertia = Inertia<D>{}; }),
        bad_body<D>("gravity_scale", [](Definition& d) { d.gravity_scale = infinity; }),
        bad_body<D>("linear_damping", [](Definition& d) { d.linear_damping = -0.1; }),
        bad_body<D>("angular_damping", [](Definition& d) { d.angular_damping = nan; }),
        bad_body<D>("shapes[0]",
                    [](Definition& d) {
                        d.shapes[0].geometry = Plane<D>{vec<D>(0, 1), 0};
                    }),
        {"body", [](Scene<D>& s) { s.world.remove_body(s.dead); }},
        {"body", [](Scene<D>& s) { s.world.remove_body({}); }},
        {"body",
         [](Scene<D>& s) {
             s.world.remove_body({1000, 1});
         }},
    });
}

TYPED_TEST(Refusals, OfShapes) {
    constexpr int D = TypeParam::value;
    using Definition = ShapeDefinition<D>;
    std::vector<BadCall<D>> calls;
    const auto bad = [&](const std::string& field, const std::function<void(Definition&)>& spoil) {
        add_bad_shape<D>(calls, field, spoil);
    };
    bad("radius", [](Definition& s) { s.geometry = Ball{-1}; });
    bad("radius", [](Definition& s) { s.geometry = Ball{0}; });
    bad("radius", [](Definition& s) { s.geometry = Ball{nan}; });
    bad("radius", [](Definition& s) { s.geometry = Ball{1e300}; });
    bad("size[0]", [](Definition& s) { s.geometry = Box<D>{vec<D>(0, 1, 1)}; });
    bad("size[1]", [](Definition& s) { s.geometry = Box<D>{vec<D>(1, infinity, 1)}; });
    bad("rounding", [](Definition& s) { s.geometry = Box<D>{vec<D>(1, 1, 1), 0.51}; });
    bad("rounding", [](Definition& s) { s.geometry = Box<D>{vec<D>(1, 1, 1), -0.1}; });
    bad("from", [](Definition& s) { s.geometry = Capsule<D>{vec<D>(nan, 0), vec<D>(1, 0), 0.1}; });
    bad("radius", [](Definition& s) { s.geometry = Capsule<D>{vec<D>(0, 0), vec<D>(1, 0), 0}; });
    bad("points", [](Definition& s) { s.geometry = Hull<D>{}; });
    bad("points", [](Definition& s) {
        Hull<D> flat;
        for (int i = 0; i < 9; ++i) flat.points.push_back(vec<D>(i, 2 * i, 3 * i));
        s.geometry = flat;
    });
    bad("points", [](Definition& s) {
        Hull<D> hull;
        for (int i = 0; i < 9; ++i) hull.points.push_back(vec<D>(i % 2, i / 2 % 2, i / 4 % 2));
        hull.points[4].y = nan;
        s.geometry = hull;
    });
    bad("center", [](Definition& s) { s.center.y = nan; });
    bad("rotation", [](Definition& s) { s.rotation = not_unit<D>(); });
    bad("density", [](Definition& s) { s.material.density = -1; });
    bad("friction", [](Definition& s) { s.material.friction = nan; });
    bad("restitution", [](Definition& s) { s.material.restitution = 1.01; });
    bad("rolling_resistance", [](Definition& s) { s.material.rolling_resistance = -0.1; });
    if constexpr (D == 3) {
        bad("height", [](Definition& s) { s.geometry = Cylinder{1, 0}; });
        bad("radius", [](Definition& s) { s.geometry = Cone{-1, 1}; });
    }
    const auto plane_with = [](double offset, double y) {
        return [=](Scene<D>& s) { s.world.add_shape(s.floor, shape_of<D>(Plane<D>{vec<D>(0, y), offset})); };
    };
    calls.push_back({"offset", plane_with(infinity, 1)});
    calls.push_back({"normal", plane_with(0, 0)});
    calls.push_back({"normal", plane_with(0, nan)});
    calls.push_back({"plane", [](Scene<D>& s) {
                         s.world.add_shape(s.lift, shape_of<D>(Plane<D>{vec<D>(0, 1), 0}));
                     }});
    calls.push_back({"body", [](Scene<D>& s) { s.world.add_shape(s.dead, shape_of<D>(Ball{1})); }});
    calls.push_back({"shape", [](Scene<D>& s) { s.world.remove_shape(s.dead_shape); }});
    calls.push_back({"shape", [](Scene<D>& s) { s.world.remove_shape({}); }});
    calls.push_back({"mass", [](Scene<D>& s) { s.world.remove_shape(s.only_shape); }});
    expect_refusals<D>(calls);
}

TYPED_TEST(Refusals, OfForces) {
    constexpr int D = TypeParam::value;
    const auto spring_on = [](BodyId<D> b) {
        Spring<D> spring;
        spring.b = b;
        return spring;
    };
    std::vector<BadCall<D>> calls{
        bad_force<D>("from", {Wind<D>{}, -1, 2}),
        bad_force<D>("from", {Wind<D>{}, nan, 2}),
        bad_force<D>("to", {Wind<D>{}, 3, 2}),
        bad_force<D>("to", {Wind<D>{}, 0, nan}),
        bad_force<D>("velocity", {Wind<D>{vec<D>(nan, 0), 1}}),
        bad_force<D>("density", {Wind<D>{vec<D>(1, 0), -1}}),
        bad_force<D>("linear", {Drag<D>{std::nullopt, -1, 0}}),
        bad_force<D>("quadratic", {Drag<D>{std::nullopt, 0, infinity}}),
        bad_force<D>("center", {PointGravity<D>{vec<D>(0, nan), 1}}),
        bad_force<D>("gm", {PointGravity<D>{vec<D>(0, 0), infinity}}),
        bad_force<D>("body", {ConstantForce<D>{}}),
        bad_force<D>("body", {ConstantTorque<D>{}}),
        bad_force<D>("body", {TimedImpulse<D>{}}),
        bad_force<D>("body", {Drag<D>{BodyId<D>{7, 7}, 1, 1}}),
        bad_force<D>("body", {Spring<D>{}}),
        {"force", [](Scene<D>& s) { s.world.remove_force(s.dead_force); }},
        {"force", [](Scene<D>& s) { s.world.remove_force({}); }},
    };
    const auto on_box = [&](const std::string& field,
                            const std::function<ForceDefinition<D>(BodyId<D>)>& make) {
        calls.push_back({field, [=](Scene<D>& s) { s.world.add_force(make(s.box)); }});
    };
    on_box("value", [](BodyId<D> b) -> ForceDefinition<D> { return {ConstantForce<D>{b, vec<D>(0, nan)}}; });
    on_box("point", [](BodyId<D> b) -> ForceDefinition<D> {
        return {ConstantForce<D>{b, vec<D>(0, 1), vec<D>(infinity, 0)}};
    });
    on_box("value", [](BodyId<D> b) -> ForceDefinition<D> { return {ConstantTorque<D>{b, bad_spin<D>()}}; });
    on_box("value", [](BodyId<D> b) -> ForceDefinition<D> { return {TimedImpulse<D>{b, vec<D>(nan, 0)}}; });
    on_box("at", [](BodyId<D> b) -> ForceDefinition<D> {
        return {TimedImpulse<D>{b, vec<D>(1, 0), std::nullopt, -1}};
    });
    on_box("stiffness", [=](BodyId<D> b) -> ForceDefinition<D> {
        Spring<D> spring = spring_on(b);
        spring.stiffness = -1;
        return {spring};
    });
    on_box("damping", [=](BodyId<D> b) -> ForceDefinition<D> {
        Spring<D> spring = spring_on(b);
        spring.damping = nan;
        return {spring};
    });
    on_box("length", [=](BodyId<D> b) -> ForceDefinition<D> {
        Spring<D> spring = spring_on(b);
        spring.length = -1;
        return {spring};
    });
    on_box("anchor_b", [=](BodyId<D> b) -> ForceDefinition<D> {
        Spring<D> spring = spring_on(b);
        spring.anchor_b.x = nan;
        return {spring};
    });
    on_box("body", [=](BodyId<D> b) -> ForceDefinition<D> {
        Spring<D> spring = spring_on(b);
        spring.a = BodyId<D>{500, 3};
        return {spring};
    });
    expect_refusals<D>(calls);
}

TYPED_TEST(Refusals, OfChanges) {
    constexpr int D = TypeParam::value;
    const auto with_mass = [](double mass, double y, const Inertia<D>& inertia) {
        return [=](Scene<D>& s) { s.world.set_mass_properties(s.box, {mass, vec<D>(0, y), inertia}); };
    };
    const Inertia<D> sound = unit_body<D>().inertia.value();
    expect_refusals<D>({
        {"gravity", [](Scene<D>& s) { s.world.set_gravity(vec<D>(nan, 0)); }},
        {"dt", [](Scene<D>& s) { s.world.step(0); }},
        {"dt", [](Scene<D>& s) { s.world.step(-1); }},
        {"dt", [](Scene<D>& s) { s.world.step(nan); }},
        {"dt", [](Scene<D>& s) { s.world.step(1.5); }},
        {"position",
         [](Scene<D>& s) {
             s.world.set_transform(s.box, {vec<D>(0, nan), {}});
         }},
        {"rotation",
         [](Scene<D>& s) {
             s.world.set_transform(s.box, {vec<D>(0, 1), not_unit<D>()});
         }},
        {"velocity", [](Scene<D>& s) { s.world.set_velocity(s.box, vec<D>(infinity, 0)); }},
        {"velocity", [](Scene<D>& s) { s.world.set_velocity(s.floor, vec<D>(1, 0)); }},
        {"angular_velocity", [](Scene<D>& s) { s.world.set_angular_velocity(s.box, bad_spin<D>()); }},
        {"angular_velocity", [](Scene<D>& s) { s.world.set_angular_velocity(s.floor, spin<D>(1)); }},
        {"type", [](Scene<D>& s) { s.world.set_type(s.floor, BodyType::dynamic); }},
        {"mass", [](Scene<D>& s) { s.world.set_type(s.bare, BodyType::dynamic); }},
        {"gravity_scale", [](Scene<D>& s) { s.world.set_gravity_scale(s.box, nan); }},
        {"linear_damping", [](Scene<D>& s) { s.world.set_damping(s.box, -1, 0); }},
        {"angular_damping", [](Scene<D>& s) { s.world.set_damping(s.box, 1, -1); }},
        {"mass", with_mass(0, 0, sound)},
        {"mass", with_mass(nan, 0, sound)},
        {"center", with_mass(1, nan, sound)},
        {"inertia", with_mass(1, 0, negative_inertia<D>())},
        {"body", [](Scene<D>& s) { s.world.put_to_sleep(s.floor); }},
        {"body", [](Scene<D>& s) { s.world.put_to_sleep(s.lift); }},
        {"force", [](Scene<D>& s) { s.world.apply_force(s.box, vec<D>(nan, 0)); }},
        {"force", [](Scene<D>& s) { s.world.apply_force(s.box, vec<D>(infinity, 0), vec<D>(0, 0)); }},
        {"point", [](Scene<D>& s) { s.world.apply_force(s.box, vec<D>(1, 0), vec<D>(0, nan)); }},
        {"torque", [](Scene<D>& s) { s.world.apply_torque(s.box, bad_spin<D>()); }},
        {"impulse", [](Scene<D>& s) { s.world.apply_impulse(s.box, vec<D>(nan, 0)); }},
        {"point", [](Scene<D>& s) { s.world.apply_impulse(s.box, vec<D>(1, 0), vec<D>(nan, 0)); }},
        {"impulse", [](Scene<D>& s) { s.world.apply_angular_impulse(s.box, bad_spin<D>()); }},
    });
}

TYPED_TEST(Refusals, OfStaleHandlesEverywhere) {
    constexpr int D = TypeParam::value;
    using W = World<D>;
    using Id = BodyId<D>;
    const std::vector<std::function<void(W&, Id)>> uses{
        [](W& w, Id b) { w.transform(b); },
        [](W& w, Id b) { w.position(b); },
        [](W& w, Id b) { w.rotation(b); },
        [](W& w, Id b) { w.center_of_mass(b); },
        [](W& w, Id b) { w.velocity(b); },
        [](W& w, Id b) { w.angular_velocity(b); },
        [](W& w, Id b) { w.velocity_at(b, {}); },
        [](W& w, Id b) { w.mass_properties(b); },
        [](W& w, Id b) { w.type(b); },
        [](W& w, Id b) { w.awake(b); },
        [](W& w, Id b) { w.name(b); },
        [](W& w, Id b) { w.user_data(b); },
        [](W& w, Id b) { w.shapes(b); },
        [](W& w, Id b) { w.energy(b); },
        [](W& w, Id b) { w.set_transform(b, {}); },
        [](W& w, Id b) { w.set_velocity(b, {}); },
        [](W& w, Id b) { w.set_angular_velocity(b, {}); },
        [](W& w, Id b) { w.set_type(b, BodyType::fixed); },
        [](W& w, Id b) { w.set_gravity_scale(b, 1); },
        [](W& w, Id b) { w.set_damping(b, 0, 0); },
        [](W& w, Id b) { w.set_locks(b, {}); },
        [](W& w, Id b) {
            w.set_mass_properties(b, {1, {}, unit_body<D>().inertia.value()});
        },
        [](W& w, Id b) { w.set_user_data(b, 1); },
        [](W& w, Id b) { w.wake(b); },
        [](W& w, Id b) { w.put_to_sleep(b); },
        [](W& w, Id b) { w.apply_force(b, {}); },
        [](W& w, Id b) { w.apply_force(b, {}, {}); },
        [](W& w, Id b) { w.apply_torque(b, {}); },
        [](W& w, Id b) { w.apply_impulse(b, {}); },
        [](W& w, Id b) { w.apply_impulse(b, {}, {}); },
        [](W& w, Id b) { w.apply_angular_impulse(b, {}); },
    };
    std::vector<BadCall<D>> calls;
    for (const auto& use : uses) {
        calls.push_back({"body", [=](Scene<D>& s) { use(s.world, s.dead); }});
        calls.push_back({"body", [=](Scene<D>& s) { use(s.world, {}); }});
    }
    calls.push_back({"shape", [](Scene<D>& s) { s.world.shape(s.dead_shape); }});
    calls.push_back({"shape", [](Scene<D>& s) { s.world.body_of(s.dead_shape); }});
    expect_refusals<D>(calls);
}

template <int D>
void expect_no_world(const std::string& field, const std::function<void(WorldDefinition<D>&)>& spoil) {
    WorldDefinition<D> definition;
    spoil(definition);
    try {
        const World<D> world(definition);
        ADD_FAILURE() << field << " was not refused";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
}

TYPED_TEST(Refusals, OfWorlds) {
    constexpr int D = TypeParam::value;
    using Definition = WorldDefinition<D>;
    expect_no_world<D>("gravity[0]", [](Definition& w) { w.gravity.x = nan; });
    expect_no_world<D>("substeps", [](Definition& w) { w.substeps = 0; });
    expect_no_world<D>("substeps", [](Definition& w) { w.substeps = 65; });
    expect_no_world<D>("restitution_threshold", [](Definition& w) { w.restitution_threshold = -1; });
    expect_no_world<D>("restitution_threshold", [](Definition& w) { w.restitution_threshold = nan; });
}

}  // namespace
}  // namespace carom::test
