// The crushed core about a hard hit: graded Voronoi cells cut into whatever is there. The squared distances
// to two seeds differ by a linear function of space, so the cells are exact in every element and agree across
// its edges.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/fracture/decide_shell.h"
#include "engine/fracture/element_plane.h"
#include "engine/fracture/shell_cutter.h"

namespace shatterbox::fracture {

struct CoreSetup {
  Vec3 centre = Vec3::Zero();
  double patch_radius = 0.0;  // m
  double cell_size =
      0.0;  // m, at the edge of the patch; half of it inside, growing with the distance outside
  std::vector<int> elements;  // that are crushed, ascending
  double most_length = -1.0;  // m of crack that the energy allows; below zero: no guard
  int crack = 0;              // number of the core as one crack
  int generation = 0;
  std::uint64_t seed = 1;
};

struct Core {
  std::vector<CrackSegment> segments;
  int cells = 0;                  // Voronoi cells that got material
  double length = 0.0;            // m
  bool is_out_of_energy = false;  // nothing was cut then
};

Core crush_core(ShellCutter& cutter, const std::vector<ElementPlane>& planes, const CoreSetup& setup);

}  // namespace shatterbox::fracture
