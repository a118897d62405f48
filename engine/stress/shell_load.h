// Loads of a shell as vectors of all degrees of freedom: a force spread over a disc about a point (a point
// load has no limit under refinement), and the centrifugal load of a spin. Material space, SI units.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_stiffness.h"

namespace shatterbox::stress {

/// What one cell takes of a patch.
struct PatchShare {
  int cell = 0;
  double weight = 0.0;                 // of the whole load; the weights of a patch sum to 1
  Vec3 corner_weights = Vec3::Zero();  // of this cell's part, for its three virtual vertices; sum is 1
};

/// A load of weight 1 - (r/radius)^2 about `centre`, r the straight distance, over the cells near it.
struct LoadPatch {
  Vec3 centre = Vec3::Zero();  // m, the point of the material nearest to the one asked for
  double radius = 0.0;         // m
  int nearest_cell = -1;
  std::vector<PatchShare> shares;  // ascending by cell
};

/// The cells within `radius` of the material point nearest to `point`, reached from there over edges of the
/// elements (open cracks included, so that all loose sectors under an indenter are found; an opposite wall is
/// not). Never empty if the mesh has a cell: a disc smaller than the quadrature's spacing puts all on the
/// nearest point.
LoadPatch find_load_patch(const geometry::ShellMesh& mesh, const Vec3& point, double radius);

/// Group of each share (|shares|, numbered from 0 by their first cell): cells that hang together inside the
/// patch. `contacts` from geometry::find_cell_contacts.
std::vector<int> group_patch(const LoadPatch& patch, const std::vector<geometry::CellContact>& contacts);

/// The whole patch under `force` (N) as a load vector (|dof|).
VecX patch_load(const geometry::ShellMesh& mesh, const LoadPatch& patch, const Vec3& force);

/// Those shares alone whose group is `group`, their weights scaled to sum to 1, under `force` (N).
VecX group_load(const geometry::ShellMesh& mesh, const LoadPatch& patch, const std::vector<int>& groups,
                int group, const Vec3& force);
/// Sum of the weights of one group, in (0, 1].
double group_weight(const LoadPatch& patch, const std::vector<int>& groups, int group);

/// -rho t w x (w x r) over the material (outwards), r from `centre_of_mass`; rad/s and m in material space.
/// |dof|, N.
VecX centrifugal_load(const ShellStiffness& stiffness, const geometry::ShellMesh& mesh, const Vec3& spin,
                      const Vec3& centre_of_mass);

/// Mean length of the edges of the elements that the mesh has cells in, m: h of the rule radius >= 1.5 h.
double mean_edge_length(const geometry::ShellMesh& mesh);

}  // namespace shatterbox::stress
