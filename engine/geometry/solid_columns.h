// What of a solid lies along parallel lines: how long, from where to where, and how its border faces them.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/column.h"
#include "engine/geometry/solid_complex.h"

namespace shatterbox::geometry {

/// One column a place (m, along `first` and `second`), of the material of `cells` (settled, as if alone). A
/// line along an edge of the border belongs to one of the facets at it.
std::vector<Column> find_columns(const SolidComplex& complex, const std::vector<int>& cells,
                                 const ColumnAxes& axes, const std::vector<Vec2>& places);

}  // namespace shatterbox::geometry
