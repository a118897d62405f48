// The way of a striker through a solid: the half spaces that bound it, and what of the solid lies in it.
#pragma once

#include <vector>

#include "engine/fracture/perforation_law.h"
#include "engine/fracture/striker.h"
#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_punch.h"

namespace shatterbox::fracture {

/// The half spaces whose common part is the striker's way, wider by a clearance (2 % of the section's
/// diameter) from the depth `front` (m, along the direction) on and by the `taper` (1) beyond it.
std::vector<geometry::PunchSide> sides_of_way(const Striker& striker, double front, double taper);

/// What lies in it.
struct WayMaterial {
  double thickness = 0.0;                    // m, along the motion: the mean over the section
  std::vector<ThicknessShare> section, rim;  // of the section's area, and of its rim
  double front = 0.0;                        // m, along the direction: where the first of it is
  /// Cosine between the motion and the normals of the faces where it enters and leaves the material: the mean
  /// over both, and over what of the section meets any.
  double squareness = 0.0;
};

/// Of the material of `cells`, those that the way reaches into.
WayMaterial find_way_material(const geometry::SolidComplex& complex, const std::vector<int>& cells,
                              const Striker& striker);

}  // namespace shatterbox::fracture
