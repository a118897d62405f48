// What of a solid lies along parallel lines: how long, from where to where, and how its border faces them.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

/// Axes of the lines: unit, right-handed; the lines run along `along`.
struct ColumnAxes {
  Vec3 first = Vec3::UnitX(), second = Vec3::UnitY(), along = Vec3::UnitZ();
};

struct SolidColumn {
  double length = 0.0;    // m, of the material on the line; 0: there is none
  double begin = 0.0;     // m, along the line from the origin's height: where it first enters
  double square_in = 0;   // cosine between the line and the border's normal there
  double end = 0.0;       // m: where it last leaves
  double square_out = 0;  // cosine there
};

/// One column a place (m, along `first` and `second`), of the material of `cells` (settled, as if alone). A
/// line along an edge of the border belongs to one of the facets at it.
std::vector<SolidColumn> find_columns(const SolidComplex& complex, const std::vector<int>& cells,
                                      const ColumnAxes& axes, const std::vector<Vec2>& places);

}  // namespace shatterbox::geometry
