// PLY and STL through Assimp. What it trusts and should not (counts in headers, the length of the file) is
// checked before it sees the file, and its vertex numbers are checked after.
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <charconv>
#include <cstdint>
#include <optional>

#include "engine/geometry/weld.h"
#include "sandbox/scene/mesh_text.h"

namespace shatterbox::sandbox::scene {

namespace {

std::size_t bytes_of_ply_type(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "float" || type == "int32" || type == "uint32" ||
      type == "float32")
    return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
}

/// The least room that an element of a PLY header takes in the file.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::size_t binary_bytes = 0;  // a list takes its length at least
  std::size_t numbers = 0;       // as text each takes two bytes at least
};

/// A fault of a PLY header, or nothing. Counts that the rest of the file has no room for are refused here,
/// before anybody makes room for them in memory.
std::optional<std::string> find_ply_fault(std::string_view bytes) {
  if (bytes.substr(0, 3) != "ply") return "this is no PLY file: it does not begin with ply";
  bool is_ascii = false;
  bool has_format = false;
  std::vector<PlyElement> elements;
  std::size_t place = 0;
  for (bool is_over = false; !is_over;) {
    if (place >= bytes.size()) return "the header is cut short: no line end_header";
    const auto words = split_words(next_line(bytes, place));
    if (words.empty()) continue;
    if (words[0] == "format" && words.size() >= 2) {
      has_format = true;
      is_ascii = words[1] == "ascii";
      if (!is_ascii && words[1] != "binary_little_endian" && words[1] != "binary_big_endian")
        return "the header names an unknown format";
    } else if (words[0] == "element") {
      PlyElement element;
      if (words.size() < 3) return "an element line of the header is cut short";
      element.name = words[1];
      const auto [end, error] =
          std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
      if (error != std::errc() || end != words[2].data() + words[2].size())
        return "the header's number of " + element.name + " is no number";
      elements.push_back(element);
    } else if (words[0] == "property") {
      if (elements.empty() || words.size() < 3)
        return "a property line of the header is out of place or cut short";
      const std::size_t size = bytes_of_ply_type(words[1] == "list" ? words[2] : words[1]);
      if (size == 0) return "the header names an unknown type of number";
      elements.back().binary_bytes += size;
      ++elements.back().numbers;
    }
    is_over = words[0] == "end_header";
  }
  if (!has_format) return "the header names no format";
  const std::uint64_t rest = bytes.size() - place;
  std::uint64_t needed = 0;
  bool has_vertices = false;
  bool has_faces = false;
  for (const PlyElement& element : elements) {
    if (element.count > rest)
      return "the header promises " + std::to_string(element.count) + " of " + element.name +
             ", but the file ends long before; it is cut short or damaged";
    const std::uint64_t per_element = is_ascii ? 2 * element.numbers : element.binary_bytes;
    needed += element.count * per_element;
    has_vertices = has_vertices || (element.name == "vertex" && element.count > 0);
    has_faces = has_faces || (element.name == "face" && element.count > 0);
  }
  if (needed > rest + 1)
    return "the file ends before all that its header promises; it is cut short";  // + 1: last line's end
  if (!has_vertices) return "the header has no vertices";
  if (!has_faces) return "the header has no faces, only points";
  return std::nullopt;
}

std::optional<std::string> find_stl_fault(std::string_view bytes) {
  constexpr std::size_t kHeader = 84;  // 80 bytes of anything, the count; then 50 bytes a triangle
  if (bytes.size() >= kHeader) {
    const auto byte = [&](std::size_t i) { return std::uint64_t{static_cast<unsigned char>(bytes[80 + i])}; };
    const std::uint64_t count = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
    if (bytes.size() == kHeader + 50 * count) {
      if (count == 0) return "the file has no triangles";
      return std::nullopt;
    }
    if (bytes.substr(0, 5) != "solid") {
      if (bytes.size() < kHeader + 50 * count)
        return "the file promises " + std::to_string(count) +
               " triangles but ends before; it is cut short, or no STL";
      return std::nullopt;
    }
  } else if (bytes.substr(0, 5) != "solid") {
    return "this is no STL file: too short for the binary form, and it does not begin with solid";
  }
  if (bytes.find('\0') != std::string_view::npos)
    return "the file is damaged: text with bytes in it that are none";
  if (bytes.rfind("endsolid") == std::string_view::npos) return "the file is cut short: no line endsolid";
  if (bytes.find("facet") == std::string_view::npos) return "the file has no facets";
  return std::nullopt;
}

/// Polygons and vertices of all parts.
struct Faces {
  std::vector<Vec3> positions;
  std::string lines;  // as of an OBJ, for cut_polygons
  std::size_t polygon_count = 0;
  std::size_t left_out = 0;
};

/// Appends one of Assimp's meshes; a sentence if it has numbers that are none or names vertices that it has
/// not.
std::optional<std::string> append(const aiMesh& part, Faces& faces) {
  const std::size_t first = faces.positions.size();
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const Vec3 p(part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z);
    if (!p.allFinite()) return "vertex " + std::to_string(v + 1) + " has a coordinate that is no number";
    faces.positions.push_back(p);
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices < 3 || face.mNumIndices > kMostCorners) {
      ++faces.left_out;
      continue;
    }
    faces.polygon_count += face.mNumIndices > 3 ? 1 : 0;
    faces.lines += 'f';
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= part.mNumVertices)
        return "face " + std::to_string(f + 1) + " names a vertex that is not there; the file is damaged";
      faces.lines += ' ' + std::to_string(first + face.mIndices[i] + 1);
    }
    faces.lines += '\n';
  }
  return std::nullopt;
}

core::Result<geometry::TriangleMesh> read_by_assimp(const std::string& bytes, const char* ending,
                                                    const std::filesystem::path& path,
                                                    std::vector<std::string>* notes) {
  // No post-processing: Assimp's cutting of polygons ends the program on faces it does not expect.
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending);
  if (!scene)
    return mesh_fault(path, 0, std::string("the mesh cannot be read: ") + importer.GetErrorString());
  Faces faces;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m)
    if (const auto fault = append(*scene->mMeshes[m], faces)) return mesh_fault(path, 0, *fault);
  if (faces.positions.size() > kMostVertices) return mesh_fault(path, 0, "too many vertices");
  if (faces.lines.empty()) return mesh_fault(path, 0, "there are no triangles in it");
  core::Result<geometry::TriangleMesh> mesh = cut_polygons(std::move(faces.positions), faces.lines, path);
  if (!mesh) return mesh;
  const int welded = geometry::weld_equal_positions(mesh.value());
  if (!notes) return mesh;
  if (faces.left_out > 0)
    notes->push_back(path.string() + ": " + std::to_string(faces.left_out) + " points and lines left out");
  if (faces.polygon_count > 0)
    notes->push_back(path.string() + ": " + std::to_string(faces.polygon_count) +
                     " polygons cut into triangles");
  if (welded > 0)
    notes->push_back(path.string() + ": " + std::to_string(welded) +
                     " vertices welded that lie exactly on another one");
  return mesh;
}

}  // namespace

core::Result<geometry::TriangleMesh> read_ply(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes) {
  if (const auto fault = find_ply_fault(bytes)) return mesh_fault(path, 0, *fault);
  return read_by_assimp(bytes, "ply", path, notes);
}

core::Result<geometry::TriangleMesh> read_stl(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes) {
  if (const auto fault = find_stl_fault(bytes)) return mesh_fault(path, 0, *fault);
  return read_by_assimp(bytes, "stl", path, notes);
}

}  // namespace shatterbox::sandbox::scene
