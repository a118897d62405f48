// Files that are found whole under their name, or not at all.
#pragma once
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "render/output/status.h"

namespace shatterbox::render {

// Writes it beside its name and renames it.
inline Status write_whole_file(const std::filesystem::path& path, const std::string& bytes) {
  const std::filesystem::path part = path.string() + ".part";
  {
    errno = 0;
    std::ofstream file(part, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) return {path.string() + " cannot be written: " + std::strerror(errno)};
  }
  std::error_code problem;
  std::filesystem::rename(part, path, problem);
  if (problem) return {path.string() + ": " + problem.message()};
  return {};
}

}  // namespace shatterbox::render
