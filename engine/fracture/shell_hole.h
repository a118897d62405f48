// Decide, and cut: does a striker go through a sheet that yields? The plug is the cell about his line among
// those of its mirror images in the hole's sides (voronoi_cells.h): its sides are straight, whatever the
// triangles.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/fracture/decide_shell.h"
#include "engine/fracture/perforation.h"

namespace shatterbox::fracture {

struct ShellHole : Perforation {
  std::shared_ptr<const geometry::ShellMesh> mesh;  // cut; null: he is far
  std::vector<geometry::CellContact> contacts;      // of its cells
  std::vector<CrackSegment> segments;
};

/// As of solids (solid_hole.h). `crack` is the number of the hole as one.
std::optional<ShellHole> find_perforation(const ShellSubject& subject, const Striker& striker,
                                          double least_width, int crack);

}  // namespace shatterbox::fracture
