// The inside of a ShellSystem: its factor, and the solves with it that shell_system.cpp (displacements) and
// shell_compliance.cpp (compliances alone) are made of. For these two files.
#pragma once

#include <mutex>
#include <optional>
#include <span>

#include "engine/stress/first_frequency.h"
#include "engine/stress/front_factor.h"
#include "engine/stress/front_solve.h"
#include "engine/stress/shell_system.h"

namespace shatterbox::stress {

static_assert(kMostLanes == SolveLanes::kMost);

/// Everything in units of the shell (ShellStiffness), vectors in the order of the mesh's degrees of freedom.
struct ShellSystem::State {
  /// One load's conjugate gradients.
  struct Refinement {
    VecX x, image;  // image: K x
    VecX residual, direction;
    double rho = 0.0, load_norm = 0.0;
    bool is_done = false;
  };

  std::shared_ptr<const ShellStructure> structure;
  double screening = 0.0;          // 1/s
  double screening_squared = 0.0;  // in units of the shell
  std::optional<FrontFactor> factor;
  VecX shift;  // factored in place of screening_squared: never too small to be seen beside the stiffness
  std::vector<double> diagonal;  // shift times mass, in the order of elimination
  // By part: the load's rigid part is answered in closed form, R R^T / s^2, because the factor would answer
  // it with few digits (s far below the first frequency) or not at all (s = 0).
  std::vector<char> is_split;
  mutable std::once_flag has_period, has_rough_frequency;
  mutable double period = 0.0;
  mutable FrequencyEstimate rough_frequency;

  bool build_factor();
  bool is_balanced() const { return screening_squared == 0.0; }
  /// Half a solve of four loads: load i . answer j = y_i . y_j + what the rigid motions split off add.
  struct Half {
    SolveLanes y;
    std::vector<RigidModes::Amounts> rigid;
  };
  Half solve_half(const std::vector<VecX>& loads, std::size_t first) const;
  /// What the rigid motions split off add to load i . answer j.
  double rigid_compliance(const RigidModes::Amounts& a, const RigidModes::Amounts& b) const;
  VecX scaled(const VecX& load) const;
  void put_lane(const VecX& load, std::size_t lane, SolveLanes& lanes) const;
  std::vector<VecX> precondition(const std::vector<const VecX*>& loads) const;
  void refine(std::span<Refinement> all, double tolerance) const;
  FrequencyEstimate estimate_frequency(int steps) const;
  double period_of(double frequency_squared) const;
};

}  // namespace shatterbox::stress
