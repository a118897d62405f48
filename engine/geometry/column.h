// What of a body lies on one of some parallel lines.
#pragma once

#include "engine/core/vec.h"

namespace shatterbox::geometry {

/// Axes of the lines: unit, right-handed; the lines run along `along`.
struct ColumnAxes {
  Vec3 first = Vec3::UnitX(), second = Vec3::UnitY(), along = Vec3::UnitZ();
};

struct Column {
  double length = 0.0;    // m, of the material on the line; 0: there is none
  double begin = 0.0;     // m, along the line from the origin's height: where it first enters
  double square_in = 0;   // cosine between the line and the border's normal there
  double end = 0.0;       // m: where it last leaves
  double square_out = 0;  // cosine there
};

}  // namespace shatterbox::geometry
