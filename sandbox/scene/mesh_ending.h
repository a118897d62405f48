// What names of mesh files end in.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace shatterbox::sandbox::scene {

inline constexpr std::array<std::string_view, 6> kMeshEndings{".obj", ".ply",  ".stl",
                                                              ".glb", ".gltf", ".3ds"};

/// Which of them a file's name has, in letters of any case; nothing: it is no mesh file.
inline std::optional<std::size_t> find_mesh_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const auto place = std::find(kMeshEndings.begin(), kMeshEndings.end(), ending);
  if (place == kMeshEndings.end()) return std::nullopt;
  return static_cast<std::size_t>(place - kMeshEndings.begin());
}

}  // namespace shatterbox::sandbox::scene
