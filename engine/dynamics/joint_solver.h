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
  /// How fast each joint must close, that it is not off at the end of the substep that begins with these
  /// spins.
  void aim();
  /// Changes velocities so that no joint opens or turns; or so that they close as they must.
  void hold(bool closes);
  /// Before the drift: speeds that mend a share of what joints are off, and are taken back when bodies are
  /// placed behind it: where contacts are in the way, what is left of them would be energy.
  void lend();
  void take_back();
  /// At the start of a substep.
  void note_energy();
  /// Takes what energy joints gave in this substep.
  void settle();
  /// Before bodies are placed at the end of a substep: something arrived in it where they are yet.
  void keep_arrival();
  /// Notes an impulse (N s, in the contact's axes) of what arrived in this substep.
  void feel_blow(const SolverContact& c, const Vec3& impulse);
  /// Adds what this substep gave to that of the step.
  void book();

 private:
  struct Factor;

  WorkBody& body(int i);
  int dof(int i) const;
  void give(const std::vector<Eigen::Matrix<double, 6, 1>>& wanted, Vec3 WorkJoint::*impulses,
            Vec3 WorkJoint::*couples);
  Eigen::Matrix<double, 6, 1> relative(const WorkJoint& joint) const;
  double energy() const;
  void push(const WorkJoint& joint, const Vec3& impulse, const Vec3& couple);
  template <class Between>
  void add_force(const Between& between, const Eigen::Matrix<double, 6, 1>& force, VecX& pushes) const;
  void add_pushes(const WorkJoint& joint, const Vec3& linear, const Vec3& turn, VecX& pushes) const;
  void book_blow();
  void find_what_is_known();
  void make_stiffnesses();
  void assemble();
  void find_pressed();
  bool is_pressed(const WorkJoint& joint) const;
  double mended_share(const WorkJoint& joint, double most) const;
  VecX find_motion(const std::vector<Eigen::Matrix<double, 6, 1>>& offs, double most) const;
  Eigen::Matrix<double, 6, 1> closes_by(const WorkJoint& joint, const VecX& motion) const;
  double energy_of(const VecX& speeds) const;
  double energy_of_joined() const;
  void find_closing();
  Vec3 off_by_turning(const WorkJoint& joint) const;

  const Island& island_;
  const double step_;
  MotionWork& work_;
  std::vector<int> first_dof_;  // per body of the world; -1: nothing moves it
  int dof_count_ = 0;
  bool has_pivots_ = false;
  double given_ = 0.0;             // J, in this substep
  double energy_ = 0.0;            // J, at its start
  bool knows_energy_ = false;      // nothing from without does work
  std::vector<char> is_pressed_;   // per body of the world
  VecX blow_;                      // what struck in this substep; empty: nothing did
  std::vector<WorkJoint> struck_;  // the island's, where that arrived; empty: where they are
  std::unique_ptr<Factor> factor_, struck_factor_;
};

}  // namespace shatterbox::dynamics
