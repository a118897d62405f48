#include "engine/dynamics/contact_place.h"

#include "engine/collision/analytic_contact.h"

namespace shatterbox::dynamics {
namespace {

using collision::Contact;
using collision::NormalOf;

// An arm whose contact lay in the direction `outwards`, and lies in `outwards_now`. What is radius does not
// turn.
Vec3 turned(const WorkBody& w, const Moved& moved, const Vec3& arm, const Vec3& outwards,
            const Vec3& outwards_now) {
  if (!body::is_round(w.shape->kind)) return moved.turn * arm;
  const Vec3 axial = arm - w.shape->radius * outwards;
  const bool is_sphere = w.shape->kind == body::ShapeKind::sphere;
  return (is_sphere ? axial : Vec3(moved.turn * axial)) + w.shape->radius * outwards_now;
}

Pose pose_after(const WorkBody& w, const Moved& moved) {
  if (w.shape->kind == body::ShapeKind::sphere) return {w.start.rotation, w.start.translation + moved.way};
  return {Quat(moved.turn) * w.start.rotation, w.start.translation + moved.way};
}

// The tangent turns as little as it must.
void set_axes(SolverContact& c, const Vec3& normal) {
  const double along = 1.0 + normal.dot(c.found.normal);
  c.normal = normal;
  c.tangent_u = c.tangent_start;
  if (along > 1e-9) c.tangent_u -= normal.dot(c.tangent_start) / along * (c.found.normal + normal);
  c.tangent_v = normal.cross(c.tangent_u);
}

}  // namespace

PlacedContact place_contact(const WorkBody& a, const Moved& moved_a, const WorkBody& b, const Moved& moved_b,
                            const Contact& found) {
  PlacedContact now;
  if (found.normal_of == NormalOf::ball) {
    const Pose pose_a = pose_after(a, moved_a), pose_b = pose_after(b, moved_b);
    const Contact c = collision::find_ball_contact(*a.shape, pose_a, *b.shape, pose_b);
    return {c.on_a - pose_a.translation, c.on_b - pose_b.translation, c.normal, c.gap};
  }
  const Vec3 start_a = found.on_a - a.start.translation, start_b = found.on_b - b.start.translation;
  now.normal = collision::turned_normal(found, moved_a.turn, moved_b.turn);
  now.arm_a = turned(a, moved_a, start_a, -found.normal, -now.normal);
  now.arm_b = turned(b, moved_b, start_b, found.normal, now.normal);
  const Vec3 change = (moved_a.way - moved_b.way) + (now.arm_a - start_a) - (now.arm_b - start_b);
  now.gap = found.gap + now.normal.dot(change) + (now.normal - found.normal).dot(found.on_a - found.on_b);
  return now;
}

void reset_axes(SolverContact& c) {
  set_axes(c, c.found.normal);
}

void turn_axes(SolverContact& c, const Vec3& normal) {
  if (normal == c.normal) return;
  const Vec3 given = c.impulse[0] * c.normal + c.impulse[1] * c.tangent_u + c.impulse[2] * c.tangent_v;
  set_axes(c, normal);
  c.impulse = {given.dot(c.normal), given.dot(c.tangent_u), given.dot(c.tangent_v)};
}

}  // namespace shatterbox::dynamics
