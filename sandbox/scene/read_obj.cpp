// OBJ: our own scan of the v and f lines finds every fault with its line and reads the numbers correctly
// rounded (tinyobjloader neither says lines nor rounds); tinyobjloader cuts the polygons into triangles.
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#ifndef TINYOBJLOADER_USE_DOUBLE  // the library's CMake target may have said so already
#define TINYOBJLOADER_USE_DOUBLE
#endif
#include <tiny_obj_loader.h>

#include "sandbox/scene/mesh_text.h"

namespace shatterbox::sandbox::scene {

namespace {

/// What the v and f lines say.
struct Scan {
  std::vector<Vec3> positions;
  std::string faces;  // f lines with plain positive indices, for tinyobjloader
  std::size_t face_count = 0;
  std::size_t polygon_count = 0;  // faces with more than three corners
  std::size_t wanted_triangles = 0;
  long greatest_index = 0;
  std::size_t greatest_index_line = 0;
};

std::string quoted(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  return "\"" + text + "\"";
}

/// A number, or nothing; a leading plus sign is allowed, as in many files.
template <class Number>
std::optional<Number> read_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

std::optional<std::string> scan_vertex(const std::vector<std::string_view>& words, Scan& scan) {
  if (words.size() < 4)
    return "a vertex needs three coordinates, here are " + std::to_string(words.size() - 1);
  if (scan.positions.size() >= kMostVertices) return "too many vertices";
  Vec3 position;
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = words[static_cast<std::size_t>(i) + 1];
    const auto number = read_number<double>(word);
    if (!number) return "the coordinate " + quoted(word) + " is no number in a double's range";
    if (!std::isfinite(*number)) return "the coordinate " + quoted(word) + " is not finite";
    position[i] = *number;
  }
  scan.positions.push_back(position);
  return std::nullopt;
}

std::optional<std::string> scan_face(const std::vector<std::string_view>& words, std::size_t line,
                                     Scan& scan) {
  const std::size_t corners = words.size() - 1;
  if (corners < 3) return "a face needs at least three corners, here are " + std::to_string(corners);
  if (corners > kMostCorners)
    return "a face of " + std::to_string(corners) + " corners is more than can be cut";
  scan.faces += 'f';
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string_view word = words[i].substr(0, words[i].find('/'));
    const auto number = read_number<long>(word);
    if (!number) return "the corner " + quoted(words[i]) + " does not begin with the number of a vertex";
    if (*number == 0) return "vertices count from 1, this corner names vertex 0";
    const long vertices = static_cast<long>(scan.positions.size());
    if (*number < -vertices)
      return "the corner " + quoted(words[i]) + " counts back further than the " + std::to_string(vertices) +
             " vertices so far";
    const long vertex = *number > 0 ? *number : vertices + 1 + *number;
    if (vertex > scan.greatest_index) {
      scan.greatest_index = vertex;
      scan.greatest_index_line = line;
    }
    scan.faces += ' ' + std::to_string(vertex);
  }
  scan.faces += '\n';
  ++scan.face_count;
  scan.polygon_count += corners > 3 ? 1 : 0;
  scan.wanted_triangles += corners - 2;
  return std::nullopt;
}

core::Result<Scan> scan_obj(const std::string& text, const std::filesystem::path& path) {
  if (text.find('\0') != std::string::npos)
    return mesh_fault(path, 0, "this is a binary file, not the text of an OBJ");
  Scan scan;
  std::size_t line = 0;
  for (std::size_t place = 0; place < text.size();) {
    const std::size_t first_line = ++line;
    std::string joined(next_line(text, place));
    // A backslash at the end goes on in the next line.
    while (!joined.empty() && place < text.size()) {
      const std::size_t last = joined.find_last_not_of(" \t\r");
      if (last == std::string::npos || joined[last] != '\\') break;
      joined.resize(last);
      joined += ' ';
      joined += next_line(text, place);
      ++line;
    }
    const auto words = split_words(std::string_view(joined).substr(0, joined.find('#')));
    if (words.empty()) continue;
    std::optional<std::string> fault;
    if (words[0] == "v") fault = scan_vertex(words, scan);
    if (words[0] == "f") fault = scan_face(words, first_line, scan);
    if (fault) return mesh_fault(path, first_line, *fault);
  }
  if (scan.positions.empty())
    return mesh_fault(path, 0, "there is no vertex in it (no line that begins with v): is this an OBJ file?");
  if (scan.face_count == 0)
    return mesh_fault(path, 0,
                      "there is no face in it (no line that begins with f), only " +
                          std::to_string(scan.positions.size()) + " vertices");
  if (scan.greatest_index > static_cast<long>(scan.positions.size()))
    return mesh_fault(path, scan.greatest_index_line,
                      "this face names vertex " + std::to_string(scan.greatest_index) +
                          ", but the file has " + std::to_string(scan.positions.size()) +
                          "; is it cut short?");
  return scan;
}

}  // namespace

core::Result<geometry::TriangleMesh> cut_polygons(std::vector<Vec3> positions, const std::string& faces,
                                                  const std::filesystem::path& path) {
  std::ostringstream clean;
  clean.precision(17);
  for (const Vec3& p : positions) clean << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  clean << faces;
  std::istringstream stream(std::move(clean).str());
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning;
  std::string error;
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream))
    return mesh_fault(path, 0, "the mesh cannot be read: " + error);

  geometry::TriangleMesh mesh;
  mesh.positions = std::move(positions);
  for (const tinyobj::shape_t& shape : shapes) {
    const std::vector<tinyobj::index_t>& indices = shape.mesh.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const geometry::Triangle t{indices[i].vertex_index, indices[i + 1].vertex_index,
                                 indices[i + 2].vertex_index};
      for (const int v : t)
        if (v < 0 || static_cast<std::size_t>(v) >= mesh.positions.size())
          return mesh_fault(path, 0, "a face names a vertex that is not there");
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

core::Result<geometry::TriangleMesh> read_obj(const std::string& text, const std::filesystem::path& path,
                                              std::vector<std::string>* notes) {
  core::Result<Scan> scanned = scan_obj(text, path);
  if (!scanned) return core::Error{scanned.error()};
  Scan& scan = scanned.value();
  core::Result<geometry::TriangleMesh> mesh = cut_polygons(std::move(scan.positions), scan.faces, path);
  if (!mesh) return mesh;
  const std::size_t triangles = mesh.value().triangles.size();
  if (notes && scan.polygon_count > 0)
    notes->push_back(path.string() + ": " + std::to_string(scan.polygon_count) +
                     " polygons cut into triangles");
  if (notes && triangles < scan.wanted_triangles)
    notes->push_back(path.string() + ": " + std::to_string(scan.wanted_triangles - triangles) +
                     " triangles of polygons without area left out");
  return mesh;
}

}  // namespace shatterbox::sandbox::scene
