// STL, as text or as bytes. Nothing that the file promises is believed before its bytes are there.
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>

#include "sandbox/scene/polygons.h"

namespace shatterbox::sandbox::scene {

namespace {

constexpr std::size_t kStlHeader = 84;  // 80 bytes of anything, the count; then 50 bytes a triangle
constexpr std::size_t kStlTriangle = 50;

std::size_t promised_triangles(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kStlHeader - 4, 4);
  return count;
}

std::optional<std::string> find_stl_fault(std::string_view bytes) {
  if (bytes.size() >= kStlHeader) {
    const std::size_t count = promised_triangles(bytes);
    if (bytes.size() == kStlHeader + kStlTriangle * count) {
      if (count == 0) return "the file has no triangles";
      return std::nullopt;
    }
    if (bytes.substr(0, 5) != "solid") {
      if (bytes.size() < kStlHeader + kStlTriangle * count)
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

Polygons read_stl_bytes(std::string_view bytes) {
  Polygons polygons;
  const std::size_t count = promised_triangles(bytes);
  for (std::size_t t = 0; t < count; ++t) {
    float numbers[12];  // the normal, which the corners tell as well, and three corners
    std::memcpy(numbers, bytes.data() + kStlHeader + kStlTriangle * t, sizeof numbers);
    const std::size_t first = polygons.positions.size();
    for (std::size_t v = 1; v < 4; ++v)
      polygons.positions.emplace_back(numbers[3 * v], numbers[3 * v + 1], numbers[3 * v + 2]);
    polygons.add({first, first + 1, first + 2});
  }
  return polygons;
}

/// In single precision, as the binary form has it.
std::optional<float> number_of(std::string_view word) {
  if (!word.empty() && word[0] == '+') word.remove_prefix(1);
  float number = 0.0F;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

core::Result<Polygons> read_stl_text(std::string_view text, const std::filesystem::path& path) {
  Polygons polygons;
  std::vector<std::size_t> corners;
  std::size_t line = 0;
  for (std::size_t place = 0; place < text.size();) {
    const auto words = split_words(next_line(text, place));
    ++line;
    if (words.empty()) continue;
    if (words[0] == "vertex") {
      Vec3 p = Vec3::Zero();
      bool is_good = words.size() == 4;
      for (std::size_t k = 0; is_good && k < 3; ++k) {
        const auto number = number_of(words[k + 1]);
        is_good = number.has_value();
        if (is_good) p[static_cast<Eigen::Index>(k)] = *number;
      }
      if (!is_good) return mesh_fault(path, line, "a vertex is not three numbers");
      corners.push_back(polygons.positions.size());
      polygons.positions.push_back(p);
    } else if (words[0] == "endloop" || words[0] == "endfacet") {
      if (!corners.empty()) polygons.add(corners);
      corners.clear();
    } else if (words[0] != "solid" && words[0] != "endsolid" && words[0] != "facet" && words[0] != "outer" &&
               words[0] != "color") {
      return mesh_fault(path, line, "this line is none of an STL's");
    }
  }
  if (!corners.empty()) return mesh_fault(path, line, "the file is cut short: a loop without its end");
  return polygons;
}

}  // namespace

core::Result<geometry::TriangleMesh> read_stl(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes) {
  if (const auto fault = find_stl_fault(bytes)) return mesh_fault(path, 0, *fault);
  const bool is_binary =
      bytes.size() >= kStlHeader && (bytes.compare(0, 5, "solid") != 0 ||
                                     bytes.size() == kStlHeader + kStlTriangle * promised_triangles(bytes));
  if (is_binary) return make_triangles(read_stl_bytes(bytes), path, notes);
  core::Result<Polygons> polygons = read_stl_text(bytes, path);
  if (!polygons) return core::Error{polygons.error()};
  return make_triangles(std::move(polygons.value()), path, notes);
}

}  // namespace shatterbox::sandbox::scene
