#include "io/obj.hpp"

#include <cmath>

#include "support.hpp"

namespace carom::io {
namespace {

TEST(Obj, ReadsVerticesAndFacesOfAllForms) {
    const Mesh mesh = parse_obj(
        "# a house\r\nmtllib house.mtl\no house\nv 0 0 0\nv 1.5e0 0 +0.25 1\n\tv 1 0 -1\nv 0 0 1 # corner\n"
        "vt 0 0\nvn 0 1 0\nusemtl brick\ns off\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 3//1 4//1\nf -4/1/1 -3/1/1 "
        "-1/1/1\n"
        "f 1 2 3 4\n\nl 1 2\nf 1 1 2 3",
        "house.obj");
    ASSERT_EQ(mesh.vertices.size(), 4u);
    EXPECT_EQ(mesh.vertices[1], (Vec3{1.5, 0, 0.25}));
    EXPECT_EQ(mesh.vertices[2], (Vec3{1, 0, -1}));
    const std::vector<std::array<std::uint32_t, 3>> expected{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 1, 3},
                                                             {0, 1, 2}, {0, 2, 3}, {0, 1, 2}};
    EXPECT_EQ(mesh.triangles, expected);
    EXPECT_TRUE(parse_obj("", "empty.obj").vertices.empty());
}

TEST(Obj, NamesFileAndLineOfWhatIsWrong) {
    const auto refusal = [](const char* text) { return error_of([&] { parse_obj(text, "hill.obj"); }); };
    EXPECT_EQ(refusal("v 0 0 0\nv 1 2"), "hill.obj: line 2: a vertex needs three coordinates");
    EXPECT_EQ(refusal("v 0 zero 0"), "hill.obj: line 1: \"zero\" is not a number");
    EXPECT_EQ(refusal("v 0 1e999 0"), "hill.obj: line 1: \"1e999\" is not a number");
    EXPECT_EQ(refusal("v 0 0 0\n\n\nf 1 2 1"),
              "hill.obj: line 4: 2 is not the index of one of the 1 vertices before it");
    EXPECT_EQ(refusal("v 0 0 0\nf 0 1 1"),
              "hill.obj: line 2: 0 is not the index of one of the 1 vertices before it");
    EXPECT_EQ(refusal("v 0 0 0\nf -2 1 1"),
              "hill.obj: line 2: -2 is not the index of one of the 1 vertices before it");
    EXPECT_EQ(refusal("v 0 0 0\nf 1 1"), "hill.obj: line 2: a face needs three corners at least");
    EXPECT_EQ(refusal("v 0 0 0\nf x 1 1"), "hill.obj: line 2: \"x\" is not the index of a vertex");
}

TEST(Obj, AMeshOfASceneIsReadFromBesideIt) {
    const TestFolder folder;
    folder.write("hill.obj", "v 0 0 0\nv 1 0 0\nv 0 0 -1\nf 1 2 3\n");
    const std::string path = folder.write(
        "hills.json",
        scene_text(3, R"("bodies": [{"type": "fixed", "shapes": [{"type": "mesh", "file": "hill.obj"}]}])"));
    const Scene scene = load_scene(path);
    const auto& shape = std::get<SceneData<3>>(scene.data).bodies.at(0).shapes.at(0);
    const Mesh& mesh = std::get<Mesh>(shape.geometry);
    EXPECT_EQ(mesh.vertices.size(), 3u);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    build<3>(scene);

    folder.write("hill.obj", "v 0 0 0\nf 1 2 3\n");
    const std::string error = error_of([&] { load_scene(path); });
    EXPECT_NE(error.find("hills.json: bodies[0].shapes[0].file: "), std::string::npos) << error;
    EXPECT_NE(error.find("hill.obj: line 2: 2 is not"), std::string::npos) << error;
}

TEST(Ground, KeysBecomeDefinitions) {
    const auto shape_of = [](int dimension, const std::string& entries) {
        return parse_scene(
            scene_text(dimension, R"("materials": {"ice": {"friction": 0.1}, "mud": {"friction": 2}},
            "bodies": [{"type": "fixed", "shapes": [{)" +
                                      entries + "}]}]"),
            "test.json");
    };
    const Scene line = shape_of(2, R"("type": "chain", "points": [[0, 0], [1, 0], [1, 1]], "loop": true,
        "two_sided": true, "materials": ["ice", "mud"], "material_of": [0, 1, 1])");
    const auto& chain = std::get<Chain>(std::get<SceneData<2>>(line.data).bodies[0].shapes[0].geometry);
    EXPECT_EQ(chain.points.size(), 3u);
    EXPECT_TRUE(chain.loop && chain.two_sided);
    EXPECT_EQ(chain.materials.at(1).friction, 2);
    EXPECT_EQ(chain.material_of, (std::vector<std::uint16_t>{0, 1, 1}));

    const Scene land =
        shape_of(3, R"("type": "height_field", "heights": [[0, 1, 2], [3, null, 5]], "spacing": [2, 3])");
    const auto& field =
        std::get<HeightField3>(std::get<SceneData<3>>(land.data).bodies[0].shapes[0].geometry);
    EXPECT_EQ(field.heights[1][2], 5);
    EXPECT_TRUE(std::isnan(field.heights[1][1]));
    EXPECT_EQ(field.spacing, (std::array<double, 2>{2, 3}));
    const Scene flat = shape_of(3, R"("type": "height_field", "heights": [[0, 1], [3, 4]], "spacing": 2)");
    EXPECT_EQ(std::get<HeightField3>(std::get<SceneData<3>>(flat.data).bodies[0].shapes[0].geometry).spacing,
              (std::array<double, 2>{2, 2}));
    build<2>(line);
    build<3>(land);
}

}  // namespace
}  // namespace carom::io
