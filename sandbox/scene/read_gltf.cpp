// glTF 2.0, as text (.gltf, with its buffers in it or beside it) or in one file (.glb): the triangles of all
// meshes, where the nodes of its scene put them. Numbers of the text are believed only as far as there are
// bytes.
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "sandbox/scene/polygons.h"

namespace shatterbox::sandbox::scene {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{1} << 32;  // that a number of the text can mean
constexpr std::size_t kMostCopied = 5'000'000;            // vertices, copies by several nodes included
constexpr int kDeepest = 100;                             // nodes in nodes

/// What is wrong with the file, as a sentence.
struct GltfFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const Json* find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<std::size_t> find_number(const Json& object, const char* key) {
  const Json* value = find(object, key);
  if (value == nullptr) return std::nullopt;
  if (!value->is_number_unsigned() || value->get<std::uint64_t>() >= kMostBytes)
    throw GltfFault(std::string("\"") + key + "\" is not a whole number from 0 on");
  return static_cast<std::size_t>(value->get<std::uint64_t>());
}

const Json& entry_of(const Json& root, const char* list, std::size_t number) {
  const Json* entries = find(root, list);
  if (entries == nullptr || !entries->is_array() || number >= entries->size())
    throw GltfFault(std::string("there is no number ") + std::to_string(number) + " in \"" + list + "\"");
  return (*entries)[number];
}

std::string decode_base64(std::string_view text) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    int value = 0;
    if (c >= 'A' && c <= 'Z')
      value = c - 'A';
    else if (c >= 'a' && c <= 'z')
      value = c - 'a' + 26;
    else if (c >= '0' && c <= '9')
      value = c - '0' + 52;
    else if (c == '+')
      value = 62;
    else if (c == '/')
      value = 63;
    else if (c == '=')
      break;
    else
      throw GltfFault("a buffer is not base64");
    bits = (bits << 6) | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>((bits >> count) & 0xff);
  }
  return bytes;
}

/// "a%20b" is "a b".
std::string decode_percents(const std::string& uri) {
  std::string text;
  for (std::size_t k = 0; k < uri.size(); ++k) {
    const auto digit = [&](std::size_t place) {
      return std::string_view("0123456789abcdef").find(static_cast<char>(uri[place] | 0x20));
    };
    if (uri[k] == '%' && k + 2 < uri.size() && digit(k + 1) < 16 && digit(k + 2) < 16) {
      text += static_cast<char>(16 * digit(k + 1) + digit(k + 2));
      k += 2;
    } else {
      text += uri[k];
    }
  }
  return text;
}

std::string read_beside(const std::filesystem::path& path, const std::string& uri) {
  const std::filesystem::path file = path.parent_path() / decode_percents(uri);
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error || !std::filesystem::is_regular_file(file, error) || size >= kMostBytes / 8)
    throw GltfFault("its buffer " + file.string() + " is not there, or is no file that can be read");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw GltfFault("its buffer " + file.string() + " cannot be read");
  return bytes;
}

/// Where a node puts what is in it: columns of its axes, then its place.
struct Placing {
  Mat3 axes = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
};

std::vector<double> numbers_of(const Json& node, const char* key, std::size_t count) {
  const Json* value = find(node, key);
  if (value == nullptr) return {};
  std::vector<double> numbers;
  if (value->is_array())
    for (const Json& number : *value)
      if (number.is_number()) numbers.push_back(number.get<double>());
  if (numbers.size() != count)
    throw GltfFault(std::string("a node's \"") + key + "\" is not " + std::to_string(count) + " numbers");
  return numbers;
}

Placing placing_of(const Json& node) {
  Placing placing;
  if (const auto m = numbers_of(node, "matrix", 16); !m.empty()) {
    for (Eigen::Index k = 0; k < 9; ++k)
      placing.axes(k % 3, k / 3) = m[static_cast<std::size_t>(k / 3 * 4 + k % 3)];
    placing.origin = {m[12], m[13], m[14]};
    return placing;
  }
  if (const auto r = numbers_of(node, "rotation", 4); !r.empty()) {
    const Quat turn(r[3], r[0], r[1], r[2]);
    if (!(turn.norm() > 0.0)) throw GltfFault("a node's \"rotation\" is all zeros");
    placing.axes = turn.normalized().toRotationMatrix();
  }
  if (const auto s = numbers_of(node, "scale", 3); !s.empty())
    placing.axes = placing.axes * Vec3(s[0], s[1], s[2]).asDiagonal();
  if (const auto t = numbers_of(node, "translation", 3); !t.empty()) placing.origin = {t[0], t[1], t[2]};
  return placing;
}

class GltfReader {
 public:
  GltfReader(Json root, std::string own_buffer, std::filesystem::path path)
      : root_(std::move(root)), own_buffer_(std::move(own_buffer)), path_(std::move(path)) {}

  Polygons read() {
    const Json* scenes = find(root_, "scenes");
    if (scenes != nullptr && scenes->is_array() && !scenes->empty()) {
      const Json& scene = entry_of(root_, "scenes", find_number(root_, "scene").value_or(0));
      read_children(scene, "nodes", Placing(), 0);
    } else if (const Json* meshes = find(root_, "meshes"); meshes != nullptr && meshes->is_array()) {
      for (const Json& mesh : *meshes) read_mesh(mesh, Placing());
    }
    return std::move(polygons_);
  }

 private:
  void read_children(const Json& parent, const char* key, const Placing& placing, int depth) {
    const Json* children = find(parent, key);
    if (children == nullptr || !children->is_array()) return;
    if (depth > kDeepest) throw GltfFault("its nodes are within each other without end");
    for (const Json& child : *children) {
      if (!child.is_number_unsigned()) throw GltfFault("a child of a node is no number");
      const Json& node = entry_of(root_, "nodes", child.get<std::size_t>());
      if (++nodes_ > root_["nodes"].size())
        throw GltfFault("one of its nodes is in several others, or in itself");
      const Placing own = placing_of(node);
      const Placing all{placing.axes * own.axes, placing.origin + placing.axes * own.origin};
      if (const auto mesh = find_number(node, "mesh")) read_mesh(entry_of(root_, "meshes", *mesh), all);
      read_children(node, "children", all, depth + 1);
    }
  }

  void read_mesh(const Json& mesh, const Placing& placing) {
    const Json* primitives = find(mesh, "primitives");
    if (primitives == nullptr || !primitives->is_array()) return;
    for (const Json& primitive : *primitives) {
      if (++primitives_ > kMostCopied) throw GltfFault("it has too many meshes, copies included");
      if (const Json* extensions = find(primitive, "extensions");
          extensions != nullptr && find(*extensions, "KHR_draco_mesh_compression") != nullptr)
        throw GltfFault("its meshes are compressed (Draco), which is not read; export it without");
      read_primitive(primitive, placing);
    }
  }

  void read_primitive(const Json& primitive, const Placing& placing) {
    const std::size_t mode = find_number(primitive, "mode").value_or(4);
    const Json* attributes = find(primitive, "attributes");
    const auto where = attributes == nullptr ? std::nullopt : find_number(*attributes, "POSITION");
    if (!where) return;
    if (mode < 4 || mode > 6) {
      ++polygons_.left_out;
      return;
    }
    const std::size_t first = polygons_.positions.size();
    const std::size_t count = add_positions(entry_of(root_, "accessors", *where), placing);
    std::vector<std::size_t> corners;
    if (const auto indices = find_number(primitive, "indices")) {
      corners = read_indices(entry_of(root_, "accessors", *indices), count);
    } else {
      for (std::size_t k = 0; k < count; ++k) corners.push_back(k);
    }
    // What is mirrored is wound the other way.
    const bool is_mirrored = placing.axes.determinant() < 0.0;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      if (is_mirrored) std::swap(b, c);
      polygons_.add({first + corners[a], first + corners[b], first + corners[c]});
    };
    if (mode == 4)
      for (std::size_t k = 0; k + 2 < corners.size(); k += 3) add(k, k + 1, k + 2);
    else
      for (std::size_t k = 0; k + 2 < corners.size(); ++k) {
        if (mode == 6)
          add(0, k + 1, k + 2);
        else
          add(k, k + 1 + k % 2, k + 2 - k % 2);
      }
  }

  /// A view of bytes that hold `count` elements of `size` bytes, `stride` apart; all of them are there.
  struct Elements {
    const char* begin = nullptr;
    std::size_t count = 0, stride = 0, component = 0;
  };

  Elements elements_of(const Json& accessor, std::size_t parts) {
    if (find(accessor, "sparse") != nullptr) throw GltfFault("it has a sparse accessor, which is not read");
    Elements elements;
    elements.component = find_number(accessor, "componentType").value_or(0);
    elements.count = find_number(accessor, "count").value_or(0);
    const std::size_t bytes = elements.component == 5126 || elements.component == 5125 ? 4
                              : elements.component == 5123                             ? 2
                                                                                       : 1;
    const auto view_number = find_number(accessor, "bufferView");
    if (!view_number) throw GltfFault("an accessor has no bufferView");
    const Json& view = entry_of(root_, "bufferViews", *view_number);
    const std::string& buffer = buffer_of(find_number(view, "buffer").value_or(0));
    const std::size_t start = find_number(view, "byteOffset").value_or(0);
    const std::size_t length = find_number(view, "byteLength").value_or(0);
    const std::size_t offset = find_number(accessor, "byteOffset").value_or(0);
    elements.stride = find_number(view, "byteStride").value_or(bytes * parts);
    if (elements.count > kMostCopied || elements.stride < bytes * parts ||
        elements.stride > 252 + bytes * parts)
      throw GltfFault("an accessor makes no sense: " + std::to_string(elements.count) + " elements, " +
                      std::to_string(elements.stride) + " bytes apart");
    const std::size_t needed =
        elements.count == 0 ? 0 : offset + (elements.count - 1) * elements.stride + bytes * parts;
    if (start > buffer.size() || length > buffer.size() - start || needed > length)
      throw GltfFault("an accessor reaches beyond its buffer; the file is damaged or cut short");
    elements.begin = buffer.data() + start + offset;
    return elements;
  }

  std::size_t add_positions(const Json& accessor, const Placing& placing) {
    const Elements elements = elements_of(accessor, 3);
    if (elements.component != 5126) throw GltfFault("its positions are not floats");
    if (polygons_.positions.size() + elements.count > kMostCopied)
      throw GltfFault("it has more than " + std::to_string(kMostCopied) + " vertices, copies included");
    for (std::size_t k = 0; k < elements.count; ++k) {
      float p[3];
      std::memcpy(p, elements.begin + k * elements.stride, sizeof p);
      polygons_.positions.emplace_back(placing.axes * Vec3(p[0], p[1], p[2]) + placing.origin);
    }
    return elements.count;
  }

  std::vector<std::size_t> read_indices(const Json& accessor, std::size_t vertices) {
    const Elements elements = elements_of(accessor, 1);
    if (elements.component != 5121 && elements.component != 5123 && elements.component != 5125)
      throw GltfFault("its corners are not whole numbers");
    const std::size_t bytes = elements.component == 5125 ? 4 : elements.component == 5123 ? 2 : 1;
    corners_ += elements.count;
    if (corners_ > 6 * kMostCopied) throw GltfFault("it has too many triangles, copies included");
    std::vector<std::size_t> corners;
    for (std::size_t k = 0; k < elements.count; ++k) {
      std::uint32_t corner = 0;
      std::memcpy(&corner, elements.begin + k * elements.stride, bytes);
      if (corner >= vertices)
        throw GltfFault("a triangle names vertex " + std::to_string(corner) + " of " +
                        std::to_string(vertices));
      corners.push_back(corner);
    }
    return corners;
  }

  const std::string& buffer_of(std::size_t number) {
    if (number >= buffers_.size()) buffers_.resize(std::min<std::size_t>(number + 1, 1000));
    if (number >= buffers_.size()) throw GltfFault("it has too many buffers");
    if (buffers_[number]) return *buffers_[number];
    const Json* uri = find(entry_of(root_, "buffers", number), "uri");
    if (uri == nullptr) {
      buffers_[number] = number == 0 ? own_buffer_ : std::string();
    } else if (!uri->is_string()) {
      throw GltfFault("a buffer's \"uri\" is no text");
    } else {
      const auto text = uri->get<std::string>();
      const std::size_t data = text.compare(0, 5, "data:") == 0 ? text.find(";base64,") : std::string::npos;
      buffers_[number] = data == std::string::npos ? read_beside(path_, text)
                                                   : decode_base64(std::string_view(text).substr(data + 8));
    }
    return *buffers_[number];
  }

  Json root_;
  std::string own_buffer_;  // of a .glb
  std::filesystem::path path_;
  Polygons polygons_;
  std::vector<std::optional<std::string>> buffers_;
  std::size_t nodes_ = 0, primitives_ = 0, corners_ = 0;
};

/// The text and the buffer of a .glb.
std::pair<std::string_view, std::string> parts_of(std::string_view bytes) {
  const auto number_at = [&](std::size_t place) {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + place, 4);
    return number;
  };
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  if (bytes.size() < 20 || number_at(4) != 2) throw GltfFault("this is no glTF 2.0 file");
  std::string_view text;
  std::string buffer;
  for (std::size_t place = 12; place + 8 <= bytes.size();) {
    const std::size_t length = number_at(place);
    if (length > bytes.size() - place - 8) throw GltfFault("the file is cut short");
    if (number_at(place + 4) == kJson && text.empty()) text = bytes.substr(place + 8, length);
    if (number_at(place + 4) == kBinary && buffer.empty()) buffer = bytes.substr(place + 8, length);
    place += 8 + length;
  }
  return {text, buffer};
}

}  // namespace

core::Result<geometry::TriangleMesh> read_gltf(const std::string& bytes, const std::filesystem::path& path,
                                               std::vector<std::string>* notes) {
  try {
    const bool is_binary = bytes.compare(0, 4, "glTF") == 0;
    auto [text, buffer] = is_binary ? parts_of(bytes) : std::pair(std::string_view(bytes), std::string());
    Json root = Json::parse(text, nullptr, false);
    if (root.is_discarded() || !root.is_object())
      throw GltfFault("this is no glTF file: its text is no JSON");
    return make_triangles(GltfReader(std::move(root), std::move(buffer), path).read(), path, notes);
  } catch (const GltfFault& fault) {
    return mesh_fault(path, 0, fault.what());
  }
}

}  // namespace shatterbox::sandbox::scene
