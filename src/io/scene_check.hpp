#pragma once

#include <string>
#include <vector>

#include "io/scene.hpp"

namespace carom::io {

/// Something in a scene that can be simulated, but is hardly what was meant or will hardly look well.
struct Suspicion {
    std::string place;  ///< in the file, as `bodies[3].velocity`
    std::string what;
};

/// Looks at units and sizes, masses against their neighbours', bodies that overlap at the start, speeds and
/// springs against the step, and settings that have no effect. Throws `Error` when the scene cannot be built.
std::vector<Suspicion> check_scene(const Scene& scene);

}  // namespace carom::io
