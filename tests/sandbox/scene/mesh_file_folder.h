// A temporary folder with mesh files in it, gone at the end of the test.
#pragma once

#include <unistd.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

namespace shatterbox::sandbox::scene {

class MeshFileFolder {
 public:
  MeshFileFolder()
      : path_(std::filesystem::temp_directory_path() / ("mesh_file_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  MeshFileFolder(const MeshFileFolder&) = delete;
  MeshFileFolder& operator=(const MeshFileFolder&) = delete;
  ~MeshFileFolder() { std::filesystem::remove_all(path_); }

  /// Writes a file and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace shatterbox::sandbox::scene
