// The linear system of a shell, K + s^2 M, with its Cholesky factor kept: made once, then any number of loads
// from any number of threads. Balanced (s = 0, free bodies: inertia relief), supported (s = 0, clamped) or
// screened (s > 0: the displacement averaged over a window of 1 / s, exact for the waves that can run in it).
#pragma once

#include <memory>
#include <vector>

#include "engine/core/result.h"
#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_structure.h"

namespace shatterbox::stress {

/// Answer to one load, SI units. If the load is an impulse (N s) read every unit times a second.
struct ShellSolution {
  VecX displacement;        // |dof|, m at vertices, rad at edges; free balanced parts: without rigid motion
  double compliance = 0.0;  // load . displacement, J (for a unit force: m/N)
  double elastic_compliance = 0.0;  // displacement . K displacement, J: twice the elastic energy
  double residual = 0.0;            // |b - A u| / |b| in the shell's units; the check that the answer is one
  /// False if the load moves a mechanism (an open membrane-only shell, a hinge): the stress is then
  /// meaningless.
  bool is_evaluated() const { return residual < 1e-4; }
};

/// Compliances of one load, J (for a unit force: m/N).
struct LoadCompliance {
  double total = 0.0;    // load . displacement
  double elastic = 0.0;  // displacement . K displacement
};

class ShellSystem {
 public:
  /// Factors. `screening` is s in 1/s; 0 for the balanced or supported system. Fails, with a sentence, if no
  /// factor exists (not seen for elements with area).
  static core::Result<std::shared_ptr<const ShellSystem>> make(
      std::shared_ptr<const ShellStructure> structure, double screening = 0.0);
  /// The same, for a structure that no other system shares.
  static core::Result<std::shared_ptr<const ShellSystem>> make(
      std::shared_ptr<const ShellStiffness> stiffness, const geometry::ShellMesh& mesh,
      double screening = 0.0, const ShellSupport& support = {});
  ~ShellSystem();
  ShellSystem(const ShellSystem&) = delete;
  ShellSystem& operator=(const ShellSystem&) = delete;

  /// Solves for each load (|dof|: N at vertices, N m at edges). With s = 0 every connected part of the mesh
  /// is first relieved of the rigid motion that its load causes and that its support allows, weighted by
  /// mass: b = J - M R R^T J. With s > 0 the raw load is used. `tolerance`: of the residual that is good
  /// enough. Same bits whatever the number of loads or threads.
  std::vector<ShellSolution> solve(const std::vector<VecX>& loads, double tolerance = kFineResidual) const;
  ShellSolution solve(const VecX& load, double tolerance = kFineResidual) const;
  static constexpr double kFineResidual = 1e-10;

  /// Load i . displacement j in J (for unit forces: m/N), |loads| x |loads|, at half the cost of a solve: the
  /// displacements are not made. Entries of loads of different `groups` are left zero. Relieved with s = 0,
  /// as in solve(). Not refined: right to about 1e-6, less where a motion is as soft as the shift that s = 0
  /// needs (a mechanism; there solve() tells).
  Eigen::MatrixXd compliance_matrix(const std::vector<VecX>& loads, const std::vector<int>& groups) const;
  /// Of each load by itself; the same accuracy.
  std::vector<LoadCompliance> compliances(const std::vector<VecX>& loads) const;

  /// Longest period of free (or supported) vibration, s, to about 1 %; computed at the first call, then kept.
  /// Only of use with s = 0.
  double first_period() const;
  /// Period (s) of the vibration that a solution's displacement would be: by Rayleigh's quotient the first
  /// period of the shell, free or supported, is at least that long. Rigid motion does not count.
  double trial_period(const ShellSolution& solution) const;
  /// first_period() > limit (s), mostly at half the price.
  bool is_first_period_above(double limit) const;

  double screening() const;  // s, 1/s
  int dof_count() const;
  int part_count() const;        // connected parts of the mesh
  int rigid_mode_count() const;  // over all parts: 6 for each free one, fewer where supported
  const ShellStiffness& stiffness() const;

  /// Entries of the factor.
  double factor_entries() const;
  /// Of memory, but for what the structure holds.
  double bytes() const;

 private:
  struct State;
  explicit ShellSystem(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace shatterbox::stress
