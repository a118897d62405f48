// Joints of one island, all at once. They are springs so stiff that nothing is seen to give: their impulses
// are those with which the velocities at a substep's end stretch them least, by one sparse factor of mass
// plus stiffness. As each is as stiff as its area and its moments say, forces divide where more joints hold
// than are needed as they do over equal mortar; and what one solve leaves, the next takes.
#pragma once

#include <memory>

#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

class JointSolver {
 public:
  /// `step` (s) is that of a substep.
  JointSolver(const Island& island, double step, MotionWork& work);
  ~JointSolver();

  bool is_empty() const { return island_.joints.empty(); }
  void begin();
  /// Where the bodies are after so many substeps.
  void place(int substeps);
  /// Changes velocities so that no joint opens or turns; or so that what they are off, as bodies went
  /// straight through a substep, is mended by the end of the next.
  void hold(bool mends);
  /// Adds what this substep gave to that of the step.
  void book();

 private:
  struct Factor;

  WorkBody& body(int i);
  int dof(int i) const;
  void add_pushes(const WorkJoint& joint, const Vec3& linear, const Vec3& turn, VecX& pushes) const;
  void make_stiffnesses();
  void assemble();
  void find_mending(int substeps);

  const Island& island_;
  const double step_;
  MotionWork& work_;
  std::vector<int> first_dof_;  // per body of the world; -1: nothing moves it
  int dof_count_ = 0;
  std::unique_ptr<Factor> factor_;
};

}  // namespace shatterbox::dynamics
