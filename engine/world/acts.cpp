#include "engine/world/acts.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/parallel.h"

namespace shatterbox::world {

namespace {

void give(body::Body& body, const Vec3& impulse, const Vec3& point) {
  if (!body.is_dynamic()) return;
  body.push(impulse, point);
  body.wake();
}

/// m: from a point to the nearest vertex of a mesh, or to the middle of another body.
double distance_to(const body::Body& body, const Vec3& point) {
  const Vec3 here = body.pose.apply_inverse(point);
  double least = here.norm();
  for (const Vec3& p : body.shape->surface.positions) least = std::min(least, (p - here).norm());
  return least;
}

}  // namespace

void apply_blast(std::vector<body::Body>& bodies, const dynamics::Blast& blast, body::ImpulseLog& log) {
  std::vector<std::vector<dynamics::BlastPatch>> patches(bodies.size());
  {
    const dynamics::LineOfSight sight(bodies);
    core::parallel_for(bodies.size(), 1, [&](std::size_t i) {
      const bool can_feel = bodies[i].is_dynamic() || body::is_mesh(bodies[i].shape->kind);
      if (can_feel) patches[i] = dynamics::find_blast_patches(blast, bodies[i], sight);
    });
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    body::Body& body = bodies[i];
    for (const dynamics::BlastPatch& patch : patches[i]) {
      if (!(patch.impulse.squaredNorm() > 0.0)) continue;
      const Vec3 normal = patch.impulse.normalized();
      body::LoggedImpulse entry = body::log_impulse(body::ImpulseKind::collision, body.id, body.pose, 0,
                                                    Pose{}, patch.point, normal, patch.impulse);
      entry.duration = patch.duration;
      entry.spread = core::sqrt(patch.area / core::kPi);
      log.push_back(entry);
      give(body, patch.impulse, patch.point);
    }
  }
}

void apply_hands(std::vector<body::Body>& bodies, const std::vector<dynamics::Hand>& hands,
                 const Vec3& gravity, double time_step, double time_left, body::ImpulseLog& log) {
  for (dynamics::Hand hand : hands) {
    hand.place -= time_left * hand.velocity;
    body::Body* body = body::find_body(bodies, hand.body);
    if (body == nullptr || !body->is_dynamic()) continue;
    const dynamics::HandPush push =
        dynamics::drive_by_hand(*body, hand, body->free_acceleration(gravity), time_step);
    give(*body, push.impulse, push.point);
    body->angular_velocity += body->inverse_inertia_world() * push.angular_impulse;
    if (!(push.impulse.squaredNorm() > 0.0)) continue;
    log.push_back(body::log_impulse(body::ImpulseKind::contact, body->id, body->pose, 0, Pose{}, push.point,
                                    push.impulse.normalized(), push.impulse));
  }
}

const body::Body* find_nearest(const std::vector<body::BodyId>& ids, const std::vector<body::Body>& bodies,
                               const Vec3& point) {
  const body::Body* nearest = nullptr;
  double least = 1e300;
  for (const body::BodyId id : ids) {
    const body::Body* body = body::find_body(bodies, id);
    if (body == nullptr) continue;
    const double distance = distance_to(*body, point);
    if (distance >= least) continue;
    least = distance;
    nearest = body;
  }
  return nearest;
}

void regrip(std::vector<dynamics::Hand>& hands, const body::Body& parent,
            const std::vector<body::BodyId>& born, const std::vector<body::Body>& bodies) {
  for (dynamics::Hand& hand : hands) {
    if (hand.body != parent.id) continue;
    const Vec3 grip = parent.pose.apply(hand.grip);
    const body::Body* piece = find_nearest(born, bodies, grip);
    if (piece == nullptr) continue;
    hand.body = piece->id;
    hand.grip = piece->pose.apply_inverse(grip);
  }
}

}  // namespace shatterbox::world
