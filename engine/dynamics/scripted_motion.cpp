#include "engine/dynamics/scripted_motion.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;

constexpr double kWait = 1.0 / 60.0;  // s, after it was held up
constexpr double kLeastPace = 0.02;   // with which it comes on then,
constexpr double kPaceKept = 0.5;     // or share of the one that it struck with,
constexpr double kPaceTime = 0.1;     // and s until it has its full pace again
constexpr double kBlowPace = 0.25;    // no less, then,
constexpr int kMostDoublings = 8;     // and twice as heavy each time, as what drives it pushes on
constexpr double kUnslowed = 0.5;     // of its speed: who lost no more was not stopped
constexpr double kOnPath = 1e-9;      // of size and place: what is so near its path is on it
constexpr double kRounding = 1e-12;   // of size and place: what is so near is there

void aim(Body& b, double time_step) {
  body::Script& script = b.script;
  const double from = script.time;
  script.time += time_step;
  b.velocity.setZero();
  b.angular_velocity.setZero();
  if (script.wait > 0.5 * time_step) {
    script.wait -= time_step;
    return;
  }
  const Pose goal = script.path->pose_at(script.time);
  const Vec3 way = goal.translation - b.pose.translation, turn = turn_between(b.pose.rotation, goal.rotation);
  const double reach = b.shape->bounding_radius;
  const double rounding = kRounding * (reach + goal.translation.norm());
  if (script.path->rests(from, script.time) && way.norm() + reach * turn.norm() <= rounding) {
    script.pace = 1.0;
    return;
  }
  // No faster than it ever is; so it does not jump to where it is to be when it is let go.
  const double most = (1.0 + 1e-9) * script.pace * time_step;
  double share = 1.0;
  if (way.norm() > most * script.path->top_speed())
    share = std::min(share, most * script.path->top_speed() / way.norm());
  if (turn.norm() > most * script.path->top_spin())
    share = std::min(share, most * script.path->top_spin() / turn.norm());
  if (way.norm() + reach * turn.norm() <= rounding) share = 1.0;
  b.velocity = way * (share / time_step);
  b.angular_velocity = turn * (share / time_step);
  if (script.pace >= 1.0) script.blows = 0;
  script.pace = std::min(1.0, script.pace + time_step / kPaceTime);
}

void be_held_up(body::Script& script, double pace) {
  script.wait = kWait;
  script.pace = std::max(pace, kLeastPace);
}

}  // namespace

void aim_scripted(std::vector<Body>& bodies, double time_step) {
  for (Body& b : bodies)
    if (b.motion == body::Motion::scripted && b.script.path) aim(b, time_step);
}

void plan_rides(const Body& b, double time_step, int substeps, WorkBody& w) {
  w.rides.assign(static_cast<std::size_t>(substeps), {});
  const double part = time_step / substeps;
  const body::ScriptedPath* path = b.script.path.get();
  const double before = b.script.time - time_step;
  const auto is_near = [&](const Pose& x, const Pose& y) {
    const double reach = b.shape->bounding_radius, apart = turn_between(x.rotation, y.rotation).norm();
    return (x.translation - y.translation).norm() + reach * apart <= kOnPath * (reach + x.translation.norm());
  };
  const bool is_on_path =
      path && is_near(w.start, path->pose_at(before)) && is_near(w.predicted, path->pose_at(b.script.time));
  Pose last = w.start;
  for (int k = 0; k < substeps; ++k) {
    const double time = part * (k + 1);
    Pose pose;
    if (k + 1 == substeps) {
      pose = w.predicted;
    } else if (is_on_path) {
      pose = path->pose_at(before + time);
    } else {
      pose.translation = w.start.translation + time * b.velocity;
      pose.rotation = (rotation_by(time * b.angular_velocity) * w.start.rotation).normalized();
    }
    WorkBody::Ride& ride = w.rides[static_cast<std::size_t>(k)];
    ride.velocity = (pose.translation - last.translation) / part;
    ride.spin = turn_between(last.rotation, pose.rotation) / part;
    ride.way = pose.translation - w.start.translation;
    ride.turn = pose.rotation * w.start.rotation.conjugate();
    last = pose;
  }
}

void hold_up(WorkBody& w, int substeps) {
  WorkBody::Ride halt;
  if (substeps > 0) {
    halt.way = w.rides[static_cast<std::size_t>(substeps - 1)].way;
    halt.turn = w.rides[static_cast<std::size_t>(substeps - 1)].turn;
  }
  w.end = w.start;
  w.turn_angle = 0.0;
  w.knots.assign(1, w.start);
  for (std::size_t k = 0; k < w.rides.size(); ++k) {
    if (static_cast<int>(k) >= substeps) {
      w.rides[k] = halt;
      continue;
    }
    w.turn_angle += w.rides[k].spin.norm() / static_cast<double>(w.rides.size());
    w.end.translation = w.start.translation + w.rides[k].way;
    w.end.rotation = (w.rides[k].turn * w.start.rotation).normalized();
    w.knots.push_back(w.end);
  }
  w.straight_parts = count_straight_parts(w.turn_angle);
  if (!turns_far(w)) w.knots.clear();
  w.gone = static_cast<double>(substeps) / static_cast<double>(w.rides.size());
  w.velocity.setZero();
  w.spin.setZero();
}

void end_scripted(const WorkBody& w, Body& b) {
  if (w.gone >= 1.0) return;
  b.velocity *= w.gone;
  b.angular_velocity *= w.gone;
  be_held_up(b.script, kLeastPace);
}

bool can_strike(const Body& b) {
  return b.is_driven() && !b.script.strikes && b.script.path && b.shape->mass > 0.0;
}

void begin_strike(Body& b) {
  const double weight = std::ldexp(1.0, std::min(b.script.blows, kMostDoublings));
  b.script.strikes = true;
  b.inverse_mass = 1.0 / (weight * b.shape->mass);
  b.inverse_inertia = b.shape->inertia.inverse() / weight;
  if (b.angular_velocity.isZero(0.0)) b.locked.turns.fill(true);
}

void end_blow(const WorkBody& w, Body& b) {
  if ((w.velocity - w.velocity_start).norm() <= kUnslowed * w.velocity_start.norm()) return;
  be_held_up(b.script, std::max(kBlowPace, kPaceKept * b.script.pace));
  ++b.script.blows;
}

void end_strikes(std::vector<Body>& bodies) {
  for (Body& b : bodies) {
    if (!b.script.strikes) continue;
    b.script.strikes = false;
    b.inverse_mass = 0.0;
    b.inverse_inertia.setZero();
    b.locked = {};
  }
}

void forget_blows(const std::vector<Body>& struck, std::vector<Body>& bodies) {
  for (const Body& b : struck)
    if (b.script.strikes) body::find_body(bodies, b.id)->script.blows = 0;
}

double distance_behind(const Body& b) {
  if (b.motion != body::Motion::scripted || !b.script.path) return 0.0;
  const Pose goal = b.script.path->pose_at(b.script.time);
  return (goal.translation - b.pose.translation).norm() +
         b.shape->bounding_radius * turn_between(b.pose.rotation, goal.rotation).norm();
}

}  // namespace shatterbox::dynamics
