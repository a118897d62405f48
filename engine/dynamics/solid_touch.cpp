#include "engine/dynamics/solid_touch.h"

#include <algorithm>
#include <cmath>

#include "engine/collision/analytic_contact.h"

namespace shatterbox::dynamics {
namespace {

using body::ShapeKind;
using collision::Contact;

Pose pose_on_path(const WorkBody& w, const Pose& end, double time) {
  if (!w.is_active) return w.start;
  Pose pose;
  pose.translation = w.start.translation + time * (end.translation - w.start.translation);
  const Quat& p = w.start.rotation;
  const double sign = p.dot(end.rotation) < 0.0 ? -1.0 : 1.0;
  const Quat::Coefficients mixed = (1.0 - time) * p.coeffs() + time * sign * end.rotation.coeffs();
  pose.rotation = Quat(mixed).normalized();
  return pose;
}

}  // namespace

SolidTouch find_first_touch(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b,
                            double least, double margin) {
  const bool a_turns = a.shape->kind == ShapeKind::box, b_turns = b.shape->kind == ShapeKind::box;
  // The turn of a blend of two rotations is nowhere faster than twice its mean.
  const double turning =
      2.0 * ((a_turns ? turn_bound(a, end_a) : 0.0) + (b_turns ? turn_bound(b, end_b) : 0.0));
  const Vec3 way = (end_a.translation - a.start.translation) - (end_b.translation - b.start.translation);
  const double close_enough = 0.02 * margin;
  SolidTouch result;
  double time = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Pose pose_a = pose_on_path(a, end_a, time), pose_b = pose_on_path(b, end_b, time);
    Vec3 normal;
    const double gap = collision::analytic_gap(*a.shape, pose_a, *b.shape, pose_b, normal);
    const double closing = std::max(0.0, -normal.dot(way)) + turning;
    const double room = gap - least;
    if (closing * (1.0 - time) < room) return result;
    if (room <= close_enough || i == 199) {
      collision::find_analytic_contacts(*a.shape, pose_a, *b.shape, pose_b, margin, result.contacts);
      for (Contact& c : result.contacts) {
        c.on_a = carry(a, c.on_a, pose_a, a.start);
        c.on_b = carry(b, c.on_b, pose_b, b.start);
        c.gap = c.normal.dot(c.on_a - c.on_b);
        c.is_time_of_impact = true;
      }
      result.time = time;
      return result;
    }
    time += 0.999 * room / closing;
  }
  return result;
}

}  // namespace shatterbox::dynamics
