// Numbers of things in sentences.
#pragma once

#include <string>

#include <fmt/format.h>

namespace shatterbox::sandbox::scene {

/// "1 piece", "2 pieces"; `many` where it is not the one with an s.
inline std::string counted(long count, const std::string& one, const std::string& many = "") {
  return fmt::format("{} {}", count, count == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace shatterbox::sandbox::scene
