#include "engine/body/body.h"

#include <algorithm>

namespace shatterbox::body {
namespace {

template <class Bodies>
auto* find_in(Bodies& bodies, BodyId id) {
  const auto place =
      std::lower_bound(bodies.begin(), bodies.end(), id, [](const Body& b, BodyId i) { return b.id < i; });
  return place != bodies.end() && place->id == id ? &*place : nullptr;
}

}  // namespace

Mat3 Body::inverse_inertia_world() const {
  const Mat3 r = pose.rotation.toRotationMatrix();
  if (is_dynamic() && locked.any()) return locked.invert(r * shape->inertia * r.transpose());
  return r * inverse_inertia * r.transpose();
}

double Body::mobility(const Vec3& point_body, const Vec3& direction_body) const {
  if (!is_dynamic()) return 0.0;
  const Vec3 turn = point_body.cross(direction_body);
  if (!locked.any()) return inverse_mass + turn.dot(inverse_inertia * turn);
  const Vec3 turn_world = pose.rotation * turn;
  return inverse_mass * locked.share_along(pose.rotation * direction_body) +
         turn_world.dot(inverse_inertia_world() * turn_world);
}

void Body::push(const Vec3& impulse, const Vec3& point_world) {
  if (!is_dynamic()) return;
  velocity += locked.let_move(inverse_mass * impulse);
  angular_velocity += inverse_inertia_world() * (point_world - pose.translation).cross(impulse);
}

void Body::wake() {
  is_awake = true;
  quiet_time = 0.0;
}

double kinetic_energy(const Body& body) {
  if (!body.is_dynamic()) return 0.0;
  const Vec3 spin_body = body.pose.rotation.conjugate() * body.angular_velocity;
  return 0.5 * body.shape->mass * body.velocity.squaredNorm() +
         0.5 * spin_body.dot(body.shape->inertia * spin_body);
}

Vec3 angular_momentum(const Body& body) {
  if (!body.is_dynamic()) return Vec3::Zero();
  const Vec3 spin_body = body.pose.rotation.conjugate() * body.angular_velocity;
  return body.shape->mass * body.pose.translation.cross(body.velocity) +
         body.pose.rotation * (body.shape->inertia * spin_body);
}

Body* find_body(std::vector<Body>& bodies, BodyId id) {
  return find_in(bodies, id);
}
const Body* find_body(std::span<const Body> bodies, BodyId id) {
  return find_in(bodies, id);
}

}  // namespace shatterbox::body
