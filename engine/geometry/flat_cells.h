// Cells of the material without a volume, where the given surface lies on faces of the elements or touches
// them: each goes to a neighbour. For embedded_material.cpp.
#pragma once

#include <vector>

#include "engine/geometry/embedded_material.h"

namespace shatterbox::geometry {

/// Joins cells whose volume is zero with the neighbour with which they have most area in common (directly or
/// over other such cells), and numbers the others anew in their order. Facets inside a joined cell go.
void join_flat_cells(const std::vector<Vec3>& positions, EmbeddedMaterial& embedded);

}  // namespace shatterbox::geometry
