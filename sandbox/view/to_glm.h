// Vectors and poses of the engine as the pictures take them.
#pragma once

#include <glm/glm.hpp>

#include "engine/core/vec.h"

namespace shatterbox::sandbox::view {

inline glm::vec3 to_glm(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

inline glm::mat4 to_glm(const Pose& pose) {
  const Mat3 rotation = pose.rotation.toRotationMatrix();
  glm::mat4 matrix(1.0F);
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) matrix[column][row] = static_cast<float>(rotation(row, column));
  }
  matrix[3] = glm::vec4(to_glm(pose.translation), 1.0F);
  return matrix;
}

}  // namespace shatterbox::sandbox::view
