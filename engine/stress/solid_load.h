// Loads of a solid as vectors of all degrees of freedom: a force spread over a disc of its surface about a
// point (a point load has no limit under refinement), and the centrifugal load of a spin. Material space, SI
// units. Gravity needs none on what is free: it accelerates all alike, and the balance takes it out.
#pragma once

#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/solid_mesh.h"
#include "engine/stress/solid_stiffness.h"

namespace shatterbox::stress {

/// The surface that can be pressed on: triangles, outwards, that share vertices where they touch, and the
/// cell whose material lies behind each.
struct SolidSkin {
  geometry::TriangleMesh mesh;
  std::vector<int> cells;             // |T|
  std::vector<geometry::Box> blocks;  // about so many triangles each, in their order
  static constexpr std::size_t kBlock = 32;

  /// A triangle of vertices that are there.
  void add(const geometry::Triangle& triangle, int cell);
};

/// The border of an uncut mesh that ends where its elements end.
SolidSkin make_border_skin(const geometry::SolidMesh& mesh);

/// What one cell takes of a patch.
struct SolidPatchShare {
  int cell = 0;
  double weight = 0.0;  // of the whole load; the weights of a patch sum to 1
  Eigen::Vector4d corner_weights = Eigen::Vector4d::Zero();  // for its four virtual vertices; sum is 1
};

/// A load of weight 1 - (r / radius)^2 about `centre`, r the straight distance, over the skin near it.
struct SolidPatch {
  Vec3 centre = Vec3::Zero();  // m, the point of the skin nearest to the one asked for
  Vec3 normal = Vec3::Zero();  // of the skin there, outwards, unit
  double radius = 0.0;         // m
  int nearest_cell = -1;
  std::vector<SolidPatchShare> shares;  // ascending by cell
};

/// The skin within `radius` of its point nearest to `point`, reached from there over shared vertices (open
/// cracks included, so that all loose sectors under an indenter are found) without turning away from what
/// presses: the far side of a thin wall is not in it. Never empty if the skin has a triangle: a disc smaller
/// than the quadrature's spacing puts all on the nearest point.
SolidPatch find_load_patch(const geometry::SolidMesh& mesh, const SolidSkin& skin, const Vec3& point,
                           double radius);

/// Group of each share (|shares|, numbered from 0 by their first cell): cells that share a virtual vertex
/// hang together.
std::vector<int> group_patch(const geometry::SolidMesh& mesh, const SolidPatch& patch);

/// The whole patch under `force` (N) as a load vector (|dof|).
VecX patch_load(const geometry::SolidMesh& mesh, const SolidPatch& patch, const Vec3& force);

/// Those shares alone whose group is `group`, their weights scaled to sum to 1, under `force` (N).
VecX group_load(const geometry::SolidMesh& mesh, const SolidPatch& patch, const std::vector<int>& groups,
                int group, const Vec3& force);
/// Sum of the weights of one group, in (0, 1].
double group_weight(const SolidPatch& patch, const std::vector<int>& groups, int group);

/// -rho w x (w x r) over the material (outwards), r from `centre_of_mass`; rad/s and m in material space; by
/// the lumped masses, so that its resultant is that of the material. |dof|, N.
VecX centrifugal_load(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh, const Vec3& spin,
                      const Vec3& centre_of_mass);

/// Mean length of the edges of the elements that the mesh has cells in, m: h of the rule radius >= 1.5 h.
double mean_edge_length(const geometry::SolidMesh& mesh);

}  // namespace shatterbox::stress
