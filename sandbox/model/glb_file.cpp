#include "sandbox/model/glb_file.h"

#include <cstring>
#include <limits>

namespace shatterbox::sandbox::model {

namespace {

// The format's own numbers.
constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

void put(std::string& text, std::uint32_t number) {
  for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>((number >> shift) & 255U);
}

/// A number that is written as the float it is.
Json exact(float value) {
  return static_cast<double>(value);
}

Json exact(const glm::vec3& v) {
  return Json::array({exact(v.x), exact(v.y), exact(v.z)});
}

}  // namespace

int GlbFile::add(Use use, const void* data, std::size_t count, int component, const char* type,
                 std::size_t bytes_each) {
  accessors_.push_back({{"bufferView", static_cast<int>(use)},
                        {"byteOffset", data_[use].size()},
                        {"componentType", component},
                        {"count", count},
                        {"type", type}});
  data_[use].append(static_cast<const char*>(data), count * bytes_each);
  return static_cast<int>(accessors_.size()) - 1;
}

int GlbFile::add_positions(std::span<const glm::vec3> positions) {
  const int accessor = add(kVertices, positions.data(), positions.size(), kFloat, "VEC3", sizeof(glm::vec3));
  glm::vec3 least = positions.front(), most = least;
  for (const glm::vec3& p : positions) {
    least = glm::min(least, p);
    most = glm::max(most, p);
  }
  accessors_.back()["min"] = exact(least);
  accessors_.back()["max"] = exact(most);
  return accessor;
}

int GlbFile::add_normals(std::span<const glm::vec3> normals) {
  return add(kVertices, normals.data(), normals.size(), kFloat, "VEC3", sizeof(glm::vec3));
}

int GlbFile::add_indices(std::span<const std::uint32_t> indices) {
  return add(kIndices, indices.data(), indices.size(), kUnsignedInt, "SCALAR", sizeof(std::uint32_t));
}

int GlbFile::add_times(const std::vector<float>& times) {
  const auto [place, is_new] = times_.try_emplace(times, 0);
  if (!is_new) return place->second;
  place->second = add(kAnimation, times.data(), times.size(), kFloat, "SCALAR", sizeof(float));
  accessors_.back()["min"] = Json::array({exact(times.front())});
  accessors_.back()["max"] = Json::array({exact(times.back())});
  return place->second;
}

int GlbFile::add_values(std::span<const glm::vec3> values) {
  return add(kAnimation, values.data(), values.size(), kFloat, "VEC3", sizeof(glm::vec3));
}

int GlbFile::add_values(std::span<const glm::vec4> values) {
  return add(kAnimation, values.data(), values.size(), kFloat, "VEC4", sizeof(glm::vec4));
}

Json GlbFile::views() const {
  Json views = Json::array();
  std::size_t offset = 0;
  for (std::size_t use = 0; use < kUses; ++use) {
    if (data_[use].empty()) continue;
    views.push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", data_[use].size()}});
    if (use == kVertices) views.back()["byteStride"] = sizeof(glm::vec3);
    if (use != kAnimation) views.back()["target"] = use == kVertices ? kArrayBuffer : kElementArrayBuffer;
    offset += data_[use].size();
  }
  return views;
}

std::string GlbFile::bytes() const {
  Json whole = json;
  std::size_t binary = 0;
  std::array<int, kUses> view_of{};
  int view = 0;
  for (std::size_t use = 0; use < kUses; ++use) {
    view_of[use] = view;
    if (!data_[use].empty()) ++view;
    binary += data_[use].size();
  }
  if (!accessors_.empty()) {
    whole["accessors"] = accessors_;
    for (Json& accessor : whole["accessors"])
      accessor["bufferView"] = view_of[accessor["bufferView"].get<std::size_t>()];
    whole["bufferViews"] = views();
    whole["buffers"] = Json::array({{{"byteLength", binary}}});
  }
  std::string text = whole.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.append((4 - text.size() % 4) % 4, ' ');
  const std::size_t length = 12 + 8 + text.size() + (binary > 0 ? 8 + binary : 0);
  if (length > std::numeric_limits<std::uint32_t>::max()) return {};
  std::string bytes;
  bytes.reserve(length);
  for (const std::uint32_t number : {kMagic, kVersion, static_cast<std::uint32_t>(length),
                                     static_cast<std::uint32_t>(text.size()), kJsonChunk})
    put(bytes, number);
  bytes += text;
  if (binary == 0) return bytes;
  put(bytes, static_cast<std::uint32_t>(binary));  // whole fours: all that goes in is of four bytes
  put(bytes, kBinaryChunk);
  for (const std::string& data : data_) bytes += data;
  return bytes;
}

}  // namespace shatterbox::sandbox::model
