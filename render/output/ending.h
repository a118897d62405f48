// What a file's name says it is.
#pragma once
#include <algorithm>
#include <filesystem>
#include <string>

namespace shatterbox::render {

// The ending of a file's name with its dot, in lower case: ".png".
inline std::string lower_case_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return ending;
}

}  // namespace shatterbox::render
