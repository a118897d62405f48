#include "engine/dynamics/joint_solver.h"

#include <algorithm>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "engine/core/index.h"

namespace shatterbox::dynamics {
namespace {

using core::at;
using Six = Eigen::Matrix<double, 6, 1>;
using Six6 = Eigen::Matrix<double, 6, 6>;

// Times the mass: how stiff a joint is at least, of what a substep changes. And how many times stiffer one
// may be than that, where others hold more mass on less area.
constexpr double kStiff = 1e7;
constexpr double kStiffest = 1e3;
constexpr double kUnmoved = 1e12;     // times as heavy is what cannot move
constexpr double kMended = 0.3;       // of what joints are off, in a substep,
constexpr double kMostMended = 2e-3;  // of the lesser reach, and rad: no more of it

// After so many substeps.
Pose pose_of(const WorkBody& body, int substeps) {
  if (body.inverse_mass > 0.0) return {body.rotation, body.start.translation + body.way};
  if (body.rides.empty() || substeps == 0) return body.start;
  const WorkBody::Ride& ride = body.rides[at(substeps - 1)];
  return {(ride.turn * body.start.rotation).normalized(), body.start.translation + ride.way};
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// How the joint's point moves and turns with the body at this arm.
Six6 motion_at(const Vec3& arm) {
  Six6 m = Six6::Identity();
  m.topRightCorner<3, 3>() = -cross_matrix(arm);
  return m;
}

}  // namespace

struct JointSolver::Factor {
  Eigen::SparseMatrix<double> matrix;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::AMDOrdering<int>> solver;
  bool is_analysed = false;
};

JointSolver::JointSolver(const Island& island, double step, MotionWork& work)
    : island_(island), step_(step), work_(work) {}
JointSolver::~JointSolver() = default;

WorkBody& JointSolver::body(int i) {
  return work_.bodies[at(i)];
}
int JointSolver::dof(int i) const {
  return first_dof_[at(i)];
}

void JointSolver::begin() {
  if (is_empty()) return;
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    joint.total = joint.total_couple = joint.total_world = joint.total_couple_world = Vec3::Zero();
    joint.given = joint.given_couple = Vec3::Zero();
  }
  if (factor_) return;
  factor_ = std::make_unique<Factor>();
  first_dof_.assign(work_.bodies.size(), -1);
  for (const int k : island_.joints) {
    for (const int i : {work_.joints[at(k)].a, work_.joints[at(k)].b}) {
      if (body(i).inverse_mass == 0.0 || dof(i) >= 0) continue;
      first_dof_[at(i)] = dof_count_;
      dof_count_ += 6;
    }
  }
  make_stiffnesses();
}

// One stiffness for each square metre, whatever the joint: that of the one that needs it most.
void JointSolver::make_stiffnesses() {
  double most = 0.0;
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    joint.stiffness =
        kStiff / ((body(joint.a).inverse_mass + body(joint.b).inverse_mass) * joint.joint->area);
    most = std::max(most, joint.stiffness);
  }
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    joint.stiffness = std::min(most, kStiffest * joint.stiffness);
  }
}

void JointSolver::place(int substeps) {
  if (is_empty()) return;
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    const Pose a = pose_of(body(joint.a), substeps), b = pose_of(body(joint.b), substeps);
    const Vec3 on_a = a.apply(joint.joint->frame_a.translation);
    const Vec3 on_b = b.apply(joint.joint->frame_b.translation);
    joint.point = 0.5 * (on_a + on_b);
    joint.arm_a = joint.point - a.translation;
    joint.arm_b = joint.point - b.translation;
    joint.axes = (a.rotation * joint.joint->frame_a.rotation).toRotationMatrix();
    const double s = joint.stiffness;
    joint.linear_stiffness = s * joint.joint->area;
    joint.turn_stiffness =
        joint.joint->is_pivot
            ? Mat3::Zero()
            : Mat3(s * joint.axes * joint.joint->moments.asDiagonal() * joint.axes.transpose());
  }
  assemble();
  find_mending(substeps);
}

void JointSolver::assemble() {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column, const Six6& block) {
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i)
        if (row + i >= column + j) entries.emplace_back(row + i, column + j, block(i, j));
  };
  for (const int i : island_.bodies) {
    const WorkBody& b = body(i);
    if (dof(i) < 0) continue;
    Six6 mass = Six6::Identity() / b.inverse_mass;
    for (int axis = 0; axis < 3; ++axis)
      if (b.locked.moves[at(axis)]) mass(axis, axis) *= kUnmoved;
    const Mat3 axes = (b.rotation * b.inertia.body_from_axes).toRotationMatrix();
    // Who cannot turn is as heavy to turn as would be a body of many times its size.
    const double unmoved = kUnmoved * b.reach * b.reach / b.inverse_mass;
    const Vec3 moments =
        b.inverse_moments.maxCoeff() > 0.0 ? b.inertia.moments : Vec3(Vec3::Constant(unmoved));
    mass.bottomRightCorner<3, 3>() = axes * moments.asDiagonal() * axes.transpose();
    for (int axis = 0; axis < 3; ++axis)
      if (b.locked.turns[at(axis)]) mass(3 + axis, 3 + axis) += unmoved;
    add(dof(i), dof(i), mass);
  }
  for (const int k : island_.joints) {
    const WorkJoint& joint = work_.joints[at(k)];
    Six6 stiffness = Six6::Identity() * joint.linear_stiffness;
    stiffness.bottomRightCorner<3, 3>() = joint.turn_stiffness;
    const int a = dof(joint.a), b = dof(joint.b);
    const Six6 by_a = motion_at(joint.arm_a), by_b = -motion_at(joint.arm_b);
    if (a >= 0) add(a, a, by_a.transpose() * stiffness * by_a);
    if (b >= 0) add(b, b, by_b.transpose() * stiffness * by_b);
    if (a >= 0 && b >= 0) {
      if (a > b)
        add(a, b, by_a.transpose() * stiffness * by_b);
      else
        add(b, a, by_b.transpose() * stiffness * by_a);
    }
  }
  factor_->matrix.resize(dof_count_, dof_count_);
  factor_->matrix.setFromTriplets(entries.begin(), entries.end());
  if (!factor_->is_analysed) factor_->solver.analyzePattern(factor_->matrix);
  factor_->is_analysed = true;
  factor_->solver.factorize(factor_->matrix);
}

// The pushes on both bodies of a joint that is to go so fast, or so far, against its springs.
void JointSolver::add_pushes(const WorkJoint& joint, const Vec3& linear, const Vec3& turn,
                             VecX& pushes) const {
  Six force;
  force << joint.linear_stiffness * linear, joint.turn_stiffness * turn;
  if (dof(joint.a) >= 0) pushes.segment<6>(dof(joint.a)) += motion_at(joint.arm_a).transpose() * force;
  if (dof(joint.b) >= 0) pushes.segment<6>(dof(joint.b)) -= motion_at(joint.arm_b).transpose() * force;
}

// How fast each joint must close. By one move of all bodies, so that no joint is bidden what another forbids:
// being so stiff they would strain each other without end.
void JointSolver::find_mending(int substeps) {
  VecX pushes = VecX::Zero(dof_count_);
  double share = kMended;
  for (const int k : island_.joints) {
    const WorkJoint& joint = work_.joints[at(k)];
    const Pose a = pose_of(body(joint.a), substeps), b = pose_of(body(joint.b), substeps);
    const Vec3 off = b.apply(joint.joint->frame_b.translation) - a.apply(joint.joint->frame_a.translation);
    const Quat turn = (b.rotation * joint.joint->frame_b.rotation) *
                      (a.rotation * joint.joint->frame_a.rotation).conjugate();
    const Vec3 off_turn = (turn.w() < 0.0 ? -2.0 : 2.0) * turn.vec();
    add_pushes(joint, off, off_turn, pushes);
    const double reach = std::min(body(joint.a).reach, body(joint.b).reach);
    const double far = std::max(off.norm() / reach, joint.joint->is_pivot ? 0.0 : off_turn.norm());
    if (share * far > kMostMended) share = kMostMended / far;
  }
  const VecX speeds = share / step_ * factor_->solver.solve(pushes);
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    Six mending = Six::Zero();
    if (dof(joint.a) >= 0) mending += motion_at(joint.arm_a) * speeds.segment<6>(dof(joint.a));
    if (dof(joint.b) >= 0) mending -= motion_at(joint.arm_b) * speeds.segment<6>(dof(joint.b));
    joint.mending = mending.head<3>();
    joint.mending_turn = mending.tail<3>();
  }
}

void JointSolver::hold(bool mends) {
  if (is_empty()) return;
  VecX pushes = VecX::Zero(dof_count_);
  std::vector<Six> wanted(island_.joints.size());
  for (std::size_t n = 0; n < island_.joints.size(); ++n) {
    const WorkJoint& joint = work_.joints[at(island_.joints[n])];
    const WorkBody &a = body(joint.a), &b = body(joint.b);
    wanted[n] << b.velocity + b.spin.cross(joint.arm_b) - a.velocity - a.spin.cross(joint.arm_a),
        b.spin - a.spin;
    if (mends) wanted[n].head<3>() += joint.mending;
    if (mends) wanted[n].tail<3>() += joint.mending_turn;
    add_pushes(joint, wanted[n].head<3>(), wanted[n].tail<3>(), pushes);
  }
  const VecX change = factor_->solver.solve(pushes);
  // Impulses, not these changes, are given to the bodies: both get the same to the last bit.
  for (std::size_t n = 0; n < island_.joints.size(); ++n) {
    WorkJoint& joint = work_.joints[at(island_.joints[n])];
    Six left = wanted[n];
    if (dof(joint.a) >= 0) left -= motion_at(joint.arm_a) * change.segment<6>(dof(joint.a));
    if (dof(joint.b) >= 0) left += motion_at(joint.arm_b) * change.segment<6>(dof(joint.b));
    const Vec3 impulse = joint.linear_stiffness * left.head<3>();
    const Vec3 couple = joint.turn_stiffness * left.tail<3>();
    const auto push = [&](WorkBody& b, const Vec3& arm, double sign) {
      if (b.inverse_mass == 0.0) return;
      const Vec3 velocity = b.locked.let_move(sign * b.inverse_mass * impulse);
      const Vec3 spin = sign * (b.inverse_inertia * (arm.cross(impulse) + couple));
      b.velocity += velocity;
      b.spin += spin;
      b.stirred += velocity.lpNorm<1>() + b.reach * spin.lpNorm<1>();
    };
    push(body(joint.a), joint.arm_a, 1.0);
    push(body(joint.b), joint.arm_b, -1.0);
    joint.given += impulse;
    joint.given_couple += couple;
  }
}

void JointSolver::book() {
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    joint.total_world += joint.given;
    joint.total_couple_world += joint.given_couple;
    joint.total += joint.axes.transpose() * joint.given;
    joint.total_couple += joint.axes.transpose() * joint.given_couple;
    joint.given = joint.given_couple = Vec3::Zero();
  }
}

}  // namespace shatterbox::dynamics
