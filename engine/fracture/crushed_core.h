// The crushed cores about hard hits: graded Voronoi cells. Seeds and the cores' radii do not depend on the
// elements: a finer mesh has the same cores.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/fracture/voronoi_cells.h"

namespace shatterbox::fracture {

/// What is crushed about one point that is pressed.
struct CrushedCore {
  Vec3 centre = Vec3::Zero();
  double patch_radius = 0.0;  // m
  double cell_size = 0.0;     // m, inside the patch; it grows with the distance outside
  double radius = 0.0;        // m: cells whose seed is nearer to the centre than this are broken out whole
  std::uint64_t seed = 1;
};

/// Cores that share material within their reach, and all elements that are in it.
struct CoreGroup {
  std::vector<CrushedCore> cores;
  std::vector<int> elements;  // ascending
};

struct CoreSetup {
  CoreGroup group;
  std::vector<int> pieces;    // that the cells of the cutter's mesh are in: each is divided by itself
  double most_length = -1.0;  // m of crack that the energy allows; below zero: no guard
  int crack = 0;              // number of the cores as one crack
  int generation = 0;
};

/// Groups in the order of their first cores, each in the order of its own.
std::vector<CoreGroup> group_cores(const geometry::ShellElements& elements,
                                   const std::vector<CrushedCore>& cores);

/// Cells are cut out of what is within reach of the centres along the surface. What belongs to several cores
/// is cut once, and what cracks have parted is divided by itself: so radials are crossed by rings from crack
/// to crack. (Cells over cells, and over cracks, left splinters.)
CellCracks crush_cores(ShellCutter& cutter, const ElementPlanes& planes, const CoreSetup& setup);

/// How far the material is crushed about a point: the radius of the disc with as much area as the elements
/// (|T|: their stress over what crushes) that are above one there, within `reach` m. 0 if nothing is.
double crushed_radius(const geometry::ShellElements& elements, const std::vector<double>& overloads,
                      const Vec3& centre, double reach);

}  // namespace shatterbox::fracture
