#include "engine/dynamics/motion_work.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::dynamics {

void place_at(const WorkBody& body, const Pose& pose, std::vector<Vec3>& out) {
  const Mat3 r = pose.rotation.toRotationMatrix();
  const auto& vertices = body.collider->vertices;
  out.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) out[i] = r * vertices[i] + pose.translation;
}

void place(WorkBody& body) {
  if (body.is_placed) return;
  body.placed.collider = body.collider;
  place_at(body, body.start, body.placed.start);
  body.is_placed = true;
}

Vec3 carry(const WorkBody& body, const Vec3& point, const Pose& from, const Pose& to) {
  if (body.shape->kind == body::ShapeKind::sphere) return point - from.translation + to.translation;
  return to.apply(from.apply_inverse(point));
}

double turn_bound(const WorkBody& body, const Pose& end) {
  // |q - p| of unit quaternions is 2 sin(theta / 4); the chord of a point at `reach` is 2 sin(theta / 2)
  // reach.
  const Quat& p = body.start.rotation;
  const Quat& q = end.rotation;
  const double apart = std::min((p.coeffs() - q.coeffs()).norm(), (p.coeffs() + q.coeffs()).norm());
  return std::min(2.0, 2.0 * apart) * body.reach;
}

double motion_bound(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b) {
  const Vec3 way = (end_a.translation - a.start.translation) - (end_b.translation - b.start.translation);
  return way.norm() + turn_bound(a, end_a) + turn_bound(b, end_b);
}

}  // namespace shatterbox::dynamics
