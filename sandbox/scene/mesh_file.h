// Reading meshes: OBJ through tinyobjloader in double precision, PLY, STL, glTF and 3DS by readers of our own, in
// which no file can hang or ask for more than it holds. What comes out
// is as the file has it; geometry::mend judges it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/result.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::sandbox::scene {

/// Files larger than this are refused unread.
inline constexpr std::uintmax_t kMostMeshFileBytes = std::uintmax_t{1} << 29;

/// The triangles of an .obj, .ply, .stl, .glb, .gltf or .3ds file (by its ending, in any case); polygons are cut into triangles.
/// All but OBJ and PLY come in single precision, some unwelded: positions equal to the bit are welded. A sentence with
/// the path, and for OBJ the line, if the file is missing, is no such mesh, is cut short, or has a number
/// that is none. What was done on the way (welded, cut polygons) goes to `notes` if given.
core::Result<geometry::TriangleMesh> read_mesh(const std::filesystem::path& path,
                                               std::vector<std::string>* notes = nullptr);

}  // namespace shatterbox::sandbox::scene
