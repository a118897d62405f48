// An island's sweeps over its contacts: gaps before the drift, what closes after it.
#include <algorithm>

#include "engine/core/stop.h"
#include "engine/dynamics/island_solver.h"

namespace shatterbox::dynamics {

using core::at;

// What is left out of the last impulses stills what sways, but must be found again: few sweeps of many
// contacts do not find it in time.
void IslandSolver::start_warm(double share) {
  if (is_wary_) return;
  const double warm = is_calmed_well() ? settings_.warm_start : std::max(settings_.warm_start, kWarmest);
  in_turn([&](std::size_t, SolverContact& c, Found&) {
    // What has come apart, or bounced, must not be pushed by what it weighed before.
    if (may_strike_on_ && c.is_arriving && !is_before_drift_) return;
    if (c.warm[0] > 0.0 && c.slack <= kTouching * c.kept_gap)
      apply(c, share * warm * c.warm, relative_velocity(c));
  });
}

// Where friction presses its own contact harder than it is pressed (a slender body that slides on its tip:
// Painleve's paradox), every sweep asks the next for more. Bounded by what bears now it can run away no more:
// that problem is convex, and each visit takes energy. What jams so stops sliding.
void IslandSolver::bound_friction() {
  for (std::size_t k = 0; k < order_.contacts.size(); ++k) contact(k).jammed_at = contact(k).impulse[0];
}

// Gauss-Seidel sweeps alone need as many rounds to carry a heavy body on light ones as its mass is times
// theirs. Where plain ones do not end it, symmetric sweeps (there and back) precondition nonlinear conjugate
// gradients (Fletcher and Reeves): what such a sweep changes in the impulses is the preconditioned negative
// gradient g, the next search direction is g + beta times the last one, beta = |g|^2 over that of the sweep
// before, and 0, a restart, where the gradient has grown. Only loads on something solid ask for it: a surface
// that is jammed between others would be pressed harder by every sweep and be no stiller.
void IslandSolver::begin_conjugate_steps() {
  gradient_square_ = 0.0;
  search_direction_.assign(order_.contacts.size(), Vec3::Zero());
}

void IslandSolver::note_impulses() {
  before_sweep_.resize(order_.contacts.size());
  for (std::size_t k = 0; k < order_.contacts.size(); ++k) before_sweep_[k] = contact(k).impulse;
}

Vec3 IslandSolver::within_cone(const SolverContact& c, Vec3 impulse) {
  impulse[0] = std::max(impulse[0], 0.0);
  const double bound = friction_bound(c, impulse[0]), length = impulse.tail<2>().norm();
  if (length > bound) impulse.tail<2>() *= bound / length;
  return impulse;
}

void IslandSolver::take_conjugate_step() {
  double square = 0.0;
  for (std::size_t k = 0; k < order_.contacts.size(); ++k)
    square += (contact(k).impulse - before_sweep_[k]).squaredNorm();
  const double beta = square < gradient_square_ ? square / gradient_square_ : 0.0;
  gradient_square_ = square;
  for (std::size_t k = 0; k < order_.contacts.size(); ++k) {
    SolverContact& c = contact(k);
    const Vec3 change = c.impulse - before_sweep_[k];
    const Vec3 extra = within_cone(c, c.impulse + beta * search_direction_[k]) - c.impulse;
    search_direction_[k] = extra + change;
    if (extra.squaredNorm() > 0.0) apply(c, extra, relative_velocity(c));
  }
  forget_seen();
}

template <class Visit>
bool IslandSolver::sweep(const Sweeps& how, const Visit& visit_contact) {
  const std::size_t count = order_.contacts.size();
  const auto look = [&](std::size_t k, SolverContact& c, Found& found) {
    visit_contact(k, c, found);
    const double lasting = std::min(c.impulse[0], c.warm[0]);
    if ((c.has_sides && lasting > c.strained_from) || (c.is_close && c.impulse[0] > 0.0))
      found.has_strain = true;
  };
  const int most = how.plain + static_cast<int>(kConjugateSize * kConjugateSize / (count * count + 1));
  forget_seen();
  double least_excess = 1e300;
  int least_round = 0;
  bool is_any = false, is_bounded = false;
  for (int round = 0; round < most; ++round) {
    core::stop_if_asked();
    const bool is_conjugate = round >= how.plain;
    if (round == how.plain) begin_conjugate_steps();
    if (is_conjugate) note_impulses();
    Found found = in_turn(look);
    // So small an island is visited by one thread.
    for (std::size_t k = is_conjugate ? count : 0; k-- > 0;) look(k, contact(k), found);
    joints_.hold(is_before_drift_);
    is_any = is_any || found.is_any;
    if (count == 0) break;
    if (is_wary_ && round == 0) bound_friction();
    const double enough = round + 1 < how.plain ? how.enough : how.loose;
    if (found.excess < (found.has_strain ? how.tight : enough)) break;
    if (is_conjugate && !is_bounded && found.excess > kRunaway * least_excess) {
      bound_friction();
      is_bounded = true;
      least_excess = 1e300;
    }
    // What is jammed has no solution.
    if (found.excess < kProgress * least_excess) {
      least_excess = found.excess;
      least_round = round;
    } else if (round > least_round + conjugate_patience()) {
      break;
    }
    if (is_conjugate && round + 1 < most) take_conjugate_step();
  }
  return is_any;
}

double IslandSolver::target_before_drift(const SolverContact& c) const {
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
// they leave the next substep finds, which starts from their impulses. What met on its way and may break for
// it does not wait for that.
int IslandSolver::most_sweeps(int of_small) const {
  if (work_.is_solved_again && island_.may_break) return of_small;
  const auto affordable = static_cast<int>(kVisits / (order_.contacts.size() + 1));
  return std::clamp(affordable, kFewSweeps, of_small);
}

// Nothing bursts, and few sweeps end what moves.
bool IslandSolver::is_calmed_well() const {
  return !island_.may_break && order_.contacts.size() <= kFewAtRest;
}

// One sweep is mostly enough at rest, but what one leaves rocks a box on a slope by so much that its feet
// creep: small islands get some more. Shards have small gaps, and what one sweep leaves uses them up in a
// step: on the floor they would be hits, and kicked, in every one.
int IslandSolver::most_calm_sweeps() {
  if (!joints_.is_empty()) return most_sweeps(kJointSweeps);
  if (island_.may_break) return most_sweeps(kShardSweeps);
  return is_calmed_well() ? kCalmSweeps : 1;
}

// Shards under one that holds them fast rub to and fro, a thousandth of what closed, for hundreds of rounds.
int IslandSolver::conjugate_patience() const {
  if (has_scripted_) return kScriptedPatience;
  return island_.may_break ? kBreakablePatience : kConjugatePatience;
}

// What arrives must not overshoot the gap.
void IslandSolver::sweep_before_drift() {
  const auto hold = [&](std::size_t k, SolverContact& c, Found& found) {
    const double tolerance = kTouching * c.kept_gap / step_;
    if (is_still(k, c, tolerance)) return;
    const double pressed = c.impulse[0];
    const double closing = visit(c, target_before_drift(c));
    see(k, c);
    const bool is_pushed_apart = c.impulse[0] < pressed && closing > tolerance;
    found.is_any = found.is_any || is_pushed_apart;
    found.excess = std::max(found.excess, closing / tolerance);
  };
  const Sweeps how = has_arrivals_ ? Sweeps{most_sweeps(16), 1.0, 1e300, kStrainedGap}
                                   : Sweeps{most_calm_sweeps(), kCalmGap, 1e300, kStrainedGap};
  bool is_pushed_apart = sweep(how, hold);
  // What came free must not be thrown by what wedged it. To press on would only strain what is wedged
  // still.
  for (int round = 1; is_pushed_apart && !has_arrivals_ && round < most_sweeps(16); ++round) {
    is_pushed_apart = in_turn(hold).is_any;
    joints_.hold(is_before_drift_);
  }
}

void IslandSolver::sweep_after_drift() {
  sweep({most_sweeps(8), kResting, kLooseRest, kResting}, [&](std::size_t k, SolverContact& c, Found& found) {
    if (is_still(k, c, kResting * c.threshold) || !is_touching(c)) return;
    found.excess = std::max(found.excess, visit(c, 0.0) / c.threshold);
    see(k, c);
  });
}

}  // namespace shatterbox::dynamics
