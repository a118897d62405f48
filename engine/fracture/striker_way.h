// The way of a striker through a body: the half spaces that bound it, and what of the body lies in it.
#pragma once

#include <vector>

#include "engine/fracture/perforation_law.h"
#include "engine/fracture/striker.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/geometry/solid_complex.h"
#include "engine/geometry/solid_punch.h"

namespace shatterbox::fracture {

/// The half spaces whose common part is the striker's way, wider by a `clearance` (m) from the depth `front`
/// (m, along the direction) on and by the `taper` (1) beyond it.
std::vector<geometry::PunchSide> sides_of_way(const Striker& striker, double clearance, double taper = 0.0,
                                              double front = 0.0);

/// What lies in it.
struct WayMaterial {
  double thickness = 0.0;                    // m, along the motion: the mean over the section
  std::vector<ThicknessShare> section, rim;  // of the section's area, and of its rim
  double front = 0.0;                        // m, along the direction: where the first of it is
  /// Cosine between the motion and the normals of the faces where it enters and leaves the material: the mean
  /// over both, and over what of the section meets any.
  double squareness = 0.0;
};

/// Of the material of `cells`, those that the way, with the `clearance` about it, reaches into.
WayMaterial find_way_material(const geometry::SolidComplex& complex, const std::vector<int>& cells,
                              const Striker& striker, double clearance);
/// The same of a sheet `thickness` m thick.
WayMaterial find_way_material(const geometry::ShellMesh& mesh, double thickness,
                              const std::vector<int>& cells, const Striker& striker, double clearance);

}  // namespace shatterbox::fracture
