// The rigid motions of the connected parts of a shell or a solid that its support allows, orthonormal in
// mass: what inertia relief takes out of a load and what a displacement is free by.
#pragma once

#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::stress {

class RigidModes {
 public:
  RigidModes() = default;

  /// Unknowns are three displacements of each vertex, then one rotation of each edge (none in a solid).
  /// `part_of_dof`: |dof|, the connected part, from 0; -1 for what is in no cell. `positions`: |virtual
  /// vertices| x 3, `edge_directions`: |virtual edges|, unit (or empty: rotations do not count), `mass`:
  /// |dof|, `is_clamped`: |dof|. All lengths in one unit.
  RigidModes(std::vector<int> part_of_dof, const std::vector<Vec3>& positions,
             const std::vector<Vec3>& edge_directions, const VecX& mass, const std::vector<char>& is_clamped);

  /// x -= R R^T M x: no rigid motion in x.
  void remove_motion(VecX& x) const;
  /// b -= M R R^T b: no resultant in the load.
  void balance(VecX& b) const;

  /// R^T b, part by part.
  using Amounts = std::vector<Eigen::Matrix<double, 6, 1>>;
  Amounts resultants(const VecX& b) const;
  /// b -= M R amounts.
  void subtract(VecX& b, const Amounts& amounts) const;

  double bytes() const;  // of memory

  int part_count() const { return static_cast<int>(part_mass_.size()); }
  int mode_count() const { return mode_count_; }
  const std::vector<int>& part_of_dof() const { return part_; }
  /// Mass and diagonal of the bounding box of each part.
  const std::vector<double>& part_mass() const { return part_mass_; }
  const std::vector<double>& part_size() const { return part_size_; }

 private:
  using Modes = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;
  void orthonormalise(const std::vector<int>& dofs, const std::vector<char>& is_clamped);
  Eigen::Matrix<double, 6, 6> mass_product(const std::vector<int>& dofs) const;
  void combine(const std::vector<int>& dofs, const Eigen::Matrix<double, 6, 6>& combinations);

  VecX mass_;
  std::vector<int> part_;  // |dof|, -1 for unknowns without a cell
  std::vector<double> part_mass_, part_size_;
  Modes modes_;  // |dof| x 6: of the unknown's own part; zero columns where the support holds
  int mode_count_ = 0;
};

}  // namespace shatterbox::stress
