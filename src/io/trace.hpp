#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/output_file.hpp"
#include "io/scene.hpp"

namespace carom::io {

/// Writes where bodies are, step by step, as comma-separated values: `step,time,body,x,y,angle,vx,vy,w` in 2D
/// and `step,time,body,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz` in 3D. Position and velocity are those of the
/// centre of mass. Numbers are written with as many digits as give them back exactly, whatever the locale.
template <int D>
class Trace {
  public:
    /// Opens the file and writes the heading. `selected` names the bodies to write (all of them if empty).
    /// Throws `Error` when the file cannot be written or a name is not that of a body.
    Trace(const std::filesystem::path& path, const SceneWorld<D>& scene,
          std::span<const std::string> selected);

    /// Writes one row for each body: where it is now.
    void write_step(const World<D>& world);

    /// Completes the file.
    void finish() { file_.finish(); }

  private:
    struct Row {
        BodyId<D> body{};
        std::string label;  ///< as it stands in the file
    };
    std::vector<Row> rows_;
    OutputFile file_;
    std::string text_;
};

}  // namespace carom::io
