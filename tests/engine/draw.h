// Random vectors and turns.
#pragma once

#include "engine/core/random.h"
#include "engine/core/vec.h"

namespace shatterbox::test {

/// In the cube from -1 to 1.
inline Vec3 draw_vector(core::Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

/// By up to some 3.5 `most`, rad, where that is small.
inline Quat draw_turn(core::Random& random, double most) {
  const Vec3 axis = most * draw_vector(random);
  return Quat(1.0, axis.x(), axis.y(), axis.z()).normalized();
}

}  // namespace shatterbox::test
