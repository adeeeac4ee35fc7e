#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "carom/world.hpp"

namespace carom::io {

/// The world of a scene, as definitions that can be given to a `World<D>` as they are, except that a joint
/// or force names its bodies by their index in `bodies`, and a joint other joints by their index in `joints`, there
/// being no handles yet.
template <int D>
struct SceneData {
    WorldDefinition<D> world{};
    std::vector<BodyDefinition<D>> bodies;
    std::vector<JointDefinition<D>> joints;
    std::vector<ForceDefinition<D>> forces;
    /// The name of the material of each shape of each body; empty where the shape names none.
    std::vector<std::vector<std::string>> materials;
};

/// A scene file that was read and whose form is right. Whether its values can be simulated is for
/// `build` to find.
struct Scene {
    std::string where;  ///< the file, for messages
    std::string name;
    double step = 1.0 / 60;  ///< s
    std::variant<SceneData<2>, SceneData<3>> data;

    int dimension() const { return data.index() == 0 ? 2 : 3; }
};

/// A scene that came to life.
template <int D>
struct SceneWorld {
    World<D> world;
    std::vector<BodyId<D>> bodies;  ///< in the order of the scene
    std::vector<JointId<D>> joints;
    std::vector<ForceId<D>> forces;
};

/// Reads a scene file (docs/scene-files.md). Throws `Error` that names the file, the place in it, the value
/// and what is allowed.
Scene load_scene(const std::filesystem::path& path);

/// The same for a text; `where` stands for the name of its file in messages.
Scene parse_scene(std::string_view text, std::string_view where);

/// Makes the world of a scene of dimension D. Throws `Error` with the place in the file for what the world
/// refuses.
template <int D>
SceneWorld<D> build(const Scene& scene);

/// How messages, traces and `--trace-bodies` call the body at `index`: by its name, or else `#index`.
std::string body_label(std::string_view name, std::size_t index);

}  // namespace carom::io
