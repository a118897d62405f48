// The one surface of a cut shell, for contact, pictures, audit and export: triangles that are welded where
// material goes on, open along cracks, and stand back from crack faces by a kerf, so that pieces are born
// apart.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/mass_properties.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

struct ShellSurface {
  TriangleMesh mesh;                        // material space
  std::vector<int> triangle_cells;          // per triangle: its cell
  std::vector<int> triangle_grains;         // per triangle: its cell's grain, -1 without
  std::vector<std::uint8_t> is_crack_side;  // 3 |T|: side i of triangle t lies on a crack face, at 3 t + i
  double least_kerf = 0.0;  // m: the narrowest stand-off of a crack vertex that is not a tip; kerf if none
};

class StandingSurface;

/// The surface of a mesh. Every crack vertex stands back by `kerf` m from its crack faces, less where the
/// material is narrower than four kerfs; at a crack's tip both lips meet. Without area there are no
/// triangles. A piece of what had been cut before stays within the surface of that `whole`, which stands
/// back from the older faces already.
ShellSurface extract_surface(const ShellMesh& mesh, double kerf, const StandingSurface* whole = nullptr);

/// Mass, centre and inertia of the true cut polygons, kerf or not. `thickness` m, `density` kg/m3.
MassProperties shell_mass_properties(const ShellMesh& mesh, double thickness, double density);

}  // namespace shatterbox::geometry
