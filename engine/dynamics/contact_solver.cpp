#include "engine/dynamics/contact_solver.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"
#include "engine/dynamics/contact_place.h"
#include "engine/dynamics/island_solver.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

// Bodies that no impulse moves are shared by islands: their motion is known after any substep.
Moved moved(const WorkBody& body, int substeps) {
  if (body.inverse_mass > 0.0) return {body.way, body.turn};
  if (body.rides.empty() || substeps == 0) return {Vec3::Zero(), Mat3::Identity()};
  const WorkBody::Ride& ride = body.rides[at(substeps - 1)];
  if (body.shape->kind == body::ShapeKind::sphere) return {ride.way, Mat3::Identity()};
  return {ride.way, ride.turn.toRotationMatrix()};
}

}  // namespace

// A row for each pair, named after the first of its contacts that is visited. These come one after the other,
// but in small islands what was found on the way lies behind all others.
void IslandSolver::number_pairs() {
  const std::size_t count = order_.contacts.size();
  pair_work_.assign(count, 0.0);
  bool is_behind = false;
  for (std::size_t k = 0; k < count; ++k) {
    const int pair = contact(k).pair, last = k > 0 ? contact(k - 1).pair : -1;
    is_behind = is_behind || (pair < last && !island_.is_large());
    std::size_t first = is_behind ? 0 : k;
    while (contact(first).pair != pair) ++first;
    contact(k).row = pair == last ? contact(k - 1).row : static_cast<int>(first);
  }
}

void IslandSolver::run() {
  take_substeps();
  if (!has_won_energy()) return;
  is_wary_ = true;
  take_substeps();
}

// Impulses only take energy where the poses are for which they were found. What is wedged under a great load
// and turns far in a substep starts the next one with that load along other arms.
bool IslandSolver::has_won_energy() const {
  if (has_scripted_ || !joints_.is_empty()) return false;
  double widest = 0.0;  // m: no opening in a substep is wider
  for (const int i : island_.contacts) widest = std::max(widest, work_.contacts[at(i)].kept_gap);
  const double speed = widest / substep_;
  double before = 0.0, after = 0.0, from_openings = 0.0;  // J
  for (const int i : island_.bodies) {
    const WorkBody& b = work_.bodies[at(i)];
    if (!b.torque.isZero(0.0)) return false;
    const double mass = 1.0 / b.inverse_mass;
    before += kinetic_energy(b, b.start.rotation, b.velocity_start, b.spin_start);
    after += kinetic_energy(b, b.rotation, b.velocity, b.spin) - mass * b.gravity.dot(b.way);
    from_openings += mass * (0.5 * speed * speed + b.gravity.norm() * widest);
  }
  return after - before > kWon * before + from_openings;
}

void IslandSolver::take_substeps() {
  begin();
  for (int i = 0; i < settings_.substeps; ++i) {
    ride(i);
    if (i == 0) prepare(0);  // later ones begin where the one before ended
    if (island_.may_break) begin_hits(i == 0);
    double gone = 0.0;
    for (int cut = 0; gone < substep_; ++cut) {
      part_start_ = i * substep_ + gone;
      const double left = substep_ - gone;
      set_step(cut < kMostCuts ? until_first_arrival(left) : left);
      ends_with_arrival_ = step_ < left;
      take_part(i + 1);
      gone = step_ < substep_ - gone ? gone + step_ : substep_;
    }
    if (island_.may_break) book_hits();
    each_body([&](WorkBody& b) {
      if (b.shape->kind == body::ShapeKind::sphere) return;
      if (i == 0) b.substep_poses.reserve(at(settings_.substeps));
      b.substep_poses.push_back({b.rotation, b.start.translation + b.way});
    });
  }
  set_step(substep_);
  if (island_.may_break) end_hits();
  // What bore and was not hit is logged with its effective mass at the end.
  each([&](std::size_t, SolverContact& c, Found&) {
    if (c.effective_mass == 0.0 && c.given.impulse_a.squaredNorm() > 0.0) respond(c);
  });
}

void IslandSolver::take_part(int substeps) {
  joints_.note_energy();
  kick();
  joints_.aim();
  is_before_drift_ = true;
  find_arrivals();
  start_warm(0.5);
  sweep_before_drift();
  is_before_drift_ = false;
  drift();
  kick();
  if (has_arrivals_) joints_.keep_arrival();
  prepare(substeps);
  joints_.take_back();
  find_late_arrivals();
  if (may_strike_on_) strike();
  start_warm(0.5);
  sweep_after_drift();
  bounce();
  joints_.settle();
  book();
}

// What contacts remember is of a part as long as this one.
void IslandSolver::set_step(double step) {
  if (step == step_) return;
  const double ratio = step / step_;
  for (const int i : island_.contacts) {
    SolverContact& c = work_.contacts[at(i)];
    c.warm *= ratio;
    c.strained_from *= ratio;
  }
  step_ = step;
}

// Where contacts are few, a substep is cut where the first of them arrives: it bounces there and then, and
// what comes later, or never for that, bears nothing of it.
double IslandSolver::until_first_arrival(double left) {
  if (!has_hits_one_by_one()) return left;
  double first = left;
  for (const int i : island_.contacts) {
    const SolverContact& c = work_.contacts[at(i)];
    const double speed = relative_velocity(c)[0];  // closing is negative
    const double drive = c.normal.dot(body(c.a).gravity - body(c.b).gravity);
    const double way = std::max(0.0, c.slack) + (may_strike_on_ ? kLanding : kTouching) * c.kept_gap;
    const double speed_squared = speed * std::abs(speed) + 2.0 * drive * way;
    if (speed_squared >= -c.threshold * c.threshold) continue;
    first = std::min(first, 2.0 * way / (std::sqrt(-speed_squared) - speed));
  }
  const double least = kLeastPart * substep_;
  first = std::max(first, least);
  return left - first < least ? left : first;
}

// The solver may be run again with more contacts: all begins at the start of the step.
void IslandSolver::begin() {
  seen_.assign(order_.contacts.size(), 0.0);
  each_body([](WorkBody& b) {
    b.velocity = b.velocity_start;
    b.spin = b.spin_start;
    b.way.setZero();
    b.rotation = b.start.rotation;
    b.turn.setIdentity();
    b.turn_angle = 0.0;
    b.stirred = 0.0;
    b.substep_poses.clear();
    place_inertia(b);
  });
  joints_.begin();
  may_strike_on_ = strikes_one_by_one(island_, work_);
  const Found scripted = each([&](std::size_t, SolverContact& c, Found& found) {
    const WorkBody &a = body(c.a), &b = body(c.b);
    found.is_any = found.is_any || a.is_scripted || b.is_scripted;
    const WorkBody& lighter = a.inverse_mass > b.inverse_mass ? a : b;
    c.strained_from = kStrain * lighter.gravity.norm() * step_ / lighter.inverse_mass;
    c.warm = c.warm_start;
    c.held_from = -c.creep_before;
    c.arrival_speed = c.arrival_before;
    c.impulse.setZero();
    reset_axes(c);
    c.total.setZero();
    c.given = {};
    c.hits.clear();
    c.closing_speed = c.arrival_time = c.effective_mass = 0.0;
  });
  has_scripted_ = scripted.is_any;
}

// Scripted bodies have their own velocity in each substep. Islands that share one are solved one after the
// other.
void IslandSolver::ride(int substep) {
  if (!work_.has_scripted) return;
  const auto ride_on = [&](int k) {
    WorkBody& b = body(k);
    if (b.rides.empty()) return;
    b.velocity = b.rides[at(substep)].velocity;
    b.spin = b.rides[at(substep)].spin;
  };
  for (const int i : island_.contacts) {
    ride_on(work_.contacts[at(i)].a);
    ride_on(work_.contacts[at(i)].b);
  }
  for (const int i : island_.joints) {
    ride_on(work_.joints[at(i)].a);
    ride_on(work_.joints[at(i)].b);
  }
}

void IslandSolver::kick() {
  each_body([&](WorkBody& b) {
    b.velocity += b.gravity * (0.5 * step_);
    if (!b.torque.isZero(0.0)) b.spin += b.inverse_inertia * b.torque * (0.5 * step_);
  });
}

void IslandSolver::drift() {
  joints_.lend();
  each_body([&](WorkBody& b) {
    b.way += b.velocity * step_;
    const bool is_fast = b.spin.squaredNorm() * step_ * step_ > kFastSpin * kFastSpin;
    advance_turn(b.inertia, b.locked, step_, is_fast ? SpinOrder::fourth : SpinOrder::second, b.rotation,
                 b.spin);
    const Mat3 r = b.rotation.toRotationMatrix();
    // A sphere touches with whatever point is lowest, not with the one that was.
    if (b.shape->kind != body::ShapeKind::sphere)
      b.turn = r * b.start.rotation.toRotationMatrix().transpose();
    place_inertia(b);
    if (b.shape->kind != body::ShapeKind::sphere) {
      b.turn_angle += b.spin.norm() * step_;
    }
  });
}

// Arms and gap at the present pose. Both bodies feel the impulse at one and the same point: angular momentum
// is kept to rounding.
void IslandSolver::prepare(int substeps) {
  joints_.place(substeps);
  each([&](std::size_t, SolverContact& c, Found&) {
    const WorkBody &a = body(c.a), &b = body(c.b);
    const Moved ma = moved(a, substeps), mb = moved(b, substeps);
    const PlacedContact now = place_contact(a, ma, b, mb, c.found);
    turn_axes(c, now.normal);
    c.change = (ma.way - mb.way) + (now.arm_a - c.arm_a_start) - (now.arm_b - c.arm_b_start);
    c.slack = now.gap - c.kept_gap;
    // One point for both bodies, seen from both centres.
    const Vec3 centre_a = a.start.translation + ma.way, centre_b = b.start.translation + mb.way;
    c.point = c.found.lean * (centre_a + now.arm_a) + (1.0 - c.found.lean) * (centre_b + now.arm_b);
    c.arm_a = c.point - centre_a;
    c.arm_b = c.point - centre_b;
    c.has_response = false;
  });
}

// Masses that are not alike along all axes. Where nothing gives way along the normal, no impulse can mend
// anything; across it friction goes to its bound, which the lock takes.
void IslandSolver::respond_locked(const WorkBody& a, const WorkBody& b, SolverContact& c) {
  const Vec3 axes[3] = {c.normal, c.tangent_u, c.tangent_v};
  const double both = a.inverse_mass + b.inverse_mass, least = body::kLeastYield * both;
  const auto taken = [&](const WorkBody& w, int k, int l) {
    return w.inverse_mass * axes[k].dot(axes[l] - w.locked.let_move(axes[l]));
  };
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) c.response(k, l) -= taken(a, k, l) + taken(b, k, l);
  for (int k = 1; k < 3; ++k) c.response(k, k) += least;
  for (int k = 0; k < 3; ++k) c.weights[k] = c.response(k, k) >= least ? 1.0 / c.response(k, k) : 0.0;
}

void IslandSolver::find_response(SolverContact& c) {
  const WorkBody &a = body(c.a), &b = body(c.b);
  const Vec3 axes[3] = {c.normal, c.tangent_u, c.tangent_v};
  Vec3 moment_a[3], moment_b[3];
  for (int k = 0; k < 3; ++k) {
    moment_a[k] = c.arm_a.cross(axes[k]);
    moment_b[k] = c.arm_b.cross(axes[k]);
  }
  const double both = a.inverse_mass + b.inverse_mass;
  for (int k = 0; k < 3; ++k) {
    Vec3 spin_a = Vec3::Zero(), spin_b = Vec3::Zero();
    if (a.inverse_mass > 0.0) spin_a = a.inverse_inertia * moment_a[k];
    if (b.inverse_mass > 0.0) spin_b = b.inverse_inertia * moment_b[k];
    for (int l = 0; l <= k; ++l) {
      const double value = spin_a.dot(moment_a[l]) + spin_b.dot(moment_b[l]) + (k == l ? both : 0.0);
      c.response(k, l) = c.response(l, k) = value;
    }
    c.weights[k] = 1.0 / c.response(k, k);
  }
  if (a.locked.any() || b.locked.any()) respond_locked(a, b, c);
  c.has_response = true;
}

// What arrived struck with all that it gave; what was touched passes on what it gave beyond the usual.
void IslandSolver::feel_blows() {
  if (!has_arrivals_ || joints_.is_empty()) return;
  for (const int i : island_.contacts) {
    const SolverContact& c = work_.contacts[at(i)];
    const Vec3 usual = c.is_arriving ? Vec3::Zero() : c.warm;
    joints_.feel_blow(c, c.impulse - usual);
  }
}

// An impact's impulse says nothing about the next substep: the bodies in it start that one from what was
// before.
void IslandSolver::book() {
  feel_blows();
  joints_.book();
  for (const int i : island_.bodies) body(i).is_struck = false;
  for (const int i : island_.contacts) {
    const SolverContact& c = work_.contacts[at(i)];
    if (!c.is_arriving) continue;
    for (const int k : {c.a, c.b}) {
      if (body(k).inverse_mass > 0.0) body(k).is_struck = true;
    }
  }
  each([&](std::size_t, SolverContact& c, Found&) {
    const bool was_impact = body(c.a).is_struck || body(c.b).is_struck;
    if (!was_impact) c.warm = c.impulse;
    if (!c.can_creep || was_impact)
      c.held_from = c.change;
    else if (slides(c))
      slide_on(c);
    keep_impulse(c);
  });
}

void IslandSolver::keep_impulse(SolverContact& c) {
  if (c.impulse.squaredNorm() == 0.0) return;
  const Quat from_a = rotation_now(body(c.a)).conjugate(), from_b = rotation_now(body(c.b)).conjugate();
  const Vec3 p = c.impulse[0] * c.normal + c.impulse[1] * c.tangent_u + c.impulse[2] * c.tangent_v;
  c.given.impulse_a += from_a * p;
  c.given.impulse_b -= from_b * p;
  c.given.moment_a += c.impulse[0] * (from_a * c.arm_a);
  c.given.moment_b += c.impulse[0] * (from_b * c.arm_b);
  c.given.moment_point += c.impulse[0] * c.point;
  c.given.moment_weight += c.impulse[0];
}

bool strikes_one_by_one(const Island& island, const MotionWork& work) {
  if (island.contacts.size() > kFewContacts) return false;
  // What hangs on something that stands still swings on its own; chains share a blow.
  const auto hangs = [&](int i) {
    const WorkJoint& joint = work.joints[at(i)];
    return joint.joint->is_pivot &&
           (work.bodies[at(joint.a)].inverse_mass == 0.0 || work.bodies[at(joint.b)].inverse_mass == 0.0);
  };
  if (!std::all_of(island.joints.begin(), island.joints.end(), hangs)) return false;
  const auto is_plain = [&](int body) {
    const WorkBody& b = work.bodies[at(body)];
    return !b.is_scripted && !body::is_mesh(b.shape->kind);
  };
  return std::all_of(island.contacts.begin(), island.contacts.end(), [&](int i) {
    const SolverContact& c = work.contacts[at(i)];
    return is_plain(c.a) && is_plain(c.b);
  });
}

void solve_island(const ContactSettings& settings, const Island& island, MotionWork& work) {
  const auto solve = [&](core::Crew& crew) { IslandSolver(settings, island, work, crew).run(); };
  if (island.is_large()) return core::Crew::run(solve);
  core::Crew alone;
  solve(alone);
}

}  // namespace shatterbox::dynamics
