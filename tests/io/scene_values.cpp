#include <cmath>
#include <limits>

#include "support.hpp"

namespace carom::io {
namespace {

template <int D>
SceneData<D> data_of(const std::string& text) {
    return std::get<SceneData<D>>(parse_scene(text, "t").data);
}

template <int D>
BodyDefinition<D> body_of(const std::string& entries) {
    return data_of<D>(body_text(D, entries)).bodies.at(0);
}

template <int D>
ShapeDefinition<D> shape_of(const std::string& entries) {
    return body_of<D>("\"shapes\": [{" + entries + "}]").shapes.at(0);
}

template <class Kind, int D>
Kind force_of(const std::string& entries) {
    return std::get<Kind>(data_of<D>(force_text(D, entries)).forces.at(0).kind);
}

// The example of the contract (docs/scene-files.md begins with it).
constexpr const char* two_boxes = R"({
  "carom": 1,
  "dimension": 2,
  "name": "two boxes",
  "world": { "gravity": [0, -9.81], "step": 0.016666667, "substeps": 4,
             "integrator": "semi_implicit_euler", "impacts": "simultaneous", "sleep": true },
  "materials": { "wood": { "density": 600, "friction": 0.5, "restitution": 0.1 } },
  "bodies": [
    { "name": "ground", "type": "fixed",
      "shapes": [ { "type": "box", "size": [40, 1], "center": [0, -0.5], "material": "wood" } ] },
    { "name": "crate", "position": [0, 2], "angle": 0.1, "velocity": [1, 0],
      "shapes": [ { "type": "box", "size": [1, 1], "material": "wood" } ] }
  ],
  "joints": [],
  "forces": []
})";

TEST(SceneValues, example_of_the_contract) {
    const Scene scene = parse_scene(two_boxes, "two_boxes.json");
    EXPECT_EQ(scene.name, "two boxes");
    EXPECT_EQ(scene.step, 0.016666667);
    EXPECT_EQ(scene.dimension(), 2);
    const SceneWorld<2> built = build<2>(scene);
    ASSERT_EQ(built.bodies.size(), 2u);
    EXPECT_EQ(built.world.name(built.bodies[1]), "crate");
    EXPECT_EQ(built.world.type(built.bodies[0]), BodyType::fixed);
    EXPECT_EQ(built.world.position(built.bodies[1]), (Vec2{0, 2}));
    EXPECT_NEAR(built.world.mass_properties(built.bodies[1]).mass, 600, 1e-9);
    EXPECT_EQ(std::get<SceneData<2>>(scene.data).materials[1][0], "wood");
}

TEST(SceneValues, defaults_are_those_of_the_contract) {
    const Scene scene = parse_scene(scene_text(3, ""), "t");
    EXPECT_EQ(scene.step, 1.0 / 60);
    const auto& data = std::get<SceneData<3>>(scene.data);
    EXPECT_EQ(data.world.gravity, (Vec3{0, -9.81, 0}));
    EXPECT_EQ(data.world.substeps, 4);
    EXPECT_EQ(data.world.integrator, Integrator::semi_implicit_euler);
    EXPECT_EQ(data.world.impacts, Impacts::simultaneous);
    EXPECT_EQ(data.world.joints, JointMethod::automatic);
    EXPECT_TRUE(data.world.sleep);
    EXPECT_TRUE(data.world.continuous);
    EXPECT_EQ(data.world.restitution_threshold, 1);
    EXPECT_EQ(data.world.hit_speed, 1);

    const auto body = body_of<3>("");
    EXPECT_EQ(body.type, BodyType::dynamic);
    EXPECT_EQ(body.rotation, Rotation3{});
    EXPECT_EQ(body.gravity_scale, 1);
    EXPECT_TRUE(body.can_sleep);
    EXPECT_FALSE(body.bullet || body.mass || body.inertia || body.center_of_mass);

    const auto shape = shape_of<3>("\"type\": \"ball\", \"radius\": 1");
    EXPECT_EQ(shape.material.density, 1000);
    EXPECT_EQ(shape.material.friction, 0.6);
    EXPECT_EQ(shape.material.restitution, 0);
    EXPECT_EQ(shape.material.rolling_resistance, 0);
    EXPECT_EQ(shape.filter.category, 1u);
    EXPECT_EQ(shape.filter.mask, std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(shape.filter.group, 0);
    EXPECT_FALSE(shape.sensor || shape.one_way);
    EXPECT_EQ(shape.surface_velocity, Vec3{});
}

TEST(SceneValues, world) {
    const Scene scene = parse_scene(
        scene_text(2, R"("world": {"gravity": [1.5, -2.25], "step": 0.01, "substeps": 7, "integrator": "rk4",
                         "impacts": "sequential", "joints": "direct", "sleep": false, "continuous": false,
                         "restitution_threshold": 0.25, "hit_speed": 3.5})"),
        "t");
    EXPECT_EQ(scene.step, 0.01);
    const auto& world = std::get<SceneData<2>>(scene.data).world;
    EXPECT_EQ(world.gravity, (Vec2{1.5, -2.25}));
    EXPECT_EQ(world.substeps, 7);
    EXPECT_EQ(world.integrator, Integrator::rk4);
    EXPECT_EQ(world.impacts, Impacts::sequential);
    EXPECT_EQ(world.joints, JointMethod::direct);
    EXPECT_FALSE(world.sleep || world.continuous);
    EXPECT_EQ(world.restitution_threshold, 0.25);
    EXPECT_EQ(world.hit_speed, 3.5);
    for (const auto& [name, integrator] : {std::pair{"explicit_euler", Integrator::explicit_euler},
                                           {"verlet", Integrator::verlet},
                                           {"semi_implicit_euler", Integrator::semi_implicit_euler}})
        EXPECT_EQ(data_of<2>(scene_text(2, "\"world\": {\"integrator\": \"" + std::string(name) + "\"}"))
                      .world.integrator,
                  integrator);
}

TEST(SceneValues, body_in_the_plane) {
    const auto body = body_of<2>(R"("name": "n", "type": "kinematic", "position": [1, 2], "angle": 0.5,
        "velocity": [3, 4], "angular_velocity": -5, "mass": 6, "center_of_mass": [0.5, 0.25], "inertia": 7,
        "gravity_scale": -0.5, "linear_damping": 0.1, "angular_damping": 0.2, "can_sleep": false, "bullet": true,
        "locks": ["y", "rz"])");
    EXPECT_EQ(body.name, "n");
    EXPECT_EQ(body.type, BodyType::kinematic);
    EXPECT_EQ(body.position, (Vec2{1, 2}));
    EXPECT_NEAR(body.rotation.angle(), 0.5, 1e-15);
    EXPECT_EQ(body.velocity, (Vec2{3, 4}));
    EXPECT_EQ(body.angular_velocity, -5);
    EXPECT_EQ(body.mass, 6);
    EXPECT_EQ(body.center_of_mass, (Vec2{0.5, 0.25}));
    EXPECT_EQ(body.inertia, 7);
    EXPECT_EQ(body.gravity_scale, -0.5);
    EXPECT_EQ(body.linear_damping, 0.1);
    EXPECT_EQ(body.angular_damping, 0.2);
    EXPECT_FALSE(body.can_sleep);
    EXPECT_TRUE(body.bullet);
    EXPECT_EQ(body.locks, (Locks{.y = true, .rz = true}));
}

TEST(SceneValues, body_in_space) {
    const auto body = body_of<3>(R"("rotation": [0, 0.7071, 0, 0.7071], "angular_velocity": [1, 2, 3],
        "center_of_mass": [1, 2, 3], "inertia": [[3, 0.5, 0.25], [0.5, 4, 0.125], [0.25, 0.125, 5]],
        "locks": ["x", "z", "rx", "ry"])");
    EXPECT_NEAR(body.rotation.y, std::sqrt(0.5), 1e-15);  // brought to unit length
    EXPECT_EQ(body.angular_velocity, (Vec3{1, 2, 3}));
    EXPECT_EQ(body.center_of_mass, (Vec3{1, 2, 3}));
    EXPECT_EQ(body.inertia, (Symmetric3<double>{3, 4, 5, 0.5, 0.25, 0.125}));
    EXPECT_EQ(body.locks, (Locks{.x = true, .z = true, .rx = true, .ry = true}));
    EXPECT_EQ(body_of<3>("\"inertia\": [1, 2, 3]").inertia, (Symmetric3<double>{1, 2, 3, 0, 0, 0}));
}

TEST(SceneValues, shapes_in_the_plane) {
    EXPECT_EQ(std::get<Ball>(shape_of<2>(R"("type": "ball", "radius": 2.5)").geometry).radius, 2.5);
    const auto box =
        shape_of<2>(R"("type": "box", "size": [1, 2], "rounding": 0.25, "center": [3, 4], "angle": -0.25)");
    EXPECT_EQ(std::get<Box2>(box.geometry).size, (Vec2{1, 2}));
    EXPECT_EQ(std::get<Box2>(box.geometry).rounding, 0.25);
    EXPECT_EQ(box.center, (Vec2{3, 4}));
    EXPECT_NEAR(box.rotation.angle(), -0.25, 1e-15);
    const auto capsule = std::get<Capsule2>(
        shape_of<2>(R"("type": "capsule", "from": [1, 2], "to": [3, 4], "radius": 5)").geometry);
    EXPECT_EQ(capsule.from, (Vec2{1, 2}));
    EXPECT_EQ(capsule.to, (Vec2{3, 4}));
    EXPECT_EQ(capsule.radius, 5);
    const auto hull = std::get<Hull2>(
        shape_of<2>(R"("type": "hull", "points": [[0, 0], [1, 0], [0, 1]], "rounding": 0.5)").geometry);
    EXPECT_EQ(hull.points, (std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(hull.rounding, 0.5);
    const auto plane =
        std::get<Plane2>(shape_of<2>(R"("type": "plane", "normal": [0, 2], "offset": -1)").geometry);
    EXPECT_EQ(plane.normal, (Vec2{0, 2}));
    EXPECT_EQ(plane.offset, -1);
}

TEST(SceneValues, shapes_in_space) {
    const auto cylinder = shape_of<3>(
        R"("type": "cylinder", "radius": 2, "height": 3, "center": [1, 2, 3], "rotation": [1, 0, 0, 0])");
    EXPECT_EQ(std::get<Cylinder>(cylinder.geometry).radius, 2);
    EXPECT_EQ(std::get<Cylinder>(cylinder.geometry).height, 3);
    EXPECT_EQ(cylinder.center, (Vec3{1, 2, 3}));
    EXPECT_EQ(cylinder.rotation, (Rotation3{1, 0, 0, 0}));
    const auto cone = std::get<Cone>(shape_of<3>(R"("type": "cone", "radius": 4, "height": 5)").geometry);
    EXPECT_EQ(cone.radius, 4);
    EXPECT_EQ(cone.height, 5);
    const auto box = std::get<Box3>(shape_of<3>(R"("type": "box", "size": [1, 2, 3])").geometry);
    EXPECT_EQ(box.size, (Vec3{1, 2, 3}));
    EXPECT_TRUE(std::holds_alternative<Capsule3>(
        shape_of<3>(R"("type": "capsule", "from": [0, 0, 0], "to": [0, 1, 0], "radius": 1)").geometry));
    EXPECT_TRUE(std::holds_alternative<Plane3>(
        shape_of<3>(R"("type": "plane", "normal": [0, 1, 0], "offset": 0)").geometry));
    EXPECT_EQ(std::get<Hull3>(
                  shape_of<3>(R"("type": "hull", "points": [[0,0,0], [1,0,0], [0,1,0], [0,0,1]])").geometry)
                  .points.size(),
              4u);
}

TEST(SceneValues, materials_and_what_a_shape_says_itself) {
    const auto data = data_of<2>(scene_text(2, R"("materials": {"m": {"density": 2, "friction": 0.25,
        "restitution": 0.5, "rolling_resistance": 0.125}, "n": {}},
        "bodies": [{"shapes": [
            {"type": "ball", "radius": 1, "material": "m"},
            {"type": "ball", "radius": 1, "friction": 0.75, "material": "m", "category": 6, "mask": 9223372036854775808,
             "group": -3},
            {"type": "ball", "radius": 1, "material": "n"}]}])"));
    const auto& shapes = data.bodies[0].shapes;
    EXPECT_EQ(shapes[0].material.density, 2);
    EXPECT_EQ(shapes[0].material.friction, 0.25);
    EXPECT_EQ(shapes[0].material.restitution, 0.5);
    EXPECT_EQ(shapes[0].material.rolling_resistance, 0.125);
    EXPECT_EQ(shapes[1].material.friction, 0.75);  // wherever it stands, it goes over the material's
    EXPECT_EQ(shapes[1].material.density, 2);
    EXPECT_EQ(shapes[1].filter.category, 6u);
    EXPECT_EQ(shapes[1].filter.mask, std::uint64_t{1} << 63);
    EXPECT_EQ(shapes[1].filter.group, -3);
    EXPECT_EQ(shapes[2].material.density, 1000);
    EXPECT_EQ(data.materials[0], (std::vector<std::string>{"m", "m", "n"}));
}

TEST(SceneValues, sensors_belts_and_one_way_shapes) {
    const std::string ball = R"("type": "ball", "radius": 1, )";
    EXPECT_TRUE(shape_of<2>(ball + R"("sensor": true)").sensor);
    EXPECT_FALSE(shape_of<3>(ball + R"("sensor": false)").sensor);
    EXPECT_EQ(shape_of<2>(ball + R"("surface_velocity": -2.5)").surface_velocity, (Vec2{-2.5, 0}));
    EXPECT_EQ(shape_of<3>(ball + R"("surface_velocity": 2)").surface_velocity, (Vec3{2, 0, 0}));
    EXPECT_EQ(shape_of<2>(ball + R"("surface_velocity": [1, 2])").surface_velocity, (Vec2{1, 2}));
    EXPECT_EQ(shape_of<3>(ball + R"("surface_velocity": [1, 2, 3])").surface_velocity, (Vec3{1, 2, 3}));
    EXPECT_EQ(shape_of<2>(ball + R"("one_way": [0, 2])").one_way, (Vec2{0, 2}));
    EXPECT_EQ(shape_of<3>(ball + R"("one_way": [0, 0, -1])").one_way, (Vec3{0, 0, -1}));
}

TEST(SceneValues, a_belt_of_a_scene_carries_and_its_sensor_sees) {
    const Scene scene = parse_scene(scene_text(2, R"("bodies": [
        {"type": "fixed", "shapes": [{"type": "box", "size": [20, 1], "center": [0, -0.5], "surface_velocity": 1}]},
        {"type": "fixed", "shapes": [{"type": "box", "size": [1, 1], "center": [2, 0.5], "sensor": true}]},
        {"shapes": [{"type": "box", "size": [1, 1], "center": [0, 0.5]}]}])"),
                                    "t");
    SceneWorld<2> built = build<2>(scene);
    bool seen = false;
    for (int i = 0; i < 120; ++i) {
        built.world.step(scene.step);
        seen = seen || !built.world.sensor_begins().empty();
    }
    EXPECT_TRUE(seen);
    EXPECT_NEAR(built.world.velocity(built.bodies[2]).x, 1, 1e-3);
}

TEST(SceneValues, forces) {
    const auto force = force_of<ConstantForce<2>, 2>(
        R"("type": "force", "body": "b", "value": [1, 2], "point": [3, 4], "local": true)");
    EXPECT_EQ(force.body.index, 0u);
    EXPECT_EQ(force.value, (Vec2{1, 2}));
    EXPECT_EQ(force.point, (Vec2{3, 4}));
    EXPECT_TRUE(force.local);
    EXPECT_EQ((force_of<ConstantTorque<3>, 3>(R"("type": "torque", "body": "b", "value": [1, 2, 3])").value),
              (Vec3{1, 2, 3}));
    const auto impulse = force_of<TimedImpulse<2>, 2>(
        R"("type": "impulse", "body": "b", "value": [5, 6], "point": [7, 8], "at": 1.5)");
    EXPECT_EQ(impulse.value, (Vec2{5, 6}));
    EXPECT_EQ(impulse.point, (Vec2{7, 8}));
    EXPECT_EQ(impulse.at, 1.5);
    const auto drag = force_of<Drag<2>, 2>(R"("type": "drag", "body": "b", "linear": 1, "quadratic": 2)");
    EXPECT_EQ(drag.body->index, 0u);
    EXPECT_EQ(drag.linear, 1);
    EXPECT_EQ(drag.quadratic, 2);
    EXPECT_FALSE((force_of<Drag<2>, 2>(R"("type": "drag", "linear": 1)").body));
    const auto wind = force_of<Wind<2>, 2>(R"("type": "wind", "velocity": [9, 8], "density": 3)");
    EXPECT_EQ(wind.velocity, (Vec2{9, 8}));
    EXPECT_EQ(wind.density, 3);
    const auto gravity =
        force_of<PointGravity<2>, 2>(R"("type": "point_gravity", "center": [1, 1], "gm": 4)");
    EXPECT_EQ(gravity.center, (Vec2{1, 1}));
    EXPECT_EQ(gravity.gm, 4);
}

TEST(SceneValues, water) {
    const auto lake = force_of<Buoyancy<2>, 2>(R"("type": "buoyancy", "surface": 3)");
    EXPECT_EQ(lake.up, (Vec2{0, 1}));
    EXPECT_EQ(lake.surface, 3);
    EXPECT_EQ(lake.density, 1000);
    EXPECT_EQ(lake.linear_drag, 0);
    const auto river = force_of<Buoyancy<3>, 3>(
        R"("type": "buoyancy", "surface": {"normal": [0, 2, 0], "offset": -1}, "density": 900,
           "drag": {"linear": 1, "quadratic": 2}, "flow": [4, 5, 6])");
    EXPECT_EQ(river.up, (Vec3{0, 2, 0}));
    EXPECT_EQ(river.surface, -1);
    EXPECT_EQ(river.density, 900);
    EXPECT_EQ(river.linear_drag, 1);
    EXPECT_EQ(river.quadratic_drag, 2);
    EXPECT_EQ(river.flow, (Vec3{4, 5, 6}));
    EXPECT_EQ((force_of<Buoyancy<2>, 2>(R"("type": "buoyancy", "surface": 0, "drag": 7)").linear_drag), 7);
}

TEST(SceneValues, springs_and_times) {
    const auto data = data_of<2>(scene_text(2, R"("bodies": [
            {"shapes": [{"type": "ball", "radius": 1}]},
            {"name": "p", "shapes": [{"type": "ball", "radius": 1}]},
            {"name": "q", "shapes": [{"type": "ball", "radius": 1}]}],
        "forces": [
            {"type": "spring", "a": "q", "b": "p", "anchor_a": [1, 2], "anchor_b": [3, 4], "stiffness": 5,
             "damping": 6, "length": 7, "from": 0.5, "to": 2},
            {"type": "spring", "b": "q", "stiffness": 1}])"));
    const auto& spring = std::get<Spring<2>>(data.forces[0].kind);
    EXPECT_EQ(spring.a->index, 2u);
    EXPECT_EQ(spring.b.index, 1u);
    EXPECT_EQ(spring.anchor_a, (Vec2{1, 2}));
    EXPECT_EQ(spring.anchor_b, (Vec2{3, 4}));
    EXPECT_EQ(spring.stiffness, 5);
    EXPECT_EQ(spring.damping, 6);
    EXPECT_EQ(spring.length, 7);
    EXPECT_EQ(data.forces[0].from, 0.5);
    EXPECT_EQ(data.forces[0].to, 2);
    const auto& other = std::get<Spring<2>>(data.forces[1].kind);
    EXPECT_FALSE(other.a || other.length);
    EXPECT_EQ(data.forces[1].from, 0);
    EXPECT_EQ(data.forces[1].to, std::numeric_limits<double>::infinity());
}

TEST(SceneValues, forces_act_on_the_bodies_that_they_name) {
    const Scene scene = parse_scene(scene_text(2, R"("world": {"gravity": [0, 0]},
        "bodies": [{"name": "p", "shapes": [{"type": "ball", "radius": 0.5}]},
                   {"name": "q", "position": [5, 0], "shapes": [{"type": "ball", "radius": 0.5}]}],
        "forces": [{"type": "impulse", "body": "q", "value": [0, 10]},
                   {"type": "spring", "a": "q", "b": "p", "stiffness": 0}])"),
                                    "t");
    SceneWorld<2> built = build<2>(scene);
    EXPECT_EQ(built.forces.size(), 2u);
    built.world.step(0.1);
    EXPECT_EQ(length(built.world.velocity(built.bodies[0])), 0);
    EXPECT_GT(built.world.velocity(built.bodies[1]).y, 0);
}

TEST(SceneValues, numbers_are_read_exactly) {
    for (const auto& [written, value] : {std::pair{"0.1", 0.1},
                                         {"1e-308", 1e-308},
                                         {"5e-324", 5e-324},
                                         {"1.7976931348623157e308", 1.7976931348623157e308},
                                         {"9007199254740993", 9007199254740992.0},
                                         {"0.30000000000000004", 0.30000000000000004},
                                         {"2.2250738585072011e-308", 2.2250738585072011e-308},
                                         {"-0.0", -0.0},
                                         {"1E2", 100.0}})
        EXPECT_EQ((body_of<2>("\"position\": [" + std::string(written) + ", 0]").position.x), value)
            << written;
}

}  // namespace
}  // namespace carom::io
