#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "io/scene.hpp"
#include "io/scene_check.hpp"

namespace carom::io {
namespace {

class FiveScenes : public testing::TestWithParam<const char*> {
  protected:
    Scene load() const { return load_scene(std::string(CAROM_SOURCE_DIR "/scenes/") + GetParam() + ".json"); }
};

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

TEST_P(FiveScenes, runs_and_stays_finite) {
    const Scene scene = load();
    scene.dimension() == 2 ? expect_sound<2>(scene, 240) : expect_sound<3>(scene, 120);
}

TEST_P(FiveScenes, nothing_is_suspicious) {
    for (const Suspicion& suspicion : check_scene(load()))
        ADD_FAILURE() << suspicion.place << ": " << suspicion.what;
}

TEST_P(FiveScenes, has_a_name_and_material_names) {
    const Scene scene = load();
    EXPECT_NE(scene.name, "");
    const auto visit = [](const auto& data) {
        for (std::size_t i = 0; i < data.bodies.size(); ++i)
            for (const std::string& material : data.materials[i])
                EXPECT_NE(material, "") << "bodies[" << i << "]";
    };
    std::visit(visit, scene.data);
}

INSTANTIATE_TEST_SUITE_P(All, FiveScenes,
                         testing::Values("2d/lunar_lander", "2d/incredible_machine", "2d/angry_birds",
                                         "3d/half_life", "3d/from_dust"),
                         [](const auto& test) { return std::string(test.param).substr(3); });

}  // namespace
}  // namespace carom::io
