// Dice: the small pieces that a sheet with stress stored in it breaks into all over, wherever it was broken.
#pragma once

#include <cstdint>

#include "engine/fracture/voronoi_cells.h"

namespace shatterbox::fracture {

struct DiceSetup {
  double area = 0.0;  // m2, mean of the dice (`material::die_area`)
  int crack = 0;      // number of all their cracks as one
  int generation = 0;
  std::uint64_t seed = 1;
};

/// Voronoi cells of seeds that keep apart, over all there is. The seeds do not depend on the elements.
CellCracks cut_dice(ShellCutter& cutter, const ElementPlanes& planes, const DiceSetup& setup);

}  // namespace shatterbox::fracture
