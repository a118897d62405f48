#include "sandbox/scene/mesh_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <optional>
#include <system_error>

#include "sandbox/scene/mesh_ending.h"
#include "sandbox/scene/mesh_text.h"

namespace shatterbox::sandbox::scene {

namespace {

core::Result<std::string> read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return mesh_fault(path, 0, "there is no such file");
  if (std::filesystem::is_directory(status)) return mesh_fault(path, 0, "this is a folder, not a mesh file");
  if (!std::filesystem::is_regular_file(status)) return mesh_fault(path, 0, "this is not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return mesh_fault(path, 0, "the file cannot be read: " + error.message());
  if (size == 0) return mesh_fault(path, 0, "the file is empty");
  if (size > kMostMeshFileBytes)
    return mesh_fault(path, 0,
                      "the file has " + std::to_string(size >> 20) + " MiB, more than the " +
                          std::to_string(kMostMeshFileBytes >> 20) + " MiB that are read; thin the mesh out");
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file || !file.read(bytes.data(), static_cast<std::streamsize>(size)))
    return mesh_fault(path, 0, "the file cannot be read (may you open it?)");
  return bytes;
}

// In the order of the endings.
constexpr std::array<decltype(&read_obj), kMeshEndings.size()> kReaders{read_obj,  read_ply,  read_stl,
                                                                        read_gltf, read_gltf, read_3ds};

core::Result<geometry::TriangleMesh> read_by_ending(const std::filesystem::path& path,
                                                    std::vector<std::string>* notes) {
  core::Result<std::string> bytes = read_bytes(path);
  if (!bytes) return core::Error{bytes.error()};
  const std::optional<std::size_t> ending = find_mesh_ending(path);
  if (!ending)
    return mesh_fault(
        path, 0,
        "meshes are read from .obj, .ply, .stl, .glb, .gltf and .3ds files; convert it to one of them");
  return kReaders[*ending](bytes.value(), path, notes);
}

}  // namespace

core::Error mesh_fault(const std::filesystem::path& path, std::size_t line, const std::string& sentence) {
  std::string place = path.string();
  if (line > 0) place += ':' + std::to_string(line);
  return core::Error{place + ": " + sentence};
}

std::vector<std::string_view> split_words(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string_view next_line(std::string_view text, std::size_t& place) {
  const std::size_t end = std::min(text.find('\n', place), text.size());
  const std::string_view line = text.substr(place, end - place);
  place = std::min(end + 1, text.size());
  return line;
}

core::Result<geometry::TriangleMesh> read_mesh(const std::filesystem::path& path,
                                               std::vector<std::string>* notes) {
  try {
    return read_by_ending(path, notes);
  } catch (const std::bad_alloc&) {
    return mesh_fault(path, 0, "the mesh does not fit into memory");
  } catch (const std::exception& fault) {  // the libraries' own, and the file system's
    return mesh_fault(path, 0, std::string("the mesh cannot be read: ") + fault.what());
  }
}

}  // namespace shatterbox::sandbox::scene
