// A binary glTF 2.0 file (Khronos, ISO/IEC 12113): arrays go in and become accessors, the JSON beside them is
// the caller's.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace shatterbox::sandbox::model {

using Json = nlohmann::ordered_json;

class GlbFile {
 public:
  // Each returns the number of the accessor.
  int add_positions(std::span<const glm::vec3> positions);  // with their box, as the format wants it
  int add_normals(std::span<const glm::vec3> normals);
  int add_indices(std::span<const std::uint32_t> indices);
  int add_times(const std::vector<float>& times);  // s, ascending; equal ones are kept once
  int add_values(std::span<const glm::vec3> values);
  int add_values(std::span<const glm::vec4> values);

  /// Everything but accessors, views and buffers, which write() adds.
  Json json = Json::object();

  /// All bytes of the file; empty if they are more than the format can count, 4 GB.
  std::string bytes() const;

 private:
  enum Use : std::size_t { kVertices, kIndices, kAnimation, kUses };

  int add(Use use, const void* data, std::size_t count, int component, const char* type,
          std::size_t bytes_each);
  Json views() const;

  std::array<std::string, kUses> data_;
  Json accessors_ = Json::array();  // their views are uses until the file is written
  std::map<std::vector<float>, int> times_;
};

}  // namespace shatterbox::sandbox::model
