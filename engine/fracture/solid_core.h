// The crushed cores about hard hits on a solid: graded Voronoi cells, cut by planes. Their radii come from
// force and strength, their seeds are points of space: a finer mesh has the same cores.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/geometry/solid_complex.h"

namespace shatterbox::fracture {

/// What is crushed about one point that is pressed.
struct SolidCore {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;  // m: cells that lie within that, nearly all of them, are broken out whole
};

struct SolidCoreSetup {
  std::vector<SolidCore> cores;
  double least_size = 0.0;   // m, of a cell
  double most_area = 1e300;  // m2 of cracks that the energy allows
  std::uint64_t seed = 1;
  int id = 0;  // tag of the new facets
};

struct CrushedSolid {
  int cells = 0;      // broken out, of those that got material
  double area = 0.0;  // m2, of the new cracks
  bool is_out_of_energy = false;
};

/// m: of the disc on which a force (N) presses with what the material bears in compression, eight times its
/// tensile strength (Pa) [Gri24].
double crushed_disc_radius(double force, double strength);

/// Breaks the cores out of a settled complex. What cracks have parted is divided by itself, so cells go from
/// crack to crack. Beyond the energy, or without a seed, nothing is cut.
CrushedSolid crush(geometry::SolidComplex& complex, const SolidCoreSetup& setup);

}  // namespace shatterbox::fracture
