// Which flaws of an element lie in one of its cells.
#pragma once

#include <algorithm>

#include "engine/fracture/element_plane.h"
#include "engine/fracture/flaws.h"
#include "engine/geometry/shell_mesh.h"

namespace shatterbox::fracture {

/// Whether a point of a cell's element, by its barycentric weights, is in the cell (border included).
inline bool cell_holds(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell,
                       const Vec2& barycentric) {
  if (cell.corner_count == 3 && cell.area > 0.999 * element_area(*mesh.elements, cell.element)) return true;
  const auto corner = [&](int i) -> const Vec2& {
    return mesh.corners[static_cast<std::size_t>(cell.first_corner + i)].barycentric;
  };
  for (int i = 0; i < cell.corner_count; ++i) {
    const Vec2& from = corner(i);
    if (cross(corner((i + 1) % cell.corner_count) - from, barycentric - from) < 0.0) return false;
  }
  return true;
}

/// Strength of a cell's weakest flaw, Pa; that of sound material if it has none.
inline double weakest_strength(const FlawField& flaws, const geometry::ShellMesh& mesh, int cell) {
  const geometry::ShellCell& c = mesh.cells[static_cast<std::size_t>(cell)];
  for (const Flaw& flaw : flaws.of_element(c.element))
    if (cell_holds(mesh, c, flaw.barycentric)) return std::min(flaw.strength, flaws.greatest_strength);
  return flaws.greatest_strength;
}

}  // namespace shatterbox::fracture
