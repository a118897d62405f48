// Reads a .glb by the specification's own rules and says which of them it breaks: enough of Khronos'
// validator for what we write.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace shatterbox::sandbox::model {

struct Glb {
  nlohmann::json json;
  std::string binary;
  std::vector<std::string> faults;

  void require(bool is_so, const std::string& rule) {
    if (!is_so) faults.push_back(rule);
  }
  const nlohmann::json& at(const char* list, const nlohmann::json& number) const {
    return json.at(list).at(number.get<std::size_t>());
  }
  std::size_t width(const nlohmann::json& accessor) const {
    const std::string type = accessor.at("type");
    return type == "VEC4" ? 4 : type == "VEC3" ? 3 : 1;
  }
  /// All numbers of an accessor of floats, or of whole numbers.
  template <class Number>
  std::vector<Number> numbers(const nlohmann::json& number) const {
    const nlohmann::json& accessor = at("accessors", number);
    const nlohmann::json& view = at("bufferViews", accessor.at("bufferView"));
    const std::size_t each = width(accessor), stride = view.value("byteStride", 4 * each);
    std::size_t place =
        view.at("byteOffset").get<std::size_t>() + accessor.at("byteOffset").get<std::size_t>();
    std::vector<Number> values;
    for (std::size_t i = 0; i < accessor.at("count").get<std::size_t>(); ++i, place += stride) {
      for (std::size_t k = 0; k < each; ++k) {
        Number value{};
        std::memcpy(&value, binary.data() + place + 4 * k, 4);
        values.push_back(value);
      }
    }
    return values;
  }
};

/// Header and chunks.
inline Glb open_glb(const std::string& bytes) {
  Glb glb;
  const auto word = [&bytes](std::size_t place) {
    std::uint32_t value = 0;
    if (place + 4 <= bytes.size()) std::memcpy(&value, bytes.data() + place, 4);
    return std::size_t{value};
  };
  glb.require(word(0) == 0x46546C67 && word(4) == 2, "magic number and version 2");
  glb.require(word(8) == bytes.size(), "length in the header");
  const std::size_t text = word(12);
  glb.require(word(16) == 0x4E4F534A && text % 4 == 0, "the JSON chunk comes first, in whole fours");
  glb.json = nlohmann::json::parse(bytes.substr(20, text));
  const std::size_t next = 20 + text;
  if (next == bytes.size()) return glb;
  glb.require(word(next + 4) == 0x004E4942 && word(next) % 4 == 0, "the binary chunk, in whole fours");
  glb.binary = bytes.substr(next + 8);
  glb.require(glb.binary.size() == word(next), "length of the binary chunk");
  glb.require(glb.json.at("buffers").size() == 1 && glb.json["buffers"][0]["byteLength"] == glb.binary.size(),
              "one buffer of that length");
  return glb;
}

inline void check_accessors(Glb& glb) {
  for (const auto& view : glb.json.at("bufferViews"))
    glb.require(view.at("byteLength") > 0 && view.at("byteOffset").get<std::size_t>() % 4 == 0 &&
                    view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>() <=
                        glb.binary.size(),
                "a view lies in the buffer, at a multiple of 4");
  for (std::size_t i = 0; i < glb.json.at("accessors").size(); ++i) {
    const auto& accessor = glb.json["accessors"][i];
    const auto& view = glb.at("bufferViews", accessor.at("bufferView"));
    const std::size_t each = glb.width(accessor), stride = view.value("byteStride", 4 * each);
    const std::size_t count = accessor.at("count"), offset = accessor.at("byteOffset");
    glb.require(count > 0 && offset % 4 == 0 &&
                    offset + (count - 1) * stride + 4 * each <= view.at("byteLength").get<std::size_t>(),
                "an accessor lies in its view, at a multiple of 4");
    if (accessor.at("componentType") != 5126) continue;
    const std::vector<float> values = glb.numbers<float>(i);
    for (const float value : values) glb.require(std::isfinite(value), "no nan and no infinity");
    if (!accessor.contains("min")) continue;
    for (std::size_t k = 0; k < each; ++k) {
      float least = values[k], most = least;
      for (std::size_t j = k; j < values.size(); j += each) {
        least = std::min(least, values[j]);
        most = std::max(most, values[j]);
      }
      glb.require(accessor["min"][k] == least && accessor["max"][k] == most, "min and max are the values'");
    }
  }
}

inline void check_meshes(Glb& glb) {
  std::set<std::size_t> materials;
  for (const auto& mesh : glb.json.at("meshes")) {
    for (const auto& primitive : mesh.at("primitives")) {
      const auto& positions = glb.at("accessors", primitive.at("attributes").at("POSITION"));
      glb.require(positions.contains("min") && positions.contains("max"), "positions have min and max");
      glb.require(glb.at("accessors", primitive["attributes"].at("NORMAL"))["count"] == positions["count"],
                  "a normal a vertex");
      const auto normals = glb.numbers<float>(primitive["attributes"]["NORMAL"]);
      for (std::size_t v = 0; v < normals.size(); v += 3)
        glb.require(std::abs(std::hypot(normals[v], normals[v + 1], normals[v + 2]) - 1.0F) < 5e-4F,
                    "normals are unit");
      const auto indices = glb.numbers<std::uint32_t>(primitive.at("indices"));
      glb.require(indices.size() % 3 == 0, "whole triangles");
      for (const std::uint32_t index : indices)
        glb.require(index < positions["count"].get<std::uint32_t>(), "an index names a vertex");
      materials.insert(primitive.at("material").get<std::size_t>());
    }
  }
  glb.require(
      materials.size() == glb.json.at("materials").size() && *materials.rbegin() + 1 == materials.size(),
      "every material is there, and used");
}

inline void check_animation(Glb& glb) {
  const auto& animation = glb.json.at("animations").at(0);
  std::set<std::pair<std::size_t, std::string>> targets;
  for (const auto& channel : animation.at("channels")) {
    const auto& sampler = animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
    const std::string path = channel.at("target").at("path");
    glb.require(targets.emplace(channel["target"].at("node"), path).second, "one channel a target");
    (void)glb.at("nodes", channel["target"]["node"]);
    const auto times = glb.numbers<float>(sampler.at("input"));
    glb.require(glb.at("accessors", sampler["input"]).contains("max"), "times have min and max");
    for (std::size_t i = 0; i < times.size(); ++i)
      glb.require(times[i] >= 0.0F && (i == 0 || times[i] > times[i - 1]), "times increase strictly from 0");
    const auto& output = glb.at("accessors", sampler.at("output"));
    glb.require(output["count"] == times.size(), "a value a key");
    glb.require(output["type"] == (path == "rotation" ? "VEC4" : "VEC3"), "values of the path's type");
    if (path != "rotation") continue;
    const auto q = glb.numbers<float>(sampler["output"]);
    for (std::size_t i = 0; i < q.size(); i += 4) {
      const auto dot = [&q](std::size_t a, std::size_t b) {
        return q[a] * q[b] + q[a + 1] * q[b + 1] + q[a + 2] * q[b + 2] + q[a + 3] * q[b + 3];
      };
      glb.require(std::abs(dot(i, i) - 1.0F) < 1e-6F, "quaternions are unit");
      glb.require(i == 0 || dot(i, i - 4) >= 0.0F, "turns go the short way round");
    }
  }
}

/// The file of these bytes, with all rules that it breaks.
inline Glb read_glb(const std::string& bytes) {
  Glb glb = open_glb(bytes);
  glb.require(glb.json.at("asset").at("version") == "2.0", "asset.version");
  check_accessors(glb);
  check_meshes(glb);
  check_animation(glb);
  return glb;
}

/// Translation (3), rotation (x, y, z, w) or scale (3) of a node at a time, s, as a player finds it.
inline std::vector<float> value_at(const Glb& glb, std::size_t node, const std::string& path, float time) {
  const auto& animation = glb.json["animations"][0];
  for (const auto& channel : animation["channels"]) {
    if (channel["target"]["node"] != node || channel["target"]["path"] != path) continue;
    const auto& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
    const auto times = glb.numbers<float>(sampler["input"]);
    const auto values = glb.numbers<float>(sampler["output"]);
    const std::size_t each = values.size() / times.size();
    std::size_t after = 0;
    while (after < times.size() && times[after] <= time) ++after;
    const std::size_t from = after == 0 ? 0 : after - 1, to = std::min(after, times.size() - 1);
    const bool is_between = to > from && sampler["interpolation"] == "LINEAR";
    const float share = is_between ? (time - times[from]) / (times[to] - times[from]) : 0.0F;
    std::vector<float> value(each);
    float length = 0.0F;
    for (std::size_t k = 0; k < each; ++k) {
      value[k] = values[from * each + k] + share * (values[to * each + k] - values[from * each + k]);
      length += value[k] * value[k];
    }
    for (float& v : value) v /= each == 4 ? std::sqrt(length) : 1.0F;
    return value;
  }
  const auto& resting = glb.json["nodes"][node];
  if (!resting.contains(path)) return {1.0F, 1.0F, 1.0F};  // a scale
  return resting[path].get<std::vector<float>>();
}

}  // namespace shatterbox::sandbox::model
