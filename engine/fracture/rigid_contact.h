// One load on a cracked body: the pieces under an indenter sink together, each taking the share of the force
// that its stiffness gives it. A fixed load pattern would let one loose piece take all.
#pragma once

#include <vector>

#include "engine/geometry/shell_mesh.h"
#include "engine/stress/shell_load.h"
#include "engine/stress/shell_system.h"

namespace shatterbox::fracture {

/// Residual of a solve that is good enough for a verdict; the compliance is then right to its square over the
/// share of the load in the softest motion.
inline constexpr double kVerdictResidual = 1e-6;

struct ContactPress {
  Vec3 point = Vec3::Zero();      // m
  Vec3 direction = Vec3::Zero();  // unit
  double radius = 0.0;            // m, of the patch
  double hertz_compliance = 0.0;  // m/N
};

/// What a unit force meets.
struct ContactAnswer {
  VecX load;                        // |dof|, N: the force as the pieces share it
  double compliance = 0.0;          // m/N, force . displacement
  double elastic_compliance = 0.0;  // m/N, displacement . K displacement
};

/// A load's pieces on one mesh, each under its own unit force; any number of systems of that mesh can be
/// asked.
struct PressGroups {
  double hertz_compliance = 0.0;  // m/N
  std::vector<double> weights;    // of each piece, share of the patch
  std::vector<VecX> forces;       // |dof| each
};

/// Which groups of a patch carry its load, ascending, by their weights: the heaviest, at most `most`.
std::vector<int> heaviest_groups(const std::vector<double>& weights, std::size_t most);

/// Share of the total force of each piece (|pieces|; they sum to 1) under which all sink equally and none is
/// pulled. `flexibility`: load i . displacement j, m/N.
Eigen::VectorXd share_force(const PressGroups& load, const Eigen::MatrixXd& flexibility);

PressGroups find_press_groups(const geometry::ShellMesh& mesh,
                              const std::vector<geometry::CellContact>& contacts, const ContactPress& load);

/// Each load by itself under a unit force, on one factor; no displacement is made. The elastic compliance of
/// a screened system costs twice as much and is left zero unless `wants_elastic`.
std::vector<ContactAnswer> press(const stress::ShellSystem& system, const std::vector<PressGroups>& loads,
                                 bool wants_elastic);

/// The unit force of one load as its pieces share it, |dof|, N.
VecX share_load(const stress::ShellSystem& system, const PressGroups& load);

}  // namespace shatterbox::fracture
