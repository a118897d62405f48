// The crushed core about a hard hit: graded Voronoi cells. Seeds and the core's radius do not depend on the
// elements: a finer mesh has the same core.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/fracture/voronoi_cells.h"

namespace shatterbox::fracture {

struct CoreSetup {
  Vec3 centre = Vec3::Zero();
  double patch_radius = 0.0;  // m
  double cell_size = 0.0;     // m, inside the patch; it grows with the distance outside
  double radius = 0.0;        // m: cells whose seed is nearer to the centre than this are broken out whole
  double most_length = -1.0;  // m of crack that the energy allows; below zero: no guard
  int crack = 0;              // number of the core as one crack
  int generation = 0;
  std::uint64_t seed = 1;
};

/// Cells are cut out of what is within reach of the centre along the surface.
CellCracks crush_core(ShellCutter& cutter, const ElementPlanes& planes, const CoreSetup& setup);

/// How far the material is crushed about a point: the radius of the disc with as much area as the elements
/// (|T|: their stress over what crushes) that are above one there, within `reach` m. 0 if nothing is.
double crushed_radius(const geometry::ShellElements& elements, const std::vector<double>& overloads,
                      const Vec3& centre, double reach);

}  // namespace shatterbox::fracture
