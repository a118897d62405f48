// The whole of a mesh file in memory, and sentences about it: shared by the readers of the single formats.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::sandbox::scene {

inline constexpr std::size_t kMostCorners = 10000;  // of one polygon: cutting takes the square of it
inline constexpr std::size_t kMostVertices = static_cast<std::size_t>(std::numeric_limits<int>::max()) / 4;

/// "file.obj:12: sentence"; line 0 leaves the line out.
core::Error mesh_fault(const std::filesystem::path& path, std::size_t line, const std::string& sentence);

/// Words of a line: separated by blanks, tabs and carriage returns.
std::vector<std::string_view> split_words(std::string_view line);

/// The next line of `text` from `place` on, which moves behind it; without the line's end.
std::string_view next_line(std::string_view text, std::size_t& place);

/// Polygons over vertices, as the lines of an OBJ ("f 1 2 3 4\n", from 1, all in range), cut into triangles.
/// Polygons without area may lose triangles. `path` is for sentences only.
core::Result<geometry::TriangleMesh> cut_polygons(std::vector<Vec3> positions, const std::string& faces,
                                                  const std::filesystem::path& path);

/// The triangles of an OBJ file's text. `path` is for sentences only.
core::Result<geometry::TriangleMesh> read_obj(const std::string& text, const std::filesystem::path& path,
                                              std::vector<std::string>* notes);

/// The triangles of such a file's bytes; positions equal to the bit are welded.
core::Result<geometry::TriangleMesh> read_ply(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes);
core::Result<geometry::TriangleMesh> read_3ds(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes);
/// Text or .glb; buffers that are files of their own lie beside `path`.
core::Result<geometry::TriangleMesh> read_gltf(const std::string& bytes, const std::filesystem::path& path,
                                               std::vector<std::string>* notes);
core::Result<geometry::TriangleMesh> read_stl(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes);

}  // namespace shatterbox::sandbox::scene
