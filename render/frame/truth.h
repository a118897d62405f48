// What a picture shows, in numbers: for those who train on it, or measure in it.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace shatterbox::render {

// Of each pixel's middle, row 0 on top.
struct Truth {
  int width = 0, height = 0;
  std::vector<float> depths;          // m along the camera's axis; infinity where nothing is
  std::vector<glm::vec3> normals;     // world, unit, as they are lit; 0 where nothing is
  std::vector<std::uint32_t> ids;     // Draw::id or Ground::id; 0 where nothing is
  glm::mat4 world_from_camera{1.0F};  // x right, y up, z back, m
  float focal = 0.0F;                 // pixels; the axis meets the picture's middle
};

}  // namespace shatterbox::render
