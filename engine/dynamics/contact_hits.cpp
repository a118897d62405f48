// What of a contact's impulses came by a hit. A verdict divides a hit's impulse by the hit's own duration,
// and takes what stands behind the body from it (impulse by closing speed). What presses on after the hit
// must not be in it: a step of a sixtieth has time for many times as much of that as one of a thousandth.
#include "engine/dynamics/island_solver.h"

namespace shatterbox::dynamics {
namespace {

// s, from a pair's arrival: what its contacts give in that time is the hit's. Bodies that stand behind the
// one that is struck, a gap away, have a say in it then, and what only presses has not come to much.
constexpr double kHitLasts = 1.0 / 480.0;

}  // namespace

void GivenImpulse::add(const GivenImpulse& more) {
  impulse_a += more.impulse_a;
  impulse_b += more.impulse_b;
  moment_point += more.moment_point;
  moment_a += more.moment_a;
  moment_b += more.moment_b;
  moment_weight += more.moment_weight;
}

// A substep starts with nothing given. What has arrived and not bounced yet is hit when it does.
void IslandSolver::begin_hits(bool is_first) {
  if (is_first) borne_.assign(order_.contacts.size(), {});
  each([&](std::size_t k, SolverContact& c, Found&) {
    Borne& borne = borne_[k];
    if (is_first) {
      c.tells_hits = true;
      c.hit_left = c.hit_left_before;
      borne.is_resting = c.was_loaded && c.hit_left == 0.0;
    }
    if (c.arrival_speed > 0.0) return;
    borne.closing_speed = std::max(borne.closing_speed, c.closing_speed);
    c.closing_speed = c.arrival_time = c.effective_mass = 0.0;
  });
}

// How long the hits of pairs go on, from this substep's start: an arrival begins one, unless it is at a
// contact that bore already.
void IslandSolver::find_hit_pairs() {
  hit_left_.assign(order_.contacts.size(), 0.0);
  for (std::size_t k = 0; k < order_.contacts.size(); ++k) {
    const SolverContact& c = contact(k);
    const bool arrives = c.closing_speed > c.threshold && !borne_[k].is_resting;
    double& left = hit_left_[core::at(c.row)];
    left = std::max(left, arrives ? kHitLasts : c.hit_left);
  }
}

void IslandSolver::book_hits() {
  find_hit_pairs();
  each([&](std::size_t k, SolverContact& c, Found&) {
    Borne& borne = borne_[k];
    const bool is_loaded = c.given.is_any();
    const double left = borne.is_resting ? 0.0 : hit_left_[core::at(c.row)];
    const bool goes_on = c.hit_left > 0.0 && left < kHitLasts && !c.hits.empty();
    borne.total += c.total;
    if (!(left > 0.0)) {
      borne.given.add(c.given);
    } else if (is_loaded && goes_on) {
      c.hits.back().total += c.total;
      c.hits.back().given.add(c.given);
    } else if (is_loaded) {
      c.hits.push_back({c.total, c.given, c.closing_speed, c.arrival_time, c.effective_mass});
    }
    c.hit_left = left - substep_ > 0.5 * substep_ ? left - substep_ : 0.0;
    if (c.hit_left == 0.0) borne.is_resting = is_loaded;
    c.total.setZero();
    c.given = {};
  });
}

void IslandSolver::end_hits() {
  each([&](std::size_t k, SolverContact& c, Found&) {
    c.total = borne_[k].total;
    c.given = borne_[k].given;
    c.closing_speed = std::max(c.closing_speed, borne_[k].closing_speed);
  });
}

}  // namespace shatterbox::dynamics
