// What arrives in an island, bounces, and strikes on.
#include <algorithm>
#include <cmath>

#include "engine/core/stop.h"
#include "engine/dynamics/island_solver.h"

namespace shatterbox::dynamics {

using core::at;

// What closes within this substep, and how fast it will be when it touches. From the energy at the
// substep's start: gravity's share of the way down is in it, whatever the part of the substep.
void IslandSolver::find_arrivals() {
  const Found arrivals = each([&](std::size_t, SolverContact& c, Found& found) {
    c.impulse.setZero();
    c.rolling_impulse.setZero();
    c.is_arriving = false;
    c.jammed_at = -1.0;
    c.was_apart = !is_touching(c);
    pair_work_[at(c.row)] = 0.0;
    const double drive = c.normal.dot(body(c.a).gravity - body(c.b).gravity);
    const double after_kick = relative_velocity(c)[0];
    const double before = after_kick - 0.5 * drive * step_;
    const double way = std::max(0.0, c.slack);
    if (after_kick >= 0.0 || way + after_kick * step_ > kTouching * c.kept_gap) return;
    const double speed_squared = before * std::abs(before) + 2.0 * drive * way;  // closing is negative
    if (speed_squared >= 0.0) return;
    const double speed = std::sqrt(-speed_squared);
    if (speed <= c.threshold) return;
    arrive(c, speed, part_start_ + std::min(step_, way / -after_kick));
    found.is_any = true;
  });
  has_arrivals_ = arrivals.is_any;
}

// Normals and arms turn on the way: what did not seem to arrive in this part may have all the same. It has
// come from beyond the kept gap: what is opened, or lies in each other by rounding, does not bounce.
void IslandSolver::find_late_arrivals() {
  const Found late = each([&](std::size_t, SolverContact& c, Found& found) {
    if (!c.was_apart || c.is_arriving || c.impulse[0] > 0.0 || !is_touching(c)) return;
    const double speed = -relative_velocity(c)[0];
    if (speed <= c.threshold || speed * step_ <= c.kept_gap) return;
    arrive(c, speed, part_start_ + step_);
    found.is_any = true;
  });
  has_arrivals_ = has_arrivals_ || late.is_any;
}

void IslandSolver::arrive(SolverContact& c, double speed, double time) {
  c.is_arriving = true;
  c.arrival_speed = std::max(c.arrival_speed, speed);
  if (c.closing_speed == 0.0) c.arrival_time = time;
  if (speed > c.closing_speed) {
    respond(c);
    c.closing_speed = speed;
    c.effective_mass = c.weights[0];
  }
}

// A hit runs on through what touches, as [GBF03] has it, collision by collision: what arrives bounces, and
// who is driven by that into what he touches bounces off it next. A ball that hits a row sends the last one
// off.
void IslandSolver::strike() {
  for (int round = 0; round < kMostStrikes; ++round) {
    core::stop_if_asked();
    struck_.clear();
    for (std::size_t k = 0; k < order_.contacts.size(); ++k) {
      SolverContact& c = contact(k);
      double speed = c.arrival_speed;
      if (round == 0) {
        if (!c.is_arriving || !is_touching(c)) continue;
        // Arms turn on the way: what counts is how fast it closes now, and what it was stopped by.
        if (ends_with_arrival_) {
          respond(c);
          speed = std::max(0.0, c.impulse[0] * c.response(0, 0) - relative_velocity(c)[0]);
        }
      } else {
        if (c.slack > kStruck * c.kept_gap) continue;
        speed = -relative_velocity(c)[0];
        if (c.restitution * speed <= c.threshold) continue;
      }
      c.target = c.restitution * speed;
      struck_.push_back(k);
    }
    if (struck_.empty()) return;
    if (round > 0) leave_softer();
    for (const std::size_t k : struck_) {
      contact(k).is_arriving = true;  // though it stays a contact, to those who judge what it bears
      joints_.feel_blow(contact(k), contact(k).impulse);
      keep_impulse(contact(k));
      contact(k).impulse.setZero();
    }
    hardest_first();
    bounce_together();
    joints_.hold(false);
    for (const std::size_t k : struck_) {
      joints_.feel_blow(contact(k), contact(k).impulse);
      keep_impulse(contact(k));
      contact(k).impulse.setZero();
      contact(k).arrival_speed = 0.0;
    }
  }
}

// Balls of a row drift: in one round with the hit that runs through it they would share its blow.
void IslandSolver::leave_softer() {
  double most = 0.0;
  for (const std::size_t k : struck_) most = std::max(most, contact(k).target);
  std::erase_if(struck_, [&](std::size_t k) { return contact(k).target < kAlike * most; });
}

// Friction's answer depends on who is asked first: that must not be who has the lower number, nor rounding.
void IslandSolver::hardest_first() {
  double most = 0.0;
  for (const std::size_t k : struck_) most = std::max(most, contact(k).target);
  if (!(most > 0.0)) return;
  const auto rank = [&](std::size_t k) { return std::floor(kRanks * contact(k).target / most + 0.5); };
  std::stable_sort(struck_.begin(), struck_.end(),
                   [&](std::size_t x, std::size_t y) { return rank(x) > rank(y); });
}

void IslandSolver::bounce_together() {
  const int most = most_sweeps(40);
  for (int sweep = 0; sweep < most; ++sweep) {
    double excess = 0.0;
    for (const std::size_t k : struck_)
      excess = std::max(excess, visit_bounce(contact(k)) / std::max(contact(k).target, contact(k).threshold));
    if (excess < kBounced) return;
  }
}

// Newton's rule with the speed before the impact; the pair's impulses of this substep may not do work in
// sum.
void IslandSolver::bounce() {
  const Found due = each([&](std::size_t, SolverContact& c, Found& found) {
    c.target = 0.0;
    if (c.arrival_speed <= 0.0 || !is_touching(c)) return;
    if (c.impulse[0] <= 0.0 && !c.is_arriving) {  // turned away by others before it touched
      c.arrival_speed = 0.0;
      return;
    }
    c.target = c.restitution * c.arrival_speed;
    found.is_any = true;
  });
  if (!due.is_any) return;
  const int most = most_sweeps(40);
  for (int sweep = 0; sweep < most; ++sweep) {
    core::stop_if_asked();
    const Found left = in_turn([&](std::size_t k, SolverContact& c, Found& found) {
      const double speed = std::max(c.target, c.threshold);
      const bool must_bounce = sweep == 0 && c.target > 0.0;
      if ((!must_bounce && is_still(k, c, kBounced * speed)) || !is_touching(c)) return;
      const double change = c.target > 0.0 ? visit_bounce(c) : visit(c, 0.0);
      see(k, c);
      found.excess = std::max(found.excess, change / speed);
    });
    joints_.hold(is_before_drift_);
    if (left.excess < kBounced) break;
  }
  each([](std::size_t, SolverContact& c, Found&) {
    if (is_touching(c)) c.arrival_speed = 0.0;
  });
}

}  // namespace shatterbox::dynamics
