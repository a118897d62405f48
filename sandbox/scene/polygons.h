// What the readers of PLY, STL, glTF and 3DS gather: vertices, and polygons over them.
#pragma once

#include <string>
#include <vector>

#include "sandbox/scene/mesh_text.h"

namespace shatterbox::sandbox::scene {

struct Polygons {
  std::vector<Vec3> positions;
  std::string lines;  // as of an OBJ, for cut_polygons
  std::size_t polygon_count = 0;
  std::size_t left_out = 0;  // points and lines

  /// Corners by their numbers from 0, which are there.
  void add(const std::vector<std::size_t>& corners);
};

/// Their triangles, equal positions welded. `path` is for sentences only.
core::Result<geometry::TriangleMesh> make_triangles(Polygons polygons, const std::filesystem::path& path,
                                                    std::vector<std::string>* notes);

}  // namespace shatterbox::sandbox::scene
