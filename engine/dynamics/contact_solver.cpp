#include "engine/dynamics/contact_solver.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"
#include "engine/core/stop.h"
#include "engine/dynamics/contact_friction.h"
#include "engine/dynamics/joint_solver.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

// Bodies that no impulse moves are shared by islands: their motion is known after any substep.
struct Moved {
  Vec3 way;
  Mat3 turn;
};

Moved moved(const WorkBody& body, int substeps) {
  if (body.inverse_mass > 0.0) return {body.way, body.turn};
  if (body.rides.empty() || substeps == 0) return {Vec3::Zero(), Mat3::Identity()};
  const WorkBody::Ride& ride = body.rides[at(substeps - 1)];
  if (body.shape->kind == body::ShapeKind::sphere) return {ride.way, Mat3::Identity()};
  return {ride.way, ride.turn.toRotationMatrix()};
}

// An arm of `w` whose contact lies in the direction `outwards`. What is radius of a capsule's does not turn:
// it touches with whatever point is lowest.
Vec3 turned(const WorkBody& w, const Moved& moved, const Vec3& arm, const Vec3& outwards) {
  if (w.shape->kind != body::ShapeKind::capsule) return moved.turn * arm;
  const Vec3 round = w.shape->radius * outwards;
  return moved.turn * (arm - round) + round;
}

class IslandSolver {
 public:
  IslandSolver(const ContactSettings& settings, const Island& island, MotionWork& work)
      : settings_(settings),
        island_(island),
        work_(work),
        substep_(settings.time_step / settings.substeps),
        step_(substep_),
        joints_(island, step_, work) {}

  void run() {
    begin();
    for (int i = 0; i < settings_.substeps; ++i) {
      ride(i);
      if (i == 0) prepare(0);  // later ones begin where the one before ended
      double gone = 0.0;
      for (int cut = 0; gone < substep_; ++cut) {
        part_start_ = i * substep_ + gone;
        set_step(cut < kMostCuts ? until_first_arrival(substep_ - gone) : substep_ - gone);
        take_part(i + 1);
        gone = step_ < substep_ - gone ? gone + step_ : substep_;
      }
      for (const int k : island_.bodies)
        if (body(k).shape->kind != body::ShapeKind::sphere)
          body(k).substep_rotations.push_back(body(k).rotation);
    }
    set_step(substep_);
  }

 private:
  void take_part(int substeps) {
    kick();
    is_before_drift_ = true;
    find_arrivals();
    start_warm(0.5);
    sweep_before_drift();
    is_before_drift_ = false;
    drift();
    kick();
    prepare(substeps);
    find_late_arrivals();
    start_warm(0.5);
    sweep_after_drift();
    bounce();
    book();
  }

  // What contacts remember is of a part as long as this one.
  void set_step(double step) {
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
  double until_first_arrival(double left) {
    const bool is_large = island_.contacts.size() > kMostCutContacts;
    if (is_large || has_scripted_ || !joints_.is_empty()) return left;
    double first = left;
    for (const int i : island_.contacts) {
      const SolverContact& c = work_.contacts[at(i)];
      const double speed = relative_velocity(c)[0];  // closing is negative
      const double drive = c.normal.dot(body(c.a).gravity - body(c.b).gravity);
      const double way = std::max(0.0, c.slack) + kTouching * c.kept_gap;
      const double speed_squared = speed * std::abs(speed) + 2.0 * drive * way;
      if (speed_squared >= -c.threshold * c.threshold) continue;
      first = std::min(first, 2.0 * way / (std::sqrt(-speed_squared) - speed));
    }
    const double least = kLeastPart * substep_;
    first = std::max(first, least);
    return left - first < least ? left : first;
  }

  // The solver may be run again with more contacts: all begins at the start of the step.
  void begin() {
    seen_.assign(island_.contacts.size(), 0.0);
    for (const int i : island_.bodies) {
      WorkBody& b = body(i);
      b.velocity = b.velocity_start;
      b.spin = b.spin_start;
      b.way.setZero();
      b.rotation = b.start.rotation;
      b.turn.setIdentity();
      b.turn_angle = 0.0;
      b.stirred = 0.0;
      b.substep_rotations.clear();
      place_inertia(b);
    }
    joints_.begin();
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      const WorkBody &a = body(c.a), &b = body(c.b);
      has_scripted_ = has_scripted_ || a.is_scripted || b.is_scripted;
      const WorkBody& lighter = a.inverse_mass > b.inverse_mass ? a : b;
      c.strained_from = kStrain * lighter.gravity.norm() * step_ / lighter.inverse_mass;
      c.warm = c.warm_start;
      c.held_from = -c.creep_before;
      c.arrival_speed = c.arrival_before;
      c.total.setZero();
      c.moment_point.setZero();
      c.moment_a.setZero();
      c.moment_b.setZero();
      c.impulse_a.setZero();
      c.impulse_b.setZero();
      c.moment_weight = c.closing_speed = c.arrival_time = c.effective_mass = 0.0;
    }
  }

  // Scripted bodies have their own velocity in each substep. Islands that share one are solved one after the
  // other.
  void ride(int substep) {
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

  static void place_inertia(WorkBody& b) {
    const Mat3 axes = (b.rotation * b.inertia.body_from_axes).toRotationMatrix();
    b.inverse_inertia = axes * b.inverse_moments.asDiagonal() * axes.transpose();
  }

  WorkBody& body(int i) { return work_.bodies[at(i)]; }
  SolverContact& contact(std::size_t k) { return work_.contacts[at(island_.contacts[k])]; }

  void kick() {
    for (const int i : island_.bodies) {
      WorkBody& b = body(i);
      b.velocity += b.gravity * (0.5 * step_);
      if (!b.torque.isZero(0.0)) b.spin += b.inverse_inertia * b.torque * (0.5 * step_);
    }
  }

  void drift() {
    for (const int i : island_.bodies) {
      WorkBody& b = body(i);
      b.way += b.velocity * step_;
      const bool is_fast = b.spin.squaredNorm() * step_ * step_ > kFastSpin * kFastSpin;
      advance_spin(b.inertia, step_, is_fast ? SpinOrder::fourth : SpinOrder::second, b.rotation, b.spin);
      const Mat3 r = b.rotation.toRotationMatrix();
      // A sphere touches with whatever point is lowest, not with the one that was.
      if (b.shape->kind != body::ShapeKind::sphere)
        b.turn = r * b.start.rotation.toRotationMatrix().transpose();
      place_inertia(b);
      if (b.shape->kind != body::ShapeKind::sphere) {
        b.turn_angle += b.spin.norm() * step_;
      }
    }
  }

  // Arms, gap and response at the present pose. Both bodies feel the impulse at one and the same point:
  // angular momentum is kept to rounding.
  void prepare(int substeps) {
    joints_.place(substeps);
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      const WorkBody &a = body(c.a), &b = body(c.b);
      const Moved ma = moved(a, substeps), mb = moved(b, substeps);
      const Vec3 turned_a = turned(a, ma, c.arm_a_start, -c.normal),
                 turned_b = turned(b, mb, c.arm_b_start, c.normal);
      const Vec3 change = (ma.way - mb.way) + (turned_a - c.arm_a_start) - (turned_b - c.arm_b_start);
      c.change = change;
      const double gap = c.gap_start + c.normal.dot(change);
      c.slack = gap - c.kept_gap;
      // One point for both bodies, seen from both centres.
      const Vec3 centre_a = a.start.translation + ma.way, centre_b = b.start.translation + mb.way;
      c.point = c.lean * (centre_a + turned_a) + (1.0 - c.lean) * (centre_b + turned_b);
      c.arm_a = c.point - centre_a;
      c.arm_b = c.point - centre_b;
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
    }
  }

  Vec3 relative_velocity(const SolverContact& c) {
    const WorkBody &a = body(c.a), &b = body(c.b);
    const Vec3 u = a.velocity + a.spin.cross(c.arm_a) - b.velocity - b.spin.cross(c.arm_b);
    return {c.normal.dot(u), c.tangent_u.dot(u), c.tangent_v.dot(u)};
  }

  static void push(WorkBody& b, const Vec3& impulse, const Vec3& arm) {
    const Vec3 change = b.inverse_mass * impulse, turn = b.inverse_inertia * arm.cross(impulse);
    b.velocity += change;
    b.spin += turn;
    b.stirred += change.lpNorm<1>() + b.reach * turn.lpNorm<1>();
  }

  // `impulse` in the contact's axes; books its work, from the relative velocity before it.
  void apply(SolverContact& c, const Vec3& impulse, const Vec3& velocity_before) {
    const Vec3 p = impulse[0] * c.normal + impulse[1] * c.tangent_u + impulse[2] * c.tangent_v;
    WorkBody &a = body(c.a), &b = body(c.b);
    if (a.inverse_mass > 0.0) push(a, p, c.arm_a);
    if (b.inverse_mass > 0.0) push(b, -p, c.arm_b);
    c.impulse += impulse;
    c.total += p;
    double& work = work_.pairs[at(c.pair)].work;
    work += impulse.dot(velocity_before) + 0.5 * impulse.dot(c.response * impulse);
    // Half of gravity's kick is still to come: along the way that the impulse changes it does this much less
    // work.
    if (is_before_drift_) work -= 0.5 * step_ * p.dot(a.gravity - b.gravity);
  }

  // What closes within this substep, and how fast it will be when it touches. From the energy at the
  // substep's start: gravity's share of the way down is in it, whatever the part of the substep.
  void find_arrivals() {
    has_arrivals_ = false;
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      c.impulse.setZero();
      c.rolling_impulse.setZero();
      c.is_arriving = false;
      c.was_apart = !is_touching(c);
      work_.pairs[at(c.pair)].work = 0.0;
      const double drive = c.normal.dot(body(c.a).gravity - body(c.b).gravity);
      const double after_kick = relative_velocity(c)[0];
      const double before = after_kick - 0.5 * drive * step_;
      const double way = std::max(0.0, c.slack);
      if (after_kick >= 0.0 || way + after_kick * step_ > kTouching * c.kept_gap) continue;
      const double speed_squared = before * std::abs(before) + 2.0 * drive * way;  // closing is negative
      if (speed_squared >= 0.0) continue;
      const double speed = std::sqrt(-speed_squared);
      if (speed <= c.threshold) continue;
      arrive(c, speed, part_start_ + std::min(step_, way / -after_kick));
    }
  }

  // Normals and arms turn on the way: what did not seem to arrive in this part may have all the same. It has
  // come from beyond the kept gap: what is opened, or lies in each other by rounding, does not bounce.
  void find_late_arrivals() {
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      if (!c.was_apart || c.is_arriving || c.impulse[0] > 0.0 || !is_touching(c)) continue;
      const double speed = -relative_velocity(c)[0];
      if (speed > c.threshold && speed * step_ > c.kept_gap) arrive(c, speed, part_start_ + step_);
    }
  }

  void arrive(SolverContact& c, double speed, double time) {
    c.is_arriving = true;
    has_arrivals_ = true;
    c.arrival_speed = std::max(c.arrival_speed, speed);
    if (c.closing_speed == 0.0) c.arrival_time = time;
    if (speed > c.closing_speed) {
      c.closing_speed = speed;
      c.effective_mass = c.weights[0];
    }
  }

  void start_warm(double share) {
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      // What has come apart must not be pushed by what it weighed before.
      if (c.warm[0] > 0.0 && c.slack <= kTouching * c.kept_gap)
        apply(c, share * settings_.warm_start * c.warm, relative_velocity(c));
    }
  }

  // Friction on the normal impulse that `change` leads to, and at the pose that its own drift is to mend.
  void rub(const SolverContact& c, const Vec3& velocity, Vec3& change) const {
    const Vec2 back = is_before_drift_ ? way_back(c, substep_) : Vec2(Vec2::Zero());
    change.tail<2>() = friction_change(c, velocity.tail<2>() + back, c.impulse[0] + change[0]);
  }

  // A contact whose bodies have hardly changed since it was last seen would hardly change them: sweeps pass
  // it by, so that what is still in one place does not pay for what is not in another.
  double stirred(const SolverContact& c) { return body(c.a).stirred + body(c.b).stirred; }
  bool is_still(std::size_t k, const SolverContact& c, double speed) {
    return stirred(c) - seen_[k] <= kStill * speed;
  }
  void see(std::size_t k, const SolverContact& c) { seen_[k] = stirred(c) - c.left_over; }
  void forget_seen() { std::fill(seen_.begin(), seen_.end(), -1e300); }

  // One visit: at least `target` along the normal, then friction. Returns how much closing it found, m/s.
  double visit(SolverContact& c, double target) {
    const Vec3 before = relative_velocity(c);
    c.left_over = 0.0;
    if (before[0] >= target && c.impulse[0] <= 0.0) return 0.0;
    Vec3 change = Vec3::Zero(), u = before;
    change[0] = std::max(-c.impulse[0], (target - u[0]) * c.weights[0]);
    u += c.response.col(0) * change[0];
    rub(c, u, change);
    note_left_over(c, change);
    apply(c, change, before);
    resist_rolling(c, body(c.a), body(c.b));
    return change[0] > 0.0 ? target - before[0] : -change[0] * c.response(0, 0);
  }

  // Friction moves along the normal too: what a further visit would find.
  static void note_left_over(SolverContact& c, const Vec3& change) {
    c.left_over = std::abs(c.response(0, 1) * change[1] + c.response(0, 2) * change[2]);
  }

  // Sweeps alone carry a heavy body on light ones only after as many of them as the masses differ. Where
  // plain ones do not end it, they go on to and fro as nonlinear conjugate gradients: what two sweeps
  // changed is the negative gradient, and a share of the way so far is gone once more, until the changes
  // grow. Only loads on something solid ask for it: a surface that is jammed between others would be pressed
  // harder by every sweep and be no stiller.
  void begin_course() {
    course_square_ = 0.0;
    course_.assign(island_.contacts.size(), Vec3::Zero());
  }
  void note_impulses() {
    before_sweep_.resize(island_.contacts.size());
    for (std::size_t k = 0; k < island_.contacts.size(); ++k) before_sweep_[k] = contact(k).impulse;
  }
  static Vec3 within_cone(const SolverContact& c, Vec3 impulse) {
    impulse[0] = std::max(impulse[0], 0.0);
    const double bound = c.friction * impulse[0], length = impulse.tail<2>().norm();
    if (length > bound) impulse.tail<2>() *= bound / length;
    return impulse;
  }
  void go_on_course() {
    double square = 0.0;
    for (std::size_t k = 0; k < island_.contacts.size(); ++k)
      square += (contact(k).impulse - before_sweep_[k]).squaredNorm();
    const double share = square < course_square_ ? square / course_square_ : 0.0;
    course_square_ = square;
    for (std::size_t k = 0; k < island_.contacts.size(); ++k) {
      SolverContact& c = contact(k);
      const Vec3 change = c.impulse - before_sweep_[k];
      const Vec3 extra = within_cone(c, c.impulse + share * course_[k]) - c.impulse;
      course_[k] = extra + change;
      if (extra.squaredNorm() > 0.0) apply(c, extra, relative_velocity(c));
    }
    forget_seen();
  }

  // How much closing may be left, as a share of what `visit` measures it by.
  struct Sweeps {
    int plain = 1;        // at most, before the course begins
    double enough = 1.0;  // within the plain ones
    double loose = 1.0;   // after them
    double tight = 1.0;   // of an island with strain
  };
  template <class Visit>
  void sweep(const Sweeps& how, const Visit& visit_contact) {
    const std::size_t count = island_.contacts.size();
    const int most = how.plain + static_cast<int>(kCourseSize * kCourseSize / (count * count + 1));
    forget_seen();
    double least_excess = 1e300;
    int least_round = 0;
    for (int round = 0; round < most; ++round) {
      core::stop_if_asked();
      const bool is_on_course = round >= how.plain;
      if (round == how.plain) begin_course();
      if (is_on_course) note_impulses();
      double excess = 0.0;
      bool has_strain = false;
      for (std::size_t i = 0; i < (is_on_course ? 2 * count : count); ++i) {
        const std::size_t k = i < count ? i : 2 * count - 1 - i;
        SolverContact& c = contact(k);
        excess = std::max(excess, visit_contact(k, c));
        const double lasting = std::min(c.impulse[0], c.warm[0]);
        has_strain =
            has_strain || (c.has_sides && lasting > c.strained_from) || (c.is_close && c.impulse[0] > 0.0);
      }
      joints_.hold(is_before_drift_);
      if (count == 0) return;
      const double enough = round + 1 < how.plain ? how.enough : how.loose;
      if (excess < (has_strain ? how.tight : enough)) return;
      // What is jammed has no solution.
      if (excess < kProgress * least_excess) {
        least_excess = excess;
        least_round = round;
      } else if (round > least_round + (has_scripted_ ? kScriptedPatience : kCoursePatience)) {
        return;
      }
      if (is_on_course && round + 1 < most) go_on_course();
    }
  }

  double target_before_drift(const SolverContact& c) const {
    // What touches is held where it is; letting it use up the last of its gap would drop and catch it in
    // turn.
    if (c.slack > kTouching * c.kept_gap) return -c.slack / step_;
    if (c.slack > 0.0) return 0.0;
    const double opening = std::min(0.2 * -c.slack, 0.4 * c.kept_gap) / substep_;
    const double bearable = (c.has_sides || c.can_creep ? kEased : kEasedMoving) * c.strained_from;
    if (c.warm[0] <= bearable) return opening;
    // What is wedged cannot be opened: insisting would only press its bodies against each other, without end.
    // A heavy load on something solid is a weight.
    return c.has_sides ? std::max(kLeastEase, bearable / c.warm[0]) * opening : 0.0;
  }

  // Small islands are swept until nothing is left to do, for large ones few sweeps a substep must do: what
  // they leave the next substep finds, which starts from their impulses.
  int most_sweeps(int of_small) const {
    const auto affordable = static_cast<int>(kVisits / (island_.contacts.size() + 1));
    return std::clamp(affordable, kFewSweeps, of_small);
  }

  // One sweep is mostly enough at rest; what arrives must not overshoot the gap.
  void sweep_before_drift() {
    bool is_pushed_apart = false;
    const auto hold = [&](std::size_t k, SolverContact& c) {
      const double tolerance = kTouching * c.kept_gap / step_;
      if (is_still(k, c, tolerance)) return 0.0;
      const double pressed = c.impulse[0];
      const double found = visit(c, target_before_drift(c));
      see(k, c);
      is_pushed_apart = is_pushed_apart || (c.impulse[0] < pressed && found > tolerance);
      return found / tolerance;
    };
    const int calm = joints_.is_empty() ? 1 : most_sweeps(kJointSweeps);
    sweep({has_arrivals_ ? most_sweeps(16) : calm, 1.0, 1e300, kStrainedGap}, hold);
    // What came free must not be thrown by what wedged it. To press on would only strain what is wedged
    // still.
    for (int round = 1; is_pushed_apart && !has_arrivals_ && round < most_sweeps(16); ++round) {
      is_pushed_apart = false;
      for (std::size_t k = 0; k < island_.contacts.size(); ++k) hold(k, contact(k));
      joints_.hold(is_before_drift_);
    }
  }

  static bool is_touching(const SolverContact& c) {
    return c.slack <= kTouching * c.kept_gap || (c.impulse[0] > 0.0 && c.slack <= c.kept_gap);
  }

  void sweep_after_drift() {
    sweep({most_sweeps(8), kResting, kLooseRest, kResting}, [&](std::size_t k, SolverContact& c) {
      if (is_still(k, c, kResting * c.threshold) || !is_touching(c)) return 0.0;
      const double found = visit(c, 0.0);
      see(k, c);
      return found / c.threshold;
    });
  }

  // Newton's rule with the speed before the impact; the pair's impulses of this substep may not do work in
  // sum.
  void bounce() {
    bool is_due = false;
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      c.target = 0.0;
      if (c.arrival_speed <= 0.0 || !is_touching(c)) continue;
      if (c.impulse[0] <= 0.0 && !c.is_arriving) {  // turned away by others before it touched
        c.arrival_speed = 0.0;
        continue;
      }
      c.target = c.restitution * c.arrival_speed;
      is_due = true;
    }
    if (!is_due) return;
    const int most = most_sweeps(40);
    for (int sweep = 0; sweep < most; ++sweep) {
      core::stop_if_asked();
      double excess = 0.0;
      for (std::size_t k = 0; k < island_.contacts.size(); ++k) {
        SolverContact& c = work_.contacts[at(island_.contacts[k])];
        const double speed = std::max(c.target, c.threshold);
        const bool must_bounce = sweep == 0 && c.target > 0.0;
        if ((!must_bounce && is_still(k, c, kBounced * speed)) || !is_touching(c)) continue;
        const double found = c.target > 0.0 ? visit_bounce(c) : visit(c, 0.0);
        see(k, c);
        excess = std::max(excess, found / speed);
      }
      joints_.hold(is_before_drift_);
      if (excess < kBounced) break;
    }
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      if (is_touching(c)) c.arrival_speed = 0.0;
    }
  }

  double visit_bounce(SolverContact& c) {
    const Vec3 before = relative_velocity(c);
    const double wanted = std::max(-c.impulse[0], (c.target - before[0]) * c.weights[0]);
    Vec3 change(wanted, 0.0, 0.0);
    if (wanted > 0.0) {
      const double budget = std::max(0.0, -work_.pairs[at(c.pair)].work);
      const double root = before[0] * before[0] + 2.0 * c.response(0, 0) * budget;
      const double most = (std::sqrt(root) - before[0]) * c.weights[0];
      change[0] = std::min(wanted, std::max(0.0, most));
    }
    Vec3 u = before + c.response.col(0) * change[0];
    rub(c, u, change);
    note_left_over(c, change);
    apply(c, change, before);
    resist_rolling(c, body(c.a), body(c.b));
    return std::abs(change[0]) * c.response(0, 0);
  }

  static const Quat& rotation_now(const WorkBody& b) {
    return b.inverse_mass > 0.0 ? b.rotation : b.start.rotation;
  }

  // An impact's impulse says nothing about the next substep: the bodies in it start that one from what was
  // before.
  void book() {
    joints_.book();
    for (const int i : island_.bodies) body(i).is_struck = false;
    for (const int i : island_.contacts) {
      const SolverContact& c = work_.contacts[at(i)];
      if (!c.is_arriving) continue;
      for (const int k : {c.a, c.b}) {
        if (body(k).inverse_mass > 0.0) body(k).is_struck = true;
      }
    }
    for (const int i : island_.contacts) {
      SolverContact& c = work_.contacts[at(i)];
      const bool was_impact = body(c.a).is_struck || body(c.b).is_struck;
      if (!was_impact) c.warm = c.impulse;
      if (!c.can_creep || was_impact || c.impulse.tail<2>().norm() >= kSliding * c.friction * c.impulse[0])
        c.held_from = c.change;
      if (c.impulse.squaredNorm() == 0.0) continue;
      const Quat from_a = rotation_now(body(c.a)).conjugate(), from_b = rotation_now(body(c.b)).conjugate();
      const Vec3 p = c.impulse[0] * c.normal + c.impulse[1] * c.tangent_u + c.impulse[2] * c.tangent_v;
      c.impulse_a += from_a * p;
      c.impulse_b -= from_b * p;
      c.moment_a += c.impulse[0] * (from_a * c.arm_a);
      c.moment_b += c.impulse[0] * (from_b * c.arm_b);
      c.moment_point += c.impulse[0] * c.point;
      c.moment_weight += c.impulse[0];
    }
  }

  static constexpr double kTouching = 0.05;    // of the kept gap
  static constexpr double kSliding = 0.999;    // of the friction that there can be
  static constexpr double kResting = 1e-3;     // of the threshold: closing that is left at rest
  static constexpr double kLooseRest = 0.1;    // the same, where no contact is strained
  static constexpr double kStrain = 8.0;       // times the lighter body's weight
  static constexpr double kEased = 0.25;       // of what strains: opening is eased beyond it
  static constexpr double kEasedMoving = 8.0;  // the same, between surfaces that are not quiet
  static constexpr double kLeastEase = 0.05;   // of solids, however much they bear
  static constexpr double kStrainedGap = 0.1;  // of kTouching: overshoot that is left under strain
  // An island of so many contacts has one round of its course, one of a tenth a hundred: small ones are
  // solved to the end, and in large ones no body stands on the few that could not bear it.
  static constexpr std::size_t kCourseSize = 1200;
  static constexpr double kProgress = 0.8;      // a course that in so many rounds has not come so much nearer
  static constexpr int kCoursePatience = 500;   // is given up
  static constexpr int kScriptedPatience = 50;  // the same, where a scripted body may squeeze
  static constexpr std::size_t kVisits = 4800;  // of contacts in all sweeps of one kind in a substep,
  static constexpr int kFewSweeps = 4;          // but never fewer sweeps
  static constexpr double kBounced = 1e-9;      // of the speed: error of a bounce
  static constexpr double kStill = 0.25;        // of what a sweep may leave
  static constexpr double kFastSpin = 0.005;    // rad a substep
  static constexpr std::size_t kMostCutContacts = 64;  // of an island in which substeps are cut
  static constexpr int kMostCuts = 8;                  // of a substep
  static constexpr double kLeastPart = 1.0 / 1024.0;   // of a substep
  static constexpr int kJointSweeps = 8;               // of an island with joints in which nothing arrives

  const ContactSettings& settings_;
  const Island& island_;
  MotionWork& work_;
  const double substep_;  // s
  double step_;           // s, of the part of it that is taken
  JointSolver joints_;
  std::vector<double>
      seen_;  // m/s, per contact of the island: how stirred its bodies were after its last visit
  std::vector<Vec3> course_, before_sweep_;  // N s, per contact of the island
  double course_square_ = 0.0;               // N2 s2, of the last change
  double part_start_ = 0.0;                  // s since the step's start
  bool has_arrivals_ = false;
  bool has_scripted_ = false;  // a scripted body is in it
  bool is_before_drift_ = false;
};

}  // namespace

void solve_island(const ContactSettings& settings, const Island& island, MotionWork& work) {
  IslandSolver(settings, island, work).run();
}

}  // namespace shatterbox::dynamics
