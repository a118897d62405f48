#include "engine/dynamics/step_motion.h"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.h"
#include "engine/dynamics/contact_solver.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/rest.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::ImpulseKind;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

void log_contacts(const std::vector<Body>& bodies, const MotionWork& work, body::ImpulseLog& log) {
  std::vector<char> pair_collides(work.pairs.size(), 0);
  for (const SolverContact& c : work.contacts) {
    if (c.closing_speed > c.threshold && !c.was_loaded) pair_collides[at(c.pair)] = 1;
  }
  for (const SolverContact& c : work.contacts) {
    if (c.total.squaredNorm() == 0.0) continue;
    body::LoggedImpulse entry;
    entry.kind = pair_collides[at(c.pair)] && !c.was_loaded ? ImpulseKind::collision : ImpulseKind::contact;
    entry.body_a = bodies[at(c.a)].id;
    entry.body_b = bodies[at(c.b)].id;
    entry.point_world = c.moment_weight > 0.0 ? Vec3(c.moment_point / c.moment_weight) : c.point;
    if (c.moment_weight > 0.0) {
      entry.point_a = c.moment_a / c.moment_weight;
      entry.point_b = c.moment_b / c.moment_weight;
    } else {
      entry.point_a = bodies[at(c.a)].pose.apply_inverse(c.point);
      entry.point_b = bodies[at(c.b)].pose.apply_inverse(c.point);
    }
    entry.impulse_a = c.impulse_a;
    entry.impulse_b = c.impulse_b;
    entry.normal_world = c.normal;
    entry.impulse_world = c.total;
    if (entry.kind == ImpulseKind::collision) {
      entry.closing_speed = c.closing_speed;
      entry.time = c.arrival_time;
    }
    entry.effective_mass = c.effective_mass > 0.0 ? c.effective_mass : c.weights[0];
    log.push_back(entry);
  }
  log.insert(log.end(), work.continuous_log.begin(), work.continuous_log.end());
}

void remember_contacts(const MotionWork& work, ContactState& state) {
  for (const WorkPair& pair : work.pairs) {
    PairState& memory = state.pairs[at(pair.state)];
    memory.contacts.clear();
    memory.is_touching = false;
    memory.trouble_age = std::min(memory.trouble_age + 1, kNoTrouble);
    const WorkBody &a = work.bodies[at(pair.a)], &b = work.bodies[at(pair.b)];
    memory.list_margin -= motion_bound(a, a.end, b, b.end);
    // A sleeper and what lies on it quietly keep their memory through its sleep.
    if (a.inverse_mass == 0.0 && b.inverse_mass == 0.0) {
      for (const auto& c : pair.contacts)
        memory.is_touching = memory.is_touching || c.gap <= 2.0 * pair.kept_gap;
    }
  }
  for (const SolverContact& c : work.contacts) {
    PairState& memory = state.pairs[at(work.pairs[at(c.pair)].state)];
    const bool is_loaded = c.total.squaredNorm() > 0.0;
    memory.is_touching = memory.is_touching || is_loaded || c.slack <= c.kept_gap;
    memory.contacts.push_back(
        {c.key, c.warm[0], c.warm[1] * c.tangent_u + c.warm[2] * c.tangent_v, c.arrival_speed, is_loaded});
  }
}

void report_contacts(const MotionWork& work, ContactReport& report) {
  report.solver_contacts = static_cast<int>(work.contacts.size());
  for (const SolverContact& c : work.contacts) {
    if (c.slack > c.kept_gap) continue;
    ++report.contacts;
    report.least_gap = std::min(report.least_gap, c.slack + c.kept_gap);
    if (c.impulse[0] <= 0.0) continue;
    const WorkBody &a = work.bodies[at(c.a)], &b = work.bodies[at(c.b)];
    const Vec3 u = a.velocity + a.spin.cross(c.arm_a) - b.velocity - b.spin.cross(c.arm_b);
    report.residual = std::max(report.residual, -c.normal.dot(u));
  }
  for (const WorkBody& b : work.bodies) report.awake_bodies += b.is_active && b.inverse_mass > 0.0 ? 1 : 0;
  report.failsafe_steps = work.failsafe_bodies;
  if (report.awake_bodies > 0)
    report.frozen_share = static_cast<double>(work.failsafe_bodies) / report.awake_bodies;
}

}  // namespace

void solve_motion(const std::vector<Body>& bodies, const ContactSettings& settings, MotionWork& work) {
  core::parallel_for(work.islands.size(), 1,
                     [&](std::size_t i) { solve_island(settings, work.islands[i], work); });
  for (std::size_t i = 0; i < work.bodies.size(); ++i) {
    WorkBody& w = work.bodies[i];
    if (!w.is_active) continue;
    if (w.is_free) {
      w.end = w.predicted;
      if (!bodies[i].is_dynamic()) continue;
      w.velocity += settings.time_step * w.gravity;
      w.spin = w.predicted_spin;
    } else {
      w.end.translation = w.start.translation + w.way;
      w.end.rotation = w.rotation;
    }
  }
}

void finish_motion(std::vector<Body>& bodies, ContactState& state, MotionWork& work, body::ImpulseLog& log,
                   ContactReport& report) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const WorkBody& w = work.bodies[i];
    if (!w.is_active) continue;
    bodies[i].pose = w.end;
    state.bodies[i].last_pose = w.end;
    if (!bodies[i].is_dynamic()) continue;
    bodies[i].velocity = w.velocity;
    bodies[i].angular_velocity = w.spin;
  }
  log_contacts(bodies, work, log);
  remember_contacts(work, state);
  report_contacts(work, report);
}

ContactReport step_motion(std::vector<Body>& bodies, const ContactSettings& settings, ContactState& state,
                          body::ImpulseLog& log) {
  ContactReport report;
  MotionWork work;
  wake_bodies(bodies, settings, state);
  find_candidate_pairs(bodies, settings, state, work);
  // What wakes may touch further sleepers, which its island's memory already wakes with it: few rounds, each
  // wakes more.
  while (!work.to_wake.empty()) {
    for (const body::BodyId id : work.to_wake) {
      Body* sleeper = body::find_body(bodies, id);
      wake_island(bodies, state, *sleeper);
    }
    find_candidate_pairs(bodies, settings, state, work);
  }
  solve_motion(bodies, settings, work);
  find_missed_pairs(bodies, settings, state, work);
  guard_motion(settings, state, work, report);
  finish_motion(bodies, state, work, log, report);
  return report;
}

}  // namespace shatterbox::dynamics
