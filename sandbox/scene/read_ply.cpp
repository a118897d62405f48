// PLY, as text or as bytes of either order. Nothing that the header promises is believed before its bytes are
// there: each number that is read takes a byte at least.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "sandbox/scene/polygons.h"

namespace shatterbox::sandbox::scene {

namespace {

enum class NumberKind : std::uint8_t { whole, natural, real };
struct NumberType {
  NumberKind kind = NumberKind::whole;
  std::size_t size = 0;  // bytes; 0: unknown
};

NumberType find_number_type(std::string_view name) {
  const struct {
    const char *name, *other;
    NumberType type;
  } known[] = {{"char", "int8", {NumberKind::whole, 1}},    {"uchar", "uint8", {NumberKind::natural, 1}},
               {"short", "int16", {NumberKind::whole, 2}},  {"ushort", "uint16", {NumberKind::natural, 2}},
               {"int", "int32", {NumberKind::whole, 4}},    {"uint", "uint32", {NumberKind::natural, 4}},
               {"float", "float32", {NumberKind::real, 4}}, {"double", "float64", {NumberKind::real, 8}}};
  for (const auto& entry : known)
    if (name == entry.name || name == entry.other) return entry.type;
  return {};
}

struct PlyProperty {
  std::string name;
  NumberType type;
  NumberType count;  // of a list; size 0: no list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

enum class PlyFormat : std::uint8_t { none, text, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format = PlyFormat::none;
  std::vector<PlyElement> elements;
  std::size_t end = 0;  // where the numbers begin
};

/// A fault of a line of the header, or nothing.
std::optional<std::string> read_header_line(const std::vector<std::string_view>& words, PlyHeader& header) {
  if (words[0] == "format" && words.size() >= 2) {
    header.format = words[1] == "ascii"                  ? PlyFormat::text
                    : words[1] == "binary_little_endian" ? PlyFormat::little_endian
                    : words[1] == "binary_big_endian"    ? PlyFormat::big_endian
                                                         : PlyFormat::none;
    if (header.format == PlyFormat::none) return "the header names an unknown format";
  } else if (words[0] == "element") {
    if (words.size() < 3) return "an element line of the header is cut short";
    PlyElement element;
    element.name = words[1];
    const char* const last = words[2].data() + words[2].size();
    const auto [end, error] = std::from_chars(words[2].data(), last, element.count);
    if (error != std::errc() || end != last)
      return "the header's number of " + element.name + " is no number";
    header.elements.push_back(std::move(element));
  } else if (words[0] == "property") {
    const bool is_list = words.size() > 1 && words[1] == "list";
    if (header.elements.empty() || words.size() < (is_list ? 5U : 3U))
      return "a property line of the header is out of place or cut short";
    PlyProperty property{std::string(words.back()), find_number_type(words[is_list ? 3 : 1]), {}};
    if (is_list) property.count = find_number_type(words[2]);
    if (property.type.size == 0 || (is_list && property.count.size == 0))
      return "the header names an unknown type of number";
    header.elements.back().properties.push_back(std::move(property));
  } else if (words[0] != "ply" && words[0] != "comment" && words[0] != "obj_info") {
    return "the header has a line that is none of a PLY's";
  }
  return std::nullopt;
}

/// Counts for which the rest of the file has no room are refused here, before anybody makes room for them.
std::optional<std::string> find_missing(const PlyHeader& header, std::uint64_t rest) {
  std::uint64_t needed = 0;
  const auto has = [&header](const char* name) {
    return std::any_of(header.elements.begin(), header.elements.end(),
                       [name](const PlyElement& e) { return e.name == name && e.count > 0; });
  };
  for (const PlyElement& element : header.elements) {
    if (element.count > rest)
      return "the header promises " + std::to_string(element.count) + " of " + element.name +
             ", but the file ends long before; it is cut short or damaged";
    std::uint64_t each = 0;  // a list takes its length at least; as text a number takes two bytes
    for (const PlyProperty& p : element.properties)
      each += header.format == PlyFormat::text ? 2 : p.count.size > 0 ? p.count.size : p.type.size;
    needed += element.count * each;
  }
  if (needed > rest + 1)
    return "the file ends before all that its header promises; it is cut short";  // + 1: last line's end
  if (!has("vertex")) return "the header has no vertices";
  if (!has("face")) return "the header has no faces, only points";
  return std::nullopt;
}

std::optional<std::string> read_header(std::string_view bytes, PlyHeader& header) {
  if (bytes.substr(0, 3) != "ply") return "this is no PLY file: it does not begin with ply";
  for (;;) {
    if (header.end >= bytes.size()) return "the header is cut short: no line end_header";
    const auto words = split_words(next_line(bytes, header.end));
    if (words.empty()) continue;
    if (words[0] == "end_header") break;
    if (auto fault = read_header_line(words, header)) return fault;
  }
  if (header.format == PlyFormat::none) return "the header names no format";
  return find_missing(header, bytes.size() - header.end);
}

/// The numbers behind the header, one after the other.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, PlyFormat format) : bytes_(bytes), format_(format) {}

  /// Nothing where the file ends, or where there is no number.
  std::optional<double> next(NumberType type) {
    return format_ == PlyFormat::text ? next_word() : next_bytes(type);
  }

 private:
  std::optional<double> next_word() {
    constexpr std::string_view kBlanks = " \t\r\n";
    const std::size_t begin = bytes_.find_first_not_of(kBlanks, place_);
    if (begin == std::string_view::npos) return std::nullopt;
    place_ = std::min(bytes_.find_first_of(kBlanks, begin), bytes_.size());
    std::string_view word = bytes_.substr(begin, place_ - begin);
    if (word[0] == '+') word.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return number;
  }

  std::optional<double> next_bytes(NumberType type) {
    if (bytes_.size() - place_ < type.size) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.size; ++i) {
      const std::size_t from = format_ == PlyFormat::little_endian ? type.size - 1 - i : i;
      bits = bits << 8U | static_cast<unsigned char>(bytes_[place_ + from]);
    }
    place_ += type.size;
    if (type.kind == NumberKind::real)
      return type.size == 8 ? std::bit_cast<double>(bits)
                            : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    const auto natural = static_cast<double>(bits);
    const double span = std::ldexp(1.0, static_cast<int>(8 * type.size));
    return type.kind == NumberKind::whole && natural >= 0.5 * span ? natural - span : natural;
  }

  std::string_view bytes_;
  PlyFormat format_;
  std::size_t place_ = 0;
};

bool is_natural(double number, double end) {
  return number >= 0.0 && number < end && number == std::floor(number);
}

/// All elements, of which vertices and faces are kept. A sentence, or nothing.
std::optional<std::string> read_elements(const PlyHeader& header, PlyNumbers numbers, Polygons& polygons) {
  double vertex_count = 0.0;
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex") vertex_count += static_cast<double>(element.count);
  for (const PlyElement& element : header.elements) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const auto who = [&] { return element.name + " " + std::to_string(i + 1); };
      Vec3 place = Vec3::Zero();
      for (const PlyProperty& property : element.properties) {
        std::vector<std::size_t> corners;
        const bool is_list = property.count.size > 0;
        const bool is_loop =
            is_face && (property.name == "vertex_indices" || property.name == "vertex_index");
        const auto count = is_list ? numbers.next(property.count) : std::optional<double>(1.0);
        if (!count || !is_natural(*count, 4294967296.0))
          return "the file is cut short or damaged: " + who() + " has no length of its list";
        for (double k = 0.0; k < *count; ++k) {
          const auto number = numbers.next(property.type);
          if (!number) return "the file is cut short or damaged: " + who() + " lacks a number";
          if (is_vertex && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
            place[property.name[0] - 'x'] = *number;
          if (!is_loop) continue;
          if (!is_natural(*number, vertex_count))
            return who() + " names a vertex that is not there; the file is damaged";
          corners.push_back(static_cast<std::size_t>(*number));
        }
        if (is_loop) polygons.add(corners);
      }
      if (is_vertex) polygons.positions.push_back(place);
    }
  }
  return std::nullopt;
}

}  // namespace

core::Result<geometry::TriangleMesh> read_ply(const std::string& bytes, const std::filesystem::path& path,
                                              std::vector<std::string>* notes) {
  PlyHeader header;
  if (const auto fault = read_header(bytes, header)) return mesh_fault(path, 0, *fault);
  Polygons polygons;
  const std::string_view rest = std::string_view(bytes).substr(header.end);
  if (const auto fault = read_elements(header, PlyNumbers(rest, header.format), polygons))
    return mesh_fault(path, 0, *fault);
  return make_triangles(std::move(polygons), path, notes);
}

}  // namespace shatterbox::sandbox::scene
