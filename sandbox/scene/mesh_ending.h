// What names of mesh files end in.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace shatterbox::sandbox::scene {

inline constexpr std::array<std::string_view, 6> kMeshEndings{".obj", ".ply",  ".stl",
                                                              ".glb", ".gltf", ".3ds"};

/// With its dot, in small letters.
inline std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return ending;
}

inline bool has_mesh_ending(const std::filesystem::path& path) {
  return std::find(kMeshEndings.begin(), kMeshEndings.end(), ending_of(path)) != kMeshEndings.end();
}

}  // namespace shatterbox::sandbox::scene
