#pragma once

#include <filesystem>
#include <string_view>

#include "carom/shapes.hpp"

namespace carom::io {

/// Reads a Wavefront OBJ text: its vertices (`v`) and faces (`f`, with texture and normal indices or without,
/// counted from 1 or backwards from −1), polygons being cut into fans. Everything else in it is passed over,
/// and so are triangles that name a vertex twice. Throws `Error` that names `where` (the file), the line and
/// what is wrong.
Mesh parse_obj(std::string_view text, std::string_view where);

/// The same for a file of at most 1 GiB.
Mesh load_obj(const std::filesystem::path& path);

}  // namespace carom::io
