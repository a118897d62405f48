// What of a sheet lies along parallel lines.
#pragma once

#include <vector>

#include "engine/geometry/column.h"
#include "engine/geometry/shell_mesh.h"

namespace shatterbox::geometry {

/// One column a place (m, along `first` and `second`), of the material of `cells` of a sheet `thickness` m
/// thick, its middle in the mesh. Where the sheet is nearly along the line, as if it stood at six degrees to
/// it.
std::vector<Column> find_columns(const ShellMesh& mesh, double thickness, const std::vector<int>& cells,
                                 const ColumnAxes& axes, const std::vector<Vec2>& places);

}  // namespace shatterbox::geometry
