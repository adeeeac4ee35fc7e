#include "support.hpp"

namespace carom::io {
namespace {

struct Refusal {
    std::string scene;
    std::string message;  ///< how it begins, after the name of the file
};

void expect_refused(const std::vector<Refusal>& refusals) {
    for (const auto& [scene, message] : refusals) {
        const std::string error = error_of([&] { parse_and_build(scene); });
        EXPECT_EQ(error.substr(0, message.size() + 11), "test.json: " + message)
            << scene << "\nsays " << error;
    }
}

TEST(SceneErrors, document) {
    expect_refused({
        {"[1, 2]", "[1, 2] is not an object"},
        {"3", "3 is not an object"},
        {"{\"dimension\": 2}", "\"carom\" is missing"},
        {"{\"carom\": 1}", "\"dimension\" is missing"},
        {"{\"carom\": 2, \"dimension\": 2}", "carom: 2 is not supported by this version; allowed is 1"},
        {"{\"carom\": \"1\", \"dimension\": 2}", "carom: \"1\" is not supported by this version"},
        {"{\"carom\": 1, \"dimension\": 4}", "dimension: 4 is neither 2 nor 3"},
        {"{\"carom\": 1, \"dimension\": \"2\"}", "dimension: \"2\" is neither 2 nor 3"},
        {scene_text(2, "\"gravty\": 1"), "gravty: this key is not known; allowed are carom, dimension, name"},
        {scene_text(2, "\"bodys\": []"), "bodys: this key is not known (did you mean \"bodies\"?)"},
        {scene_text(2, "\"bodies\": {}"), "bodies: an object is not a list"},
        {scene_text(2, "\"bodies\": [7]"), "bodies[0]: 7 is not an object"},
        {scene_text(2, "\"name\": 5"), "name: 5 is not a text"},
        {scene_text(2, "\"joints\": [{}]"), "joints[0]: \"type\" is missing"},
        {scene_text(2, "\"joints\": 0"), "joints: 0 is not a list"},
        {scene_text(2, "\"od d\": 0"), "[\"od d\"]: this key is not known"},
    });
}

TEST(SceneErrors, world) {
    expect_refused({
        {scene_text(2, "\"world\": []"), "world: [] is not an object"},
        {scene_text(2, "\"world\": {\"gravity\": [0, -9.81, 0]}"),
         "world.gravity: [0, -9.81, 0] is not a list of 2 numbers [x, y]"},
        {scene_text(3, "\"world\": {\"gravity\": [0, -9.81]}"),
         "world.gravity: [0, -9.81] is not a list of 3 numbers [x, y, z]"},
        {scene_text(2, "\"world\": {\"gravity\": [0, \"down\"]}"),
         "world.gravity[1]: \"down\" is not a number"},
        {scene_text(2, "\"world\": {\"gravity\": -9.81}"), "world.gravity: -9.81 is not a list"},
        {scene_text(2, "\"world\": {\"step\": 0}"), "world.step: 0 is not above 0 and at most 1 s"},
        {scene_text(2, "\"world\": {\"step\": -0.1}"), "world.step: -0.1 is not above 0"},
        {scene_text(2, "\"world\": {\"step\": 2}"), "world.step: 2 is not above 0"},
        {scene_text(2, "\"world\": {\"substeps\": 0}"), "world.substeps: 0 is not between 1 and 64"},
        {scene_text(2, "\"world\": {\"substeps\": 4.5}"), "world.substeps: 4.5 is not a whole number"},
        {scene_text(2, "\"world\": {\"substeps\": 1e10}"),
         "world.substeps: 10000000000.0 is not a whole number"},
        {scene_text(2, "\"world\": {\"integrator\": \"verlett\"}"),
         "world.integrator: \"verlett\" is not known (did you mean \"verlet\"?); allowed are "
         "semi_implicit_euler, "
         "explicit_euler, verlet, rk4"},
        {scene_text(2, "\"world\": {\"impacts\": true}"), "world.impacts: true is not a text"},
        {scene_text(2, "\"world\": {\"sleep\": 1}"), "world.sleep: 1 is neither true nor false"},
        {scene_text(2, "\"world\": {\"restitution_threshold\": -1}"),
         "world.restitution_threshold: -1 is negative"},
        {scene_text(2, "\"world\": {\"hit_speed\": -0.5}"), "world.hit_speed: -0.5 is negative"},
        {scene_text(2, "\"world\": {\"hit_speed\": true}"), "world.hit_speed: true is not a number"},
        {scene_text(2, "\"world\": {\"Gravity\": [0, 0]}"),
         "world.Gravity: this key is not known (did you mean \"gravity\"?)"},
    });
}

TEST(SceneErrors, materials) {
    const std::string wood = "\"materials\": {\"wood\": {\"density\": 600}}, ";
    expect_refused({
        {scene_text(2, "\"materials\": []"), "materials: [] is not an object"},
        {scene_text(2, "\"materials\": {\"wood\": {\"density\": -600}}"),
         "materials.wood.density: -600 is negative"},
        {scene_text(2, "\"materials\": {\"wood\": {\"friction\": -0.1}}"),
         "materials.wood.friction: -0.1 is negative"},
        {scene_text(2, "\"materials\": {\"wood\": {\"restitution\": 1.1}}"),
         "materials.wood.restitution: 1.1 is not between 0 and 1"},
        {scene_text(2, "\"materials\": {\"old wood\": {\"colour\": 1}}"),
         "materials[\"old wood\"].colour: this key is not known; allowed are density, friction"},
        {scene_text(2, wood + "\"bodies\": [{\"shapes\": [{\"type\": \"ball\", \"radius\": 1, \"material\": "
                              "\"woood\"}]}]"),
         "bodies[0].shapes[0].material: \"woood\" is not a material of this scene (did you mean \"wood\"?)"},
    });
}

TEST(SceneErrors, bodies) {
    expect_refused({
        {body_text(2, "\"position\": [0, 1, 2]"), "bodies[0].position: [0, 1, 2] is not a list of 2 numbers"},
        {body_text(2, "\"positon\": [0, 1]"),
         "bodies[0].positon: this key is not known (did you mean \"position\"?)"},
        {body_text(2, "\"rotation\": [0, 0, 0, 1]"), "bodies[0].rotation: this key is not known"},
        {body_text(3, "\"angle\": 1"), "bodies[0].angle: this key is not known"},
        {body_text(2, "\"angle\": 1e10"), "bodies[0].angle: 10000000000.0 is not an angle"},
        {body_text(3, "\"rotation\": [0, 0, 0, 0.5]"),
         "bodies[0].rotation: [0, 0, 0, 0.5] has the length 0.5; a rotation has 1"},
        {body_text(3, "\"rotation\": [0, 0, 1]"), "bodies[0].rotation: [0, 0, 1] is not a list of 4 numbers"},
        {body_text(2, "\"type\": \"static\""),
         "bodies[0].type: \"static\" is not known; allowed are dynamic, fixed, kinematic"},
        {body_text(3, "\"angular_velocity\": 1"), "bodies[0].angular_velocity: 1 is not a list of 3 numbers"},
        {body_text(2, "\"angular_velocity\": [0, 0, 1]"),
         "bodies[0].angular_velocity: [0, 0, 1] is not a number"},
        {body_text(2, "\"mass\": -1"), "bodies[0].mass: -1 is not positive"},
        {body_text(2, "\"mass\": null"), "bodies[0].mass: null is not a number"},
        {body_text(2, "\"mass\": 1, \"inertia\": 0"), "bodies[0].inertia: 0 is not positive"},
        {body_text(3, "\"mass\": 1, \"inertia\": [1, 2]"),
         "bodies[0].inertia: [1, 2] is neither a list of 3 numbers nor a symmetric 3x3 matrix"},
        {body_text(3, "\"mass\": 1, \"inertia\": [[1, 0, 0], [0, 1, 0.5], [0, 0, 1]]"),
         "bodies[0].inertia: [[1, 0, 0], [0, 1, 0.5], [0, 0, 1]] is not symmetric"},
        {body_text(3, "\"mass\": 1, \"inertia\": [1, 1, -1]"), "bodies[0].inertia: "},
        {body_text(2, "\"linear_damping\": -1"), "bodies[0].linear_damping: -1 is negative"},
        {body_text(2, "\"locks\": [\"z\"]"), "bodies[0].locks[0]: \"z\" is not known; allowed are x, y, rz"},
        {body_text(3, "\"locks\": \"x\""), "bodies[0].locks: \"x\" is not a list"},
        {body_text(2, "\"name\": \"\""), "bodies[0].name: \"\" is empty"},
        {body_text(2, "\"name\": \"#3\""), "bodies[0].name: \"#3\" begins with \"#\""},
        {scene_text(2, "\"bodies\": [{\"name\": \"a\", \"type\": \"fixed\"}, {\"name\": \"a\"}]"),
         "bodies[1].name: \"a\" is the name of an earlier body already"},
        {body_text(2, "\"shapes\": {}"), "bodies[0].shapes: an object is not a list"},
    });
}

/// A scene with a fixed body of one shape of these entries, and the material "ice".
std::string ground_text(int dimension, const std::string& entries) {
    return scene_text(dimension,
                      "\"materials\": {\"ice\": {\"friction\": 0.1}}, \"bodies\": [{\"type\": \"fixed\", "
                      "\"shapes\": [{" +
                          entries + "}]}]");
}

TEST(SceneErrors, ground) {
    const std::string cells = "\"type\": \"height_field\", \"heights\": ";
    const std::string corners =
        "\"type\": \"mesh\", \"vertices\": [[0, 0, 0], [1, 0, 0], [0, 0, 1]], \"triangles\": ";
    const std::string line = "\"type\": \"chain\", \"points\": [[0, 0], [1, 0], [2, 1]]";
    expect_refused({
        {ground_text(2, "\"type\": \"chain\""), "bodies[0].shapes[0]: \"points\" is missing"},
        {ground_text(2, "\"type\": \"chain\", \"points\": [[0, 0]]"),
         "bodies[0].shapes[0].points: 1 are fewer than 2"},
        {ground_text(2, line + ", \"loop\": 1"), "bodies[0].shapes[0].loop: 1 is neither true nor false"},
        {ground_text(2, line + ", \"materials\": [\"snow\"]"),
         "bodies[0].shapes[0].materials[0]: \"snow\" is not a material of this scene"},
        {ground_text(2, line + ", \"materials\": [\"ice\"]"),
         "bodies[0].shapes[0].material_of: has 0 entries for 2 segments"},
        {ground_text(2, line + ", \"materials\": [\"ice\"], \"material_of\": [0, 70000]"),
         "bodies[0].shapes[0].material_of[1]: 70000 is more than 65535"},
        {body_text(2, "\"shapes\": [{" + line + "}]"),
         "bodies[0].shapes[0].geometry: a chain, mesh or height field needs a fixed or kinematic body"},
        {ground_text(3, "\"type\": \"mesh\""), "bodies[0].shapes[0].vertices: 0 are fewer than 3"},
        {ground_text(3, corners + "[[0, 1]]"),
         "bodies[0].shapes[0].triangles[0]: [0, 1] is not a list of 3 indices of vertices"},
        {ground_text(3, corners + "[[0, 1, -1]]"), "bodies[0].shapes[0].triangles[0][2]: -1 is not a whole"},
        {ground_text(3, corners + "[[0, 1, 3]]"),
         "bodies[0].shapes[0].triangles[0]: 3 is not the index of one of the 3 vertices"},
        {ground_text(3, corners + "[[0, 1, 2]], \"file\": \"a.obj\""),
         "bodies[0].shapes[0].file: \"a.obj\" stands beside"},
        {ground_text(3, "\"type\": \"mesh\", \"file\": \"none.obj\""),
         "bodies[0].shapes[0].file: none.obj: "},
        {ground_text(2, cells + "[0, 1]"), "bodies[0].shapes[0]: \"spacing\" is missing"},
        {ground_text(2, cells + "[0, \"1\"], \"spacing\": 1"),
         "bodies[0].shapes[0].heights[1]: \"1\" is not a number"},
        {ground_text(2, cells + "[0, null], \"spacing\": 1"),
         "bodies[0].shapes[0].heights: all cells are holes"},
        {ground_text(2, cells + "[0, 1], \"spacing\": [1]"),
         "bodies[0].shapes[0].spacing: [1] is not a number"},
        {ground_text(3, cells + "[[0, 1], [0]], \"spacing\": 1"),
         "bodies[0].shapes[0].heights[1]: has 1 heights, the first row has 2"},
        {ground_text(3, cells + "[[0, 1], [0, 1]], \"spacing\": [1, 0]"),
         "bodies[0].shapes[0].spacing[1]: 0 is not positive"},
        {ground_text(3, cells + "[[0, 1], [0, 1]], \"spacing\": [1, 1, 1]"),
         "bodies[0].shapes[0].spacing: [1, 1, 1] is neither a number nor a list of 2 numbers"},
    });
}

TEST(SceneErrors, shapes) {
    expect_refused({
        {shape_text(2, "\"radius\": 1"), "bodies[0].shapes[0]: \"type\" is missing"},
        {shape_text(2, "\"type\": \"bal\", \"radius\": 1"),
         "bodies[0].shapes[0].type: \"bal\" is not known (did you mean \"ball\"?); allowed are ball, box, "
         "capsule, "
         "hull, plane, chain, height_field"},
        {shape_text(2, "\"type\": \"cylinder\", \"radius\": 1, \"height\": 1"),
         "bodies[0].shapes[0].type: \"cylinder\" exists in 3D only; allowed in 2D are ball"},
        {shape_text(3, "\"type\": \"chain\""), "bodies[0].shapes[0].type: \"chain\" exists in 2D only"},
        {shape_text(2, "\"type\": \"mesh\""), "bodies[0].shapes[0].type: \"mesh\" exists in 3D only"},
        {shape_text(2, "\"type\": \"ball\""), "bodies[0].shapes[0]: \"radius\" is missing"},
        {shape_text(2, "\"type\": \"ball\", \"raduis\": 1"),
         "bodies[0].shapes[0].raduis: this key is not known (did you mean \"radius\"?)"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": -1"),
         "bodies[0].shapes[0].radius: -1 is not positive"},
        {shape_text(3, "\"type\": \"ball\", \"radius\": 0"), "bodies[0].shapes[0].radius: 0 is not positive"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": \"1\""),
         "bodies[0].shapes[0].radius: \"1\" is not a number"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": true"),
         "bodies[0].shapes[0].radius: true is not a number"},
        {shape_text(2, "\"type\": \"box\", \"size\": [1, -2]"),
         "bodies[0].shapes[0].size[1]: -2 is not positive"},
        {shape_text(2, "\"type\": \"box\", \"size\": 1"),
         "bodies[0].shapes[0].size: 1 is not a list of 2 numbers"},
        {shape_text(2, "\"type\": \"box\", \"size\": [1, 1], \"rounding\": 2"),
         "bodies[0].shapes[0].rounding: 2 "},
        {shape_text(2, "\"type\": \"box\", \"size\": [1, 1], \"radius\": 2"),
         "bodies[0].shapes[0].radius: this key is not known"},
        {shape_text(2, "\"type\": \"hull\", \"points\": [[0, 0], [1, 1], [2, 2]]"),
         "bodies[0].shapes[0].points: "},
        {shape_text(3, "\"type\": \"hull\", \"points\": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]"),
         "bodies[0].shapes[0].points: "},
        {shape_text(2, "\"type\": \"hull\", \"points\": []"), "bodies[0].shapes[0].points: "},
        {shape_text(2, "\"type\": \"hull\", \"points\": [[0, 0], [1], [2, 2]]"),
         "bodies[0].shapes[0].points[1]: [1] is not a list of 2 numbers"},
        {shape_text(3, "\"type\": \"cone\", \"radius\": 1, \"height\": -1"),
         "bodies[0].shapes[0].height: -1 is not positive"},
        {body_text(
             2,
             "\"type\": \"fixed\", \"shapes\": [{\"type\": \"plane\", \"normal\": [0, 0], \"offset\": 0}]"),
         "bodies[0].shapes[0].normal"},
        {shape_text(2, "\"type\": \"plane\", \"normal\": [0, 1], \"offset\": 0"), "bodies[0].shapes[0]."},
        {shape_text(2, "\"type\": \"ball\", \"radius\": 1, \"mask\": -1"),
         "bodies[0].shapes[0].mask: -1 is not a whole number from 0 to 18446744073709551615"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": 1, \"group\": 3000000000"),
         "bodies[0].shapes[0].group: 3000000000 is not a whole number from -2147483648 to 2147483647"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": 1, \"group\": 18446744073709551615"),
         "bodies[0].shapes[0].group: 18446744073709551615 is not a whole number"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": 1, \"density\": -1"),
         "bodies[0].shapes[0].density: -1 is negative"},
    });
}

/// A scene with a ball that also has these entries.
std::string ball_text(int dimension, const std::string& entries) {
    return shape_text(dimension, "\"type\": \"ball\", \"radius\": 1, " + entries);
}

TEST(SceneErrors, surfaces) {
    const std::string shape = "bodies[0].shapes[0].";
    expect_refused({
        {ball_text(2, "\"sensor\": 1"), shape + "sensor: 1 is neither true nor false"},
        {ball_text(2, "\"sensor\": null"), shape + "sensor: null is neither true nor false"},
        {ball_text(2, "\"surface_velocity\": \"fast\""), shape + "surface_velocity: \"fast\" is not a list"},
        {ball_text(2, "\"surface_velocity\": true"), shape + "surface_velocity: true is not a list"},
        {ball_text(2, "\"surface_velocity\": [1, 0, 0]"),
         shape + "surface_velocity: [1, 0, 0] is not a list of 2 numbers [x, y]"},
        {ball_text(3, "\"surface_velocity\": [1, 0]"),
         shape + "surface_velocity: [1, 0] is not a list of 3 numbers [x, y, z]"},
        {ball_text(3, "\"surface_velocity\": [0, null, 0]"),
         shape + "surface_velocity[1]: null is not a number"},
        {ball_text(2, "\"surface_velocity\": [0, -1e9]"),
         shape + "surface_velocity[1]: -1e+09 is not between -1e+06 and 1e+06"},
        {ball_text(2, "\"surface_velocity\": NaN"),
         "line 1, column 103: " + shape +
             "surface_velocity: syntax error while parsing value - invalid literal"},
        {ball_text(2, "\"surface_velocity\": 1e999"),
         "line 1, column 107: " + shape + "surface_velocity: number overflow parsing '1e999'"},
        {ball_text(2, "\"one_way\": [0, 0]"), shape + "one_way: a direction has a length"},
        {ball_text(3, "\"one_way\": [0, 0, 0]"), shape + "one_way: a direction has a length"},
        {ball_text(2, "\"one_way\": [NaN, 1]"),
         "line 1, column 95: " + shape + "one_way[0]: syntax error while parsing value - invalid literal"},
        {ball_text(2, "\"one_way\": true"), shape + "one_way: true is not a list"},
        {ball_text(2, "\"one_way\": 1"), shape + "one_way: 1 is not a list"},
        {ball_text(3, "\"one_way\": [0, 1]"), shape + "one_way: [0, 1] is not a list of 3 numbers [x, y, z]"},
        {ball_text(2, "\"one_way\": [0, \"up\"]"), shape + "one_way[1]: \"up\" is not a number"},
    });
}

TEST(SceneErrors, forces) {
    expect_refused({
        {force_text(2, "\"body\": \"b\""), "forces[0]: \"type\" is missing"},
        {force_text(2, "\"type\": \"buoyancy\""), "forces[0]: \"surface\" is missing"},
        {force_text(2, "\"type\": \"buoyancy\", \"surface\": [0, 1]"),
         "forces[0].surface: [0, 1] is not a number"},
        {force_text(2, "\"type\": \"buoyancy\", \"surface\": {\"offset\": 1}"),
         "forces[0].surface: \"normal\" is missing"},
        {force_text(2, "\"type\": \"buoyancy\", \"surface\": {\"normal\": [0, 0], \"offset\": 1}"),
         "forces[0].surface.normal: [0, 0] has no length"},
        {force_text(2, "\"type\": \"buoyancy\", \"surface\": 0, \"density\": -1"),
         "forces[0].density: -1 is negative"},
        {force_text(2, "\"type\": \"buoyancy\", \"surface\": 0, \"drag\": -1"),
         "forces[0].drag: -1 is negative"},
        {force_text(2, "\"type\": \"buoyancy\", \"surface\": 0, \"drag\": {\"quadratic\": -1}"),
         "forces[0].drag.quadratic: -1 is negative"},
        {force_text(3, "\"type\": \"buoyancy\", \"surface\": 0, \"flow\": [1, 0]"),
         "forces[0].flow: [1, 0] is not a list of 3 numbers [x, y, z]"},
        {force_text(2, "\"type\": \"magnet\""),
         "forces[0].type: \"magnet\" is not known; allowed are force, torque, impulse, drag, wind, "
         "point_gravity, "
         "spring, buoyancy"},
        {force_text(2, "\"type\": \"force\", \"value\": [1, 0]"), "forces[0]: \"body\" is missing"},
        {force_text(2, "\"type\": \"force\", \"body\": \"c\", \"value\": [1, 0]"),
         "forces[0].body: \"c\" is not the name of a body"},
        {force_text(2, "\"type\": \"force\", \"body\": \"b\""), "forces[0]: \"value\" is missing"},
        {force_text(2, "\"type\": \"torque\", \"body\": \"b\", \"value\": [1, 0]"),
         "forces[0].value: [1, 0] is not a number"},
        {force_text(3, "\"type\": \"torque\", \"body\": \"b\", \"value\": 1"),
         "forces[0].value: 1 is not a list"},
        {force_text(2, "\"type\": \"impulse\", \"body\": \"b\", \"value\": [1, 0], \"at\": -1"),
         "forces[0].at: -1 is negative"},
        {force_text(2, "\"type\": \"drag\", \"linear\": -1"), "forces[0].linear: -1 is negative"},
        {force_text(2, "\"type\": \"wind\""), "forces[0]: \"velocity\" is missing"},
        {force_text(2, "\"type\": \"point_gravity\""), "forces[0]: \"gm\" is missing"},
        {force_text(2, "\"type\": \"spring\", \"a\": \"b\""), "forces[0]: \"b\" is missing"},
        {force_text(2, "\"type\": \"spring\", \"b\": \"b\", \"stiffness\": -5"),
         "forces[0].stiffness: -5 is negative"},
        {force_text(2, "\"type\": \"spring\", \"b\": \"b\", \"length\": -5"),
         "forces[0].length: -5 is negative"},
        {force_text(2, "\"type\": \"wind\", \"velocity\": [1, 0], \"from\": 2, \"to\": 1"),
         "forces[0].to: 1 is before \"from\", 2"},
        {force_text(2, "\"type\": \"wind\", \"velocity\": [1, 0], \"until\": 1"),
         "forces[0].until: this key is not known"},
    });
}

TEST(SceneErrors, numbers_that_are_none) {
    expect_refused({
        {shape_text(2, "\"type\": \"ball\", \"radius\": 1e999"),
         "line 1, column 84: bodies[0].shapes[0].radius: number overflow parsing '1e999'"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": NaN"),
         "line 1, column 80: bodies[0].shapes[0].radius: syntax error while parsing value - invalid literal"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": -Infinity"),
         "line 1, column 81: bodies[0].shapes[0].radius: "},
        {shape_text(2, "\"type\": \"ball\", \"radius\": 0x10"), "line 1, column 81: bodies[0].shapes[0]"},
        {shape_text(2, "\"type\": \"ball\", \"radius\": .5"), "line 1, column 80: bodies[0].shapes[0]"},
    });
}

}  // namespace
}  // namespace carom::io
