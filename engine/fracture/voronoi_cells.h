// Voronoi cells cut into whatever is there. The squared distances to two seeds differ by a linear function
// of space, so the cells are exact in every element and agree across its edges.
#pragma once

#include <vector>

#include "engine/fracture/decide_shell.h"
#include "engine/fracture/element_plane.h"
#include "engine/fracture/shell_cutter.h"

namespace shatterbox::fracture {

struct CellSeed {
  Vec3 position = Vec3::Zero();  // material space, m
  bool is_open = true;  // its cell is broken out whole; between two that are not material stays whole
  int piece = 0;        // whose material it divides
};

struct CellSetup {
  std::vector<int> elements;  // to be cut, ascending
  std::vector<CellSeed> seeds;
  std::vector<int> pieces;    // that the cells of the cutter's mesh are in; empty: all in piece 0
  double reach = 1e300;       // m: no point of an element belongs to a seed further away than this
  double most_length = -1.0;  // m of crack that the energy allows; below zero: no guard
  int crack = 0;              // number of all these cracks as one
  int generation = 0;
};

struct CellCracks {
  std::vector<CrackSegment> segments;
  int cells = 0;                  // broken out, of those that got material
  double length = 0.0;            // m
  bool is_out_of_energy = false;  // nothing was cut then
};

CellCracks cut_cells(ShellCutter& cutter, const ElementPlanes& planes, const CellSetup& setup);

}  // namespace shatterbox::fracture
