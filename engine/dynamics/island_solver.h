// One island's contacts through one step. Its motion is in contact_solver.cpp, its sweeps over contacts at
// rest in contact_sweeps.cpp, what arrives and bounces in contact_impacts.cpp, the order in which they visit
// contacts in contact_order.cpp, what of their impulses came by hits in contact_hits.cpp; here is what they
// share.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "engine/core/crew.h"
#include "engine/core/index.h"
#include "engine/dynamics/contact_friction.h"
#include "engine/dynamics/contact_order.h"
#include "engine/dynamics/contact_solver.h"
#include "engine/dynamics/joint_solver.h"

namespace shatterbox::dynamics {

class IslandSolver {
 public:
  IslandSolver(const ContactSettings& settings, const Island& island, MotionWork& work, core::Crew& crew)
      : settings_(settings),
        island_(island),
        work_(work),
        crew_(crew),
        order_(order_contacts(island, work)),
        one_half_done_(order_.parts.size()),
        substep_(settings.time_step / settings.substeps),
        step_(substep_),
        joints_(island, step_, work) {
    number_pairs();
  }

  /// Through all substeps.
  void run();

 private:
  // contact_solver.cpp
  void number_pairs();
  void take_substeps();
  bool has_won_energy() const;
  void take_part(int substeps);
  void set_step(double step);
  double until_first_arrival(double left);
  void begin();
  void ride(int substep);
  void kick();
  void drift();
  void prepare(int substeps);
  void find_response(SolverContact& c);
  static void respond_locked(const WorkBody& a, const WorkBody& b, SolverContact& c);
  void feel_blows();
  void book();
  void keep_impulse(SolverContact& c);

  // What visits to contacts found, together.
  struct Found {
    double excess = 0.0;  // the most
    bool is_any = false;  // whatever was asked
    bool has_strain = false;

    void add(const Found& other) {
      excess = std::max(excess, other.excess);
      is_any = is_any || other.is_any;
      has_strain = has_strain || other.has_strain;
    }
  };

  // visit(k, contact, found so far) for all contacts, one after the other where they share a body that
  // impulses move.
  template <class Visit>
  Found in_turn(const Visit& visit);
  // The same for what changes nothing but the contact and its pair.
  template <class Visit>
  Found each(const Visit& visit);
  template <class Visit>
  void each_body(const Visit& visit);
  template <class Visit>
  Found visit_range(const ContactOrder::Range& range, const Visit& visit);
  Found all_found() const {
    Found all;
    for (const Found& found : found_) all.add(found);
    return all;
  }

  // contact_sweeps.cpp
  // How much closing may be left, as a share of what `visit` measures it by.
  struct Sweeps {
    int plain = 1;        // at most, before conjugate steps begin
    double enough = 1.0;  // within the plain ones
    double loose = 1.0;   // after them
    double tight = 1.0;   // of an island with strain
  };
  void start_warm(double share);
  void begin_conjugate_steps();
  void note_impulses();
  void bound_friction();
  static Vec3 within_cone(const SolverContact& c, Vec3 impulse);
  void take_conjugate_step();
  double target_before_drift(const SolverContact& c) const;
  int most_sweeps(int of_small) const;
  int conjugate_patience() const;
  bool is_calmed_well() const;
  int most_calm_sweeps();
  void sweep_before_drift();
  void sweep_after_drift();
  // True if what was asked was so for any contact in any sweep.
  template <class Visit>
  bool sweep(const Sweeps& how, const Visit& visit_contact);

  // contact_impacts.cpp
  void find_arrivals();
  void find_late_arrivals();
  void arrive(SolverContact& c, double speed, double time);
  void strike();
  void leave_softer();
  void hardest_first();
  void bounce_together();
  void bounce();

  // contact_hits.cpp
  void begin_hits(bool is_first);
  void find_hit_pairs();
  void book_hits();
  void end_hits();

  bool has_hits_one_by_one() const {
    return order_.contacts.size() <= kFewContacts && !has_scripted_ && joints_.is_empty();
  }

  static void place_inertia(WorkBody& b) { b.inverse_inertia = inverse_inertia_at(b, b.rotation); }

  // Before an impulse is given. Most contacts are ahead of their bodies and never get one.
  void respond(SolverContact& c) {
    if (!c.has_response) find_response(c);
  }

  WorkBody& body(int i) { return work_.bodies[core::at(i)]; }
  SolverContact& contact(std::size_t k) { return work_.contacts[core::at(order_.contacts[k])]; }
  Vec3 relative_velocity(const SolverContact& c) {
    const WorkBody &a = body(c.a), &b = body(c.b);
    const Vec3 u = a.velocity + a.spin.cross(c.arm_a) - b.velocity - b.spin.cross(c.arm_b);
    return {c.normal.dot(u), c.tangent_u.dot(u), c.tangent_v.dot(u)};
  }

  static void push(WorkBody& b, const Vec3& impulse, const Vec3& arm) {
    const Vec3 change = b.locked.let_move(b.inverse_mass * impulse),
               turn = b.inverse_inertia * arm.cross(impulse);
    b.velocity += change;
    b.spin += turn;
    b.stirred += change.lpNorm<1>() + b.reach * turn.lpNorm<1>();
  }

  // `impulse` in the contact's axes; books its work, from the relative velocity before it.
  void apply(SolverContact& c, const Vec3& impulse, const Vec3& velocity_before) {
    respond(c);
    const Vec3 p = impulse[0] * c.normal + impulse[1] * c.tangent_u + impulse[2] * c.tangent_v;
    WorkBody &a = body(c.a), &b = body(c.b);
    if (a.inverse_mass > 0.0) push(a, p, c.arm_a);
    if (b.inverse_mass > 0.0) push(b, -p, c.arm_b);
    c.impulse += impulse;
    c.total += p;
    double& work = pair_work_[core::at(c.row)];
    work += impulse.dot(velocity_before) + 0.5 * impulse.dot(c.response * impulse);
    // Half of gravity's kick is still to come: along the way that the impulse changes it does this much less
    // work.
    if (is_before_drift_) work -= 0.5 * step_ * p.dot(a.gravity - b.gravity);
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
    respond(c);
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

  static bool slides(const SolverContact& c) {
    return c.impulse.tail<2>().norm() >= kSliding * c.friction * c.impulse[0];
  }

  static bool is_touching(const SolverContact& c) {
    return c.slack <= kTouching * c.kept_gap || (c.impulse[0] > 0.0 && c.slack <= c.kept_gap);
  }

  double visit_bounce(SolverContact& c) {
    respond(c);
    const Vec3 before = relative_velocity(c);
    const double wanted = std::max(-c.impulse[0], (c.target - before[0]) * c.weights[0]);
    Vec3 change(wanted, 0.0, 0.0);
    if (wanted > 0.0) {
      const double budget = std::max(0.0, -pair_work_[core::at(c.row)]);
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

  static constexpr double kTouching = 0.05;  // of the kept gap
  static constexpr double kLanding = 1e-3;  // of it: how little what ends a part is stopped before it bounces
  static constexpr double kSliding = 0.999;       // of the friction that there can be
  static constexpr double kResting = 1e-3;        // of the threshold: closing that is left at rest
  static constexpr double kLooseRest = 0.1;       // the same, where no contact is strained
  static constexpr double kStrain = 8.0;          // times the lighter body's weight
  static constexpr double kEased = 0.25;          // of what strains: opening is eased beyond it
  static constexpr double kEasedMoving = 8.0;     // the same, between surfaces that are not quiet
  static constexpr double kLeastEase = 0.05;      // of solids, however much they bear
  static constexpr double kStrainedGap = 0.1;     // of kTouching: overshoot that is left under strain
  static constexpr double kCalmGap = 0.3;         // the same, where nothing arrives
  static constexpr int kCalmSweeps = 4;           // at most, where nothing arrives and contacts are few:
  static constexpr std::size_t kFewAtRest = 300;  // at most so many in the island
  static constexpr int kShardSweeps = 16;         // of islands of any size in which something may break
  static constexpr double kWarmest = 0.98;  // of the last impulses, where islands are large or may break
  // An island of so many contacts has one conjugate step, one of a tenth a hundred: small ones are
  // solved to the end, and in large ones no body stands on the few that could not bear it.
  static constexpr std::size_t kConjugateSize = Island::kLarge;
  static constexpr double kRunaway = 10.0;        // times the least excess so far: friction feeds itself
  static constexpr double kProgress = 0.8;        // of the least excess: more is no progress, and without any
  static constexpr int kConjugatePatience = 500;  // in so many rounds it is given up
  static constexpr int kBreakablePatience = 100;  // the same, where something may break
  static constexpr int kScriptedPatience = 50;    // the same, where a scripted body may squeeze
  static constexpr std::size_t kVisits = 4800;    // of contacts in all sweeps of one kind in a substep,
  static constexpr int kFewSweeps = 4;            // but never fewer sweeps
  static constexpr double kBounced = 1e-9;        // of the speed: error of a bounce
  static constexpr double kStill = 0.25;          // of what a sweep may leave
  static constexpr double kFastSpin = 0.005;      // rad a substep
  static constexpr double kStruck = 0.5;          // of the kept gap: what is so near is struck at once
  static constexpr int kMostStrikes = 64;         // one after the other, of one hit
  static constexpr double kAlike = 0.1;  // of the hardest of a round: what is softer waits for the next
  static constexpr double kRanks = 1e6;  // speeds that differ by less are alike
  static constexpr int kMostCuts = 8;    // of a substep
  static constexpr double kLeastPart = 1.0 / 1024.0;  // of a substep
  static constexpr std::size_t kBodies = 32;          // that one thread takes at once
  static constexpr double kWon = 1e-3;                // of its energy may an island win, beside openings
  static constexpr int kJointSweeps = 8;              // of an island with joints in which nothing arrives

  const ContactSettings& settings_;
  const Island& island_;
  MotionWork& work_;
  core::Crew& crew_;
  const ContactOrder order_;
  std::vector<std::atomic<char>> one_half_done_;  // per part: of its two, in the visit that goes on
  const double substep_;                          // s
  double step_;                                   // s, of the part of it that is taken
  JointSolver joints_;
  std::vector<double>
      seen_;  // m/s, per contact of the island: how stirred its bodies were after its last visit
  std::vector<double> pair_work_;  // J, by row: of a pair's impulses in this substep
  // Per contact of an island in which something may break: what it gave in former substeps, less its hits,
  // and whether it bore in the last one.
  struct Borne {
    Vec3 total = Vec3::Zero();  // N s
    GivenImpulse given;
    double closing_speed = 0.0;  // m/s, greatest
    bool is_resting = false;     // it bore before its pair arrived
  };
  std::vector<Borne> borne_;
  std::vector<double> hit_left_;                       // s, by row: how long the pair's hit goes on
  std::vector<Found> found_;                           // per range that was visited
  std::vector<std::size_t> struck_;                    // contacts of the island that bounce together
  std::vector<Vec3> search_direction_, before_sweep_;  // N s, per contact of the island
  double gradient_square_ = 0.0;                       // N2 s2, of the last sweep there and back
  double part_start_ = 0.0;                            // s since the step's start
  bool has_arrivals_ = false;
  bool ends_with_arrival_ = false;  // the part that is taken
  bool may_strike_on_ = false;
  bool has_scripted_ = false;  // a scripted body is in it
  bool is_before_drift_ = false;
  bool is_wary_ = false;  // it won energy: nothing starts warm, and friction is bounded from the first sweep
};

template <class Visit>
IslandSolver::Found IslandSolver::in_turn(const Visit& visit) {
  const std::size_t smallest = order_.count_smallest();
  found_.assign(order_.parts.size(), {});
  crew_.loop(smallest, [&](std::size_t i) {
    for (std::size_t part = smallest + i; part > 0; part /= 2) {
      found_[part] = visit_range(order_.parts[part], visit);
      // Who is done with the second half of a part goes on with what is across.
      if (part > 1 && !one_half_done_[part / 2].fetch_xor(1, std::memory_order_acq_rel)) return;
    }
  });
  return all_found();
}

template <class Visit>
IslandSolver::Found IslandSolver::each(const Visit& visit) {
  const std::vector<ContactOrder::Range>& ranges = island_.is_large() ? order_.slices : order_.parts;
  found_.assign(ranges.size(), {});
  crew_.loop(ranges.size(), [&](std::size_t i) { found_[i] = visit_range(ranges[i], visit); });
  return all_found();
}

template <class Visit>
IslandSolver::Found IslandSolver::visit_range(const ContactOrder::Range& range, const Visit& visit) {
  Found found;
  for (std::size_t k = range.begin; k < range.end; ++k) visit(k, contact(k), found);
  return found;
}

template <class Visit>
void IslandSolver::each_body(const Visit& visit) {
  const std::vector<int>& bodies = island_.is_large() ? order_.bodies : island_.bodies;
  const std::size_t chunks = (bodies.size() + kBodies - 1) / kBodies;
  crew_.loop(chunks, [&](std::size_t chunk) {
    const std::size_t end = std::min(bodies.size(), (chunk + 1) * kBodies);
    for (std::size_t i = chunk * kBodies; i < end; ++i) visit(body(bodies[i]));
  });
}

}  // namespace shatterbox::dynamics
