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
constexpr double kMostMended = 2e-3;  // of the lesser reach, and rad: no more of it,
constexpr double kMostLent = 5e-4;    // and no body goes further for it than this share of its own
constexpr double kMostClosing = 1.0;  // 1/s, instead of kMostMended, where contacts are in the way
constexpr double kMostClosed = 0.02;  // of a body's reach, and rad: how far it goes to close what arms turn,
constexpr double kMostGiven = 0.01;   // with no more than this share of the energy

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

// J.
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
    joint.blow = joint.blow_couple = Vec3::Zero();
    joint.is_struck = false;
    joint.most = 0.0;
    has_pivots_ = has_pivots_ || joint.joint->is_pivot;
  }
  if (has_pivots_) find_what_is_known();
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

// Nothing from without does work on it, then it must not have more energy than before.
void JointSolver::find_what_is_known() {
  is_pressed_.assign(work_.bodies.size(), 0);
  const auto is_scripted = [&](const auto& pair) {
    return body(pair.a).is_scripted || body(pair.b).is_scripted;
  };
  knows_energy_ = std::none_of(island_.bodies.begin(), island_.bodies.end(),
                               [&](int i) { return !body(i).torque.isZero(0.0); }) &&
                  std::none_of(island_.contacts.begin(), island_.contacts.end(),
                               [&](int k) { return is_scripted(work_.contacts[at(k)]); }) &&
                  std::none_of(island_.joints.begin(), island_.joints.end(),
                               [&](int k) { return is_scripted(work_.joints[at(k)]); });
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
    const Quat turn = (b.rotation * joint.joint->frame_b.rotation) *
                      (a.rotation * joint.joint->frame_a.rotation).conjugate();
    joint.off = on_b - on_a;
    joint.off_turn = (turn.w() < 0.0 ? -2.0 : 2.0) * turn.vec();
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
  add_force(joint, force, pushes);
}

// A joint's, or a contact's: on a, and against b.
template <class Between>
void JointSolver::add_force(const Between& between, const Six& force, VecX& pushes) const {
  if (dof(between.a) >= 0) pushes.segment<6>(dof(between.a)) += motion_at(between.arm_a).transpose() * force;
  if (dof(between.b) >= 0) pushes.segment<6>(dof(between.b)) -= motion_at(between.arm_b).transpose() * force;
}

// How far, m, b's point would be off a's at the substep's end if the joint did not open at its start: arms
// turn on arcs, while velocities are straight.
Vec3 JointSolver::off_by_turning(const WorkJoint& joint) const {
  const auto sag = [&](const WorkBody& b, const Vec3& arm) {
    const Vec3 turn = step_ * b.spin;
    return Vec3(rotation_by(turn) * arm - arm - turn.cross(arm));
  };
  return sag(work_.bodies[at(joint.b)], joint.arm_b) - sag(work_.bodies[at(joint.a)], joint.arm_a);
}

// Whose contacts bear something, or did in the substep before.
void JointSolver::find_pressed() {
  for (const int k : island_.contacts) {
    const SolverContact& c = work_.contacts[at(k)];
    is_pressed_[at(c.a)] = is_pressed_[at(c.b)] = 0;
  }
  for (const int k : island_.contacts) {
    const SolverContact& c = work_.contacts[at(k)];
    if (c.slack <= 0.0 || c.impulse[0] > 0.0 || c.warm[0] > 0.0)
      is_pressed_[at(c.a)] = is_pressed_[at(c.b)] = 1;
  }
}

bool JointSolver::is_pressed(const WorkJoint& joint) const {
  return is_pressed_[at(joint.a)] != 0 || is_pressed_[at(joint.b)] != 0;
}

// The share of what a joint is off that is mended, so that it moves no further than `most` of the lesser
// reach, and rad.
double JointSolver::mended_share(const WorkJoint& joint, double most) const {
  const double reach = std::min(work_.bodies[at(joint.a)].reach, work_.bodies[at(joint.b)].reach);
  const double far = std::max(joint.off.norm() / reach, joint.joint->is_pivot ? 0.0 : joint.off_turn.norm());
  return kMended * far > most ? most / far : kMended;
}

// The motion of all bodies that closes joints by so much, as nearly as all of them can: no joint is bidden
// what another forbids, for being so stiff they would strain each other without end. A chain that is straight
// between two hooks can only close by going far aside, and what moves so far in a substep is not what was
// asked for.
VecX JointSolver::find_motion(const std::vector<Six>& offs, double most) const {
  VecX pushes = VecX::Zero(dof_count_);
  for (std::size_t n = 0; n < island_.joints.size(); ++n)
    add_pushes(work_.joints[at(island_.joints[n])], offs[n].head<3>(), offs[n].tail<3>(), pushes);
  VecX motion = factor_->solver.solve(pushes);
  double far = 0.0;
  for (const int i : island_.bodies) {
    if (dof(i) < 0) continue;
    far = std::max({far, motion.segment<3>(dof(i)).norm() / work_.bodies[at(i)].reach,
                    motion.segment<3>(dof(i) + 3).norm()});
  }
  if (far > most) motion *= most / far;
  return motion;
}

// How a joint closes by a motion of all bodies.
Six JointSolver::closes_by(const WorkJoint& joint, const VecX& motion) const {
  Six closing = Six::Zero();
  if (dof(joint.a) >= 0) closing += motion_at(joint.arm_a) * motion.segment<6>(dof(joint.a));
  if (dof(joint.b) >= 0) closing -= motion_at(joint.arm_b) * motion.segment<6>(dof(joint.b));
  return closing;
}

// J, of the joined bodies: at such speeds, and at theirs.
double JointSolver::energy_of(const VecX& speeds) const {
  double sum = 0.0;
  for (const int i : island_.bodies)
    if (dof(i) >= 0)
      sum += kinetic_energy(work_.bodies[at(i)], work_.bodies[at(i)].rotation, speeds.segment<3>(dof(i)),
                            speeds.segment<3>(dof(i) + 3));
  return sum;
}

double JointSolver::energy_of_joined() const {
  double sum = 0.0;
  for (const int i : island_.bodies) {
    const WorkBody& b = work_.bodies[at(i)];
    if (dof(i) >= 0) sum += kinetic_energy(b, b.rotation, b.velocity, b.spin);
  }
  return sum;
}

// What contacts are in the way of is mended by a speed, which sweeps hold against them; and mortar, all of it
// by one share: it does not turn.
void JointSolver::find_closing() {
  double of_mortar = kMended;
  for (const int k : island_.joints) {
    const WorkJoint& joint = work_.joints[at(k)];
    if (!joint.joint->is_pivot) of_mortar = std::min(of_mortar, mended_share(joint, kMostMended));
  }
  std::vector<Six> offs(island_.joints.size());
  for (std::size_t n = 0; n < island_.joints.size(); ++n) {
    const WorkJoint& joint = work_.joints[at(island_.joints[n])];
    const bool is_pivot = joint.joint->is_pivot;
    const double of_pivot = is_pivot && is_pressed(joint) ? mended_share(joint, kMostClosing * step_) : 0.0;
    const double share = is_pivot ? of_pivot : has_pivots_ ? of_mortar : 1.0;
    offs[n] << share * joint.off, share * joint.off_turn;
    if (is_pivot) offs[n].head<3>() += off_by_turning(joint);
  }
  VecX speeds =
      (has_pivots_ ? 1.0 : of_mortar) / step_ * find_motion(offs, has_pivots_ ? kMostClosed : 1e300);
  if (has_pivots_) {
    const double closing_energy = energy_of(speeds), own_energy = energy_of_joined();
    if (closing_energy > kMostGiven * own_energy)
      speeds *= std::sqrt(kMostGiven * own_energy / closing_energy);
  }
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    const Six closing = closes_by(joint, speeds);
    joint.closing = closing.head<3>();
    joint.closing_turn = closing.tail<3>();
  }
}

// Links that are pulled taut turn at other speeds by the joints' impulses than they came with.
void JointSolver::aim() {
  if (is_empty()) return;
  if (has_pivots_) find_pressed();
  find_closing();
  if (!has_pivots_) return;
  given_ = 0.0;
  hold(true);
  find_closing();
}

// The impulses with which joints come to close so fast, as nearly as all of them can. These, not the changes
// that they are found by, are given to the bodies: both get the same to the last bit.
void JointSolver::give(const std::vector<Six>& wanted, Vec3 WorkJoint::*impulses, Vec3 WorkJoint::*couples) {
  VecX pushes = VecX::Zero(dof_count_);
  for (std::size_t n = 0; n < island_.joints.size(); ++n)
    add_pushes(work_.joints[at(island_.joints[n])], wanted[n].head<3>(), wanted[n].tail<3>(), pushes);
  const VecX change = factor_->solver.solve(pushes);
  for (std::size_t n = 0; n < island_.joints.size(); ++n) {
    WorkJoint& joint = work_.joints[at(island_.joints[n])];
    Six left = wanted[n];
    if (dof(joint.a) >= 0) left -= motion_at(joint.arm_a) * change.segment<6>(dof(joint.a));
    if (dof(joint.b) >= 0) left += motion_at(joint.arm_b) * change.segment<6>(dof(joint.b));
    const Vec3 impulse = joint.linear_stiffness * left.head<3>();
    const Vec3 couple = joint.turn_stiffness * left.tail<3>();
    push(joint, impulse, couple);
    joint.*impulses += impulse;
    joint.*couples += couple;
  }
}

// How b's end of the joint moves against a's, and turns.
Six JointSolver::relative(const WorkJoint& joint) const {
  const WorkBody &a = work_.bodies[at(joint.a)], &b = work_.bodies[at(joint.b)];
  Six speeds;
  speeds << b.velocity + b.spin.cross(joint.arm_b) - a.velocity - a.spin.cross(joint.arm_a), b.spin - a.spin;
  return speeds;
}

void JointSolver::push(const WorkJoint& joint, const Vec3& impulse, const Vec3& couple) {
  const Six before = has_pivots_ ? relative(joint) : Six(Six::Zero());
  const auto push_one = [&](WorkBody& b, const Vec3& arm, double sign) {
    if (b.inverse_mass == 0.0) return;
    const Vec3 velocity = b.locked.let_move(sign * b.inverse_mass * impulse);
    const Vec3 spin = sign * (b.inverse_inertia * (arm.cross(impulse) + couple));
    b.velocity += velocity;
    b.spin += spin;
    b.stirred += velocity.lpNorm<1>() + b.reach * spin.lpNorm<1>();
  };
  push_one(body(joint.a), joint.arm_a, 1.0);
  push_one(body(joint.b), joint.arm_b, -1.0);
  if (!has_pivots_) return;
  const Six mean = 0.5 * (before + relative(joint));
  given_ -= impulse.dot(mean.head<3>()) + couple.dot(mean.tail<3>());
}

// J, of all bodies of the island, against the start of the step.
double JointSolver::energy() const {
  double sum = 0.0;
  for (const int i : island_.bodies) {
    const WorkBody& b = work_.bodies[at(i)];
    sum += kinetic_energy(b, b.rotation, b.velocity, b.spin) - b.gravity.dot(b.way) / b.inverse_mass;
  }
  return sum;
}

void JointSolver::note_energy() {
  if (knows_energy_) energy_ = energy();
}

// Joints do no work. What they did all the same, where velocities could not follow what is pulled taut, their
// friction takes.
void JointSolver::settle() {
  if (!has_pivots_) return;
  double won = given_;
  if (knows_energy_) won = std::max(won, energy() - energy_);
  if (won <= 0.0) return;
  VecX pushes = VecX::Zero(dof_count_);
  std::vector<Vec3> couples(island_.joints.size(), Vec3::Zero());
  double slope = 0.0;
  for (std::size_t n = 0; n < couples.size(); ++n) {
    const WorkJoint& joint = work_.joints[at(island_.joints[n])];
    if (!joint.joint->is_pivot) continue;
    const WorkBody &a = body(joint.a), &b = body(joint.b);
    const double yields = a.inverse_inertia.trace() + b.inverse_inertia.trace();
    if (!(yields > 0.0)) continue;
    couples[n] = (b.spin - a.spin) / yields;
    slope += couples[n].dot(b.spin - a.spin);
    if (dof(joint.a) >= 0) pushes.segment<3>(dof(joint.a) + 3) += couples[n];
    if (dof(joint.b) >= 0) pushes.segment<3>(dof(joint.b) + 3) -= couples[n];
  }
  const double curvature = pushes.dot(factor_->solver.solve(pushes));
  if (!(curvature > 0.0)) return;
  const double root = std::sqrt(std::max(0.0, slope * slope - 2.0 * curvature * won));
  const double share = (slope - root) / curvature;
  for (std::size_t n = 0; n < couples.size(); ++n)
    push(work_.joints[at(island_.joints[n])], Vec3::Zero(), share * couples[n]);
  hold(false);
}

void JointSolver::hold(bool closes) {
  if (is_empty()) return;
  std::vector<Six> wanted(island_.joints.size());
  for (std::size_t n = 0; n < island_.joints.size(); ++n) {
    const WorkJoint& joint = work_.joints[at(island_.joints[n])];
    wanted[n] = relative(joint);
    if (closes) wanted[n].head<3>() += joint.closing;
    if (closes) wanted[n].tail<3>() += joint.closing_turn;
  }
  give(wanted, &WorkJoint::given, &WorkJoint::given_couple);
}

void JointSolver::lend() {
  if (!has_pivots_) return;
  std::vector<Six> offs(island_.joints.size());
  for (std::size_t n = 0; n < island_.joints.size(); ++n) {
    WorkJoint& joint = work_.joints[at(island_.joints[n])];
    joint.lent = joint.lent_couple = Vec3::Zero();
    const bool is_free = joint.joint->is_pivot && !is_pressed(joint);
    const double share = is_free ? mended_share(joint, kMostMended) : 0.0;
    offs[n] << share * joint.off, share * joint.off_turn;
  }
  const VecX motion = find_motion(offs, kMostLent);
  for (std::size_t n = 0; n < island_.joints.size(); ++n)
    offs[n] = closes_by(work_.joints[at(island_.joints[n])], motion) / step_;
  give(offs, &WorkJoint::lent, &WorkJoint::lent_couple);
}

void JointSolver::take_back() {
  if (!has_pivots_) return;
  for (const int k : island_.joints) {
    const WorkJoint& joint = work_.joints[at(k)];
    push(joint, -joint.lent, -joint.lent_couple);
  }
}

void JointSolver::feel_blow(const SolverContact& c, const Vec3& impulse) {
  if (is_empty()) return;
  if (blow_.size() == 0) blow_ = VecX::Zero(dof_count_);
  Six force;
  force << impulse[0] * c.normal + impulse[1] * c.tangent_u + impulse[2] * c.tangent_v, Vec3::Zero();
  add_force(c, force, blow_);
}

void JointSolver::keep_arrival() {
  if (is_empty()) return;
  struck_.clear();
  for (const int k : island_.joints) struck_.push_back(work_.joints[at(k)]);
  std::swap(factor_, struck_factor_);
  if (!factor_) factor_ = std::make_unique<Factor>();
}

// A blow lasts for an instant, and what swings or presses for it much longer: what joints give to hold
// together against the blow alone is told apart. Where it met them: a chain that hangs straight bears
// nothing along of what strikes it from the side, one that has swung by a hair much.
void JointSolver::book_blow() {
  if (blow_.size() == 0) return struck_.clear();
  const bool is_kept = !struck_.empty();
  const VecX motion = (is_kept ? struck_factor_ : factor_)->solver.solve(blow_);
  for (std::size_t n = 0; n < island_.joints.size(); ++n) {
    WorkJoint& joint = work_.joints[at(island_.joints[n])];
    const WorkJoint& then = is_kept ? struck_[n] : joint;
    const Six closing = closes_by(then, motion);
    joint.blow -= then.axes.transpose() * (then.linear_stiffness * closing.head<3>());
    joint.blow_couple -= then.axes.transpose() * (then.turn_stiffness * closing.tail<3>());
    joint.is_struck = true;
  }
  blow_.resize(0);
  struck_.clear();
}

void JointSolver::book() {
  book_blow();
  for (const int k : island_.joints) {
    WorkJoint& joint = work_.joints[at(k)];
    joint.total_world += joint.given;
    joint.most = std::max(joint.most, joint.given.norm());
    joint.total_couple_world += joint.given_couple;
    joint.total += joint.axes.transpose() * joint.given;
    joint.total_couple += joint.axes.transpose() * joint.given_couple;
    joint.given = joint.given_couple = Vec3::Zero();
  }
}

}  // namespace shatterbox::dynamics
