// What all linear systems of one cut and supported mesh share, whatever their screening: the places of its
// cells' unknowns, mass, rigid motions and the tree of fronts. Made once a mesh; the numbers of K + s^2 M are
// all that is left for each system.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/stress/front_tree.h"
#include "engine/stress/rigid_modes.h"
#include "engine/stress/shell_stiffness.h"
#include "engine/stress/shell_support.h"

namespace shatterbox::stress {

inline constexpr std::size_t kMostLanes = 4;  // vectors that are multiplied or solved together

/// Places of one cell's unknowns and the share of its element's stiffness.
struct SystemCell {
  int element = 0;
  double fraction = 1.0;
  std::array<int, kElementDofs> dofs{};
};

/// Everything in units of the shell (ShellStiffness), vectors in the order of the mesh's degrees of freedom.
/// Immutable once made.
struct ShellStructure {
  std::shared_ptr<const ShellStiffness> stiffness;
  std::vector<SystemCell> cells;
  VecX mass;               // |dof|
  std::vector<int> place;  // |dof|: in the order of elimination, -1 if clamped or in no cell
  RigidModes rigid;
  FrontTree tree;
  int vertex_dofs = 0;

  static std::shared_ptr<const ShellStructure> make(std::shared_ptr<const ShellStiffness> stiffness,
                                                    const geometry::ShellMesh& mesh,
                                                    const ShellSupport& support = {});

  double seconds() const;  // unit of time: length / speed of sound
  /// K times each vector (|dof|). Lanes never mix and sum in one order, so company changes no bits.
  std::vector<VecX> multiply_stiffness(const std::vector<const VecX*>& all) const;
  void restrict_to_active(VecX& x) const;
  /// Of memory, but for the stiffness, which is that of the whole body.
  double bytes() const;

 private:
  void build_cells(const geometry::ShellMesh& mesh);
  void build_mass(const geometry::ShellMesh& mesh);
  void build_rigid_modes(const geometry::ShellMesh& mesh, const ShellSupport& support);
  void build_tree(const geometry::ShellMesh& mesh, const ShellSupport& support);
};

}  // namespace shatterbox::stress
