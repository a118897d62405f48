// An island's sweeps over its contacts: gaps before the drift, what closes after it.
#include <algorithm>

#include "engine/core/stop.h"
#include "engine/dynamics/island_solver.h"

namespace shatterbox::dynamics {

using core::at;

void IslandSolver::start_warm(double share) {
  for (const int i : island_.contacts) {
    SolverContact& c = work_.contacts[at(i)];
    // What has come apart, or bounced, must not be pushed by what it weighed before.
    if (may_strike_on_ && c.is_arriving && !is_before_drift_) continue;
    if (c.warm[0] > 0.0 && c.slack <= kTouching * c.kept_gap)
      apply(c, share * settings_.warm_start * c.warm, relative_velocity(c));
  }
}

// Sweeps alone carry a heavy body on light ones only after as many of them as the masses differ. Where
// plain ones do not end it, they go on to and fro as nonlinear conjugate gradients: what two sweeps
// changed is the negative gradient, and a share of the way so far is gone once more, until the changes
// grow. Only loads on something solid ask for it: a surface that is jammed between others would be pressed
// harder by every sweep and be no stiller.
void IslandSolver::begin_course() {
  course_square_ = 0.0;
  course_.assign(island_.contacts.size(), Vec3::Zero());
}

void IslandSolver::note_impulses() {
  before_sweep_.resize(island_.contacts.size());
  for (std::size_t k = 0; k < island_.contacts.size(); ++k) before_sweep_[k] = contact(k).impulse;
}

Vec3 IslandSolver::within_cone(const SolverContact& c, Vec3 impulse) {
  impulse[0] = std::max(impulse[0], 0.0);
  const double bound = c.friction * impulse[0], length = impulse.tail<2>().norm();
  if (length > bound) impulse.tail<2>() *= bound / length;
  return impulse;
}

void IslandSolver::go_on_course() {
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

template <class Visit>
void IslandSolver::sweep(const Sweeps& how, const Visit& visit_contact) {
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
// they leave the next substep finds, which starts from their impulses.
int IslandSolver::most_sweeps(int of_small) const {
  const auto affordable = static_cast<int>(kVisits / (island_.contacts.size() + 1));
  return std::clamp(affordable, kFewSweeps, of_small);
}

// One sweep is mostly enough at rest; what arrives must not overshoot the gap.
void IslandSolver::sweep_before_drift() {
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

void IslandSolver::sweep_after_drift() {
  sweep({most_sweeps(8), kResting, kLooseRest, kResting}, [&](std::size_t k, SolverContact& c) {
    if (is_still(k, c, kResting * c.threshold) || !is_touching(c)) return 0.0;
    const double found = visit(c, 0.0);
    see(k, c);
    return found / c.threshold;
  });
}

}  // namespace shatterbox::dynamics
