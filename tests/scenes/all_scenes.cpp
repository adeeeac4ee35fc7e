#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "io/scene.hpp"
#include "io/scene_check.hpp"

namespace carom::io {
namespace {

const std::filesystem::path folder = CAROM_SOURCE_DIR "/scenes";

/// Every scene that comes with Carom, as it is named in the folder.
std::vector<std::string> all_scenes() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".json")
            names.push_back(entry.path().lexically_relative(folder).replace_extension().string());
    std::ranges::sort(names);
    return names;
}

class AllScenes : public testing::TestWithParam<std::string> {
  protected:
    Scene load() const { return load_scene(folder / (GetParam() + ".json")); }
};

TEST(Scenes, are_found) { EXPECT_GE(all_scenes().size(), 11u); }

template <int D>
void expect_sound(const Scene& scene, int steps) {
    SceneWorld<D> built = build<D>(scene);
    const double start = built.world.energy().total();
    for (int i = 0; i < steps; ++i) {
        built.world.step(scene.step);
        ASSERT_TRUE(built.world.quarantined().empty()) << "step " << i;
    }
    EXPECT_TRUE(std::isfinite(built.world.energy().total())) << "from " << start;
    EXPECT_EQ(built.world.bodies().size(), built.bodies.size());
    for (const BodyId<D> body : built.bodies) {
        // Nothing falls through the floor or leaves the stage.
        EXPECT_LT(length(built.world.position(body)), 200) << built.world.name(body);
        EXPECT_GT(built.world.position(body).y, -20) << built.world.name(body);
        EXPECT_LT(length(built.world.velocity(body)), 60) << built.world.name(body);
    }
}

TEST_P(AllScenes, runs_and_stays_finite) {
    const Scene scene = load();
    scene.dimension() == 2 ? expect_sound<2>(scene, 240) : expect_sound<3>(scene, 120);
}

TEST_P(AllScenes, nothing_is_suspicious) {
    for (const Suspicion& suspicion : check_scene(load()))
        ADD_FAILURE() << suspicion.place << ": " << suspicion.what;
}

TEST_P(AllScenes, has_a_name_and_material_names) {
    const Scene scene = load();
    EXPECT_NE(scene.name, "");
    const auto visit = [](const auto& data) {
        for (std::size_t i = 0; i < data.bodies.size(); ++i)
            for (const std::string& material : data.materials[i])
                EXPECT_NE(material, "") << "bodies[" << i << "]";
    };
    std::visit(visit, scene.data);
}

INSTANTIATE_TEST_SUITE_P(InFolder, AllScenes, testing::ValuesIn(all_scenes()), [](const auto& test) {
    std::string name = test.param;
    std::ranges::replace_if(
        name, [](unsigned char c) { return !std::isalnum(c); }, '_');
    return name;
});

}  // namespace
}  // namespace carom::io
