// 3DS: chunks within chunks, each with its kind and length. No chunk is believed to be longer than the one
// that it is in.
#include <cstdint>
#include <cstring>

#include "sandbox/scene/polygons.h"

namespace shatterbox::sandbox::scene {

namespace {

constexpr std::size_t kChunkHead = 6;  // two bytes its kind, four its length, these six included
enum Chunk3ds : std::uint16_t { kMain = 0x4d4d, kEditor = 0x3d3d, kObject = 0x4000, kMesh = 0x4100 };
constexpr std::uint16_t kVertexList = 0x4110, kFaceList = 0x4120;

template <class Number>
Number number_at(std::string_view bytes, std::size_t place) {
  Number number = 0;
  std::memcpy(&number, bytes.data() + place, sizeof number);
  return number;
}

/// Calls `visit` with the kind and the content of each chunk of `bytes`; what it says is wrong ends it.
template <class Visit>
std::string for_each_chunk(std::string_view bytes, const Visit& visit) {
  for (std::size_t place = 0; place + kChunkHead <= bytes.size();) {
    const auto length = number_at<std::uint32_t>(bytes, place + 2);
    if (length < kChunkHead || length > bytes.size() - place)
      return "the file is damaged or cut short: a chunk goes on beyond what it is in";
    const std::string fault =
        visit(number_at<std::uint16_t>(bytes, place), bytes.substr(place + kChunkHead, length - kChunkHead));
    if (!fault.empty()) return fault;
    place += length;
  }
  return {};
}

/// Adds the vertices and faces of one mesh.
std::string read_mesh_chunk(std::string_view bytes, Polygons& polygons) {
  const std::size_t first = polygons.positions.size();
  std::string_view faces;
  std::string fault = for_each_chunk(bytes, [&](std::uint16_t kind, std::string_view content) {
    if (kind == kFaceList) faces = content;
    if (kind != kVertexList) return std::string();
    const std::size_t count = content.size() < 2 ? 0 : number_at<std::uint16_t>(content, 0);
    if (content.size() < 2 + 12 * count) return std::string("the file is cut short within its vertices");
    for (std::size_t v = 0; v < count; ++v) {
      const std::size_t place = 2 + 12 * v;
      polygons.positions.emplace_back(number_at<float>(content, place), number_at<float>(content, place + 4),
                                      number_at<float>(content, place + 8));
    }
    return std::string();
  });
  if (!fault.empty() || faces.empty()) return fault;
  const std::size_t vertices = polygons.positions.size() - first;
  const std::size_t count = faces.size() < 2 ? 0 : number_at<std::uint16_t>(faces, 0);
  if (faces.size() < 2 + 8 * count) return "the file is cut short within its faces";
  for (std::size_t f = 0; f < count; ++f) {
    std::vector<std::size_t> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = number_at<std::uint16_t>(faces, 2 + 8 * f + 2 * k);
      if (corner >= vertices)
        return "face " + std::to_string(f + 1) + " names vertex " + std::to_string(corner + 1) + " of " +
               std::to_string(vertices);
      corners.push_back(first + corner);
    }
    polygons.add(corners);
  }
  return {};
}

}  // namespace

core::Result<geometry::TriangleMesh> read_3ds(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes) {
  if (bytes.size() < kChunkHead || number_at<std::uint16_t>(bytes, 0) != kMain)
    return mesh_fault(path, 0, "this is no 3DS file: it does not begin with its main chunk");
  Polygons polygons;
  const auto read_object = [&](std::uint16_t kind, std::string_view content) {
    if (kind != kObject) return std::string();
    const std::size_t name_end = content.find('\0');
    if (name_end == std::string_view::npos) return std::string("the file is damaged: a name without an end");
    return for_each_chunk(content.substr(name_end + 1), [&](std::uint16_t inner, std::string_view mesh) {
      return inner == kMesh ? read_mesh_chunk(mesh, polygons) : std::string();
    });
  };
  const std::string fault = for_each_chunk(bytes, [&](std::uint16_t, std::string_view content) {
    return for_each_chunk(content, [&](std::uint16_t kind, std::string_view editor) {
      return kind == kEditor ? for_each_chunk(editor, read_object) : std::string();
    });
  });
  if (!fault.empty()) return mesh_fault(path, 0, fault);
  return make_triangles(std::move(polygons), path, notes);
}

}  // namespace shatterbox::sandbox::scene
