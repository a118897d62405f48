// The linear system of one connected part of a solid, K + s^2 M: what SolidSystem makes of each part. Parts
// have nothing to do with each other, so each is solved by itself, for the loads that are on it.
#pragma once

#include <memory>
#include <vector>

#include "engine/stress/block_gradients.h"
#include "engine/stress/coarse_modes.h"
#include "engine/stress/rigid_modes.h"
#include "engine/stress/solid_system.h"

namespace shatterbox::stress {

/// Everything in units of the solid (SolidStiffness); solutions and loads are in SI units.
struct PartSystem {
  std::shared_ptr<const SolidStiffness> stiffness;
  BlockRows rows;
  std::vector<float> single;  // its entries
  VecX mass;                  // |dof|
  RigidModes rigid;
  CoarseModes coarse;
  BlockSystem system;  // without inertia
  NullSpace null_space = NullSpace::balanced;

  /// `mesh` and `options` are the part's own: all cells hang together.
  PartSystem(std::shared_ptr<const SolidStiffness> of, const geometry::SolidMesh& mesh,
             const SolidSystemOptions& options);
  PartSystem(const PartSystem&) = delete;
  PartSystem& operator=(const PartSystem&) = delete;

  /// As SolidSystem's.
  std::vector<SolidSolution> solve(const std::vector<VecX>& loads, const SolidSolveSettings& settings,
                                   const std::vector<VecX>& guesses) const;
  VecX balance(const VecX& load) const;
  double first_period() const;

  /// Whether the support leaves anything to move.
  bool can_move() const;
  /// displacement . M displacement without its rigid motion.
  double vibrating_moment(const VecX& displacement) const;
  double seconds() const;  // the unit of time, s
  bool is_relieved() const { return null_space == NullSpace::balanced && rigid.mode_count() > 0; }

 private:
  void add_anchors(const std::vector<Vec3>& positions, const SolidSystemOptions& options,
                   const std::vector<char>& is_clamped, const std::vector<int>& part_of_dof);
  VecX scaled(const VecX& load) const;
  SolidSolution solution_of(const GradientResult& result, const VecX& load, const VecX& rigid_part,
                            const VecX& inertia) const;
};

}  // namespace shatterbox::stress
