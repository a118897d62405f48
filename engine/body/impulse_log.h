// Every impulse that a stage gives to a pair of bodies, for the stress, the report and the tests.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/body/body.h"

namespace shatterbox::body {

enum class ImpulseKind : std::uint8_t {
  collision,   // the pair closed faster than gravity and last step's drive explain, and did not touch before
  contact,     // everything else that pushes or rubs
  continuous,  // given by the continuous pass
  failsafe,    // given by the failsafe
  fracture,    // pays the energy of new crack area
};

struct LoggedImpulse {
  ImpulseKind kind = ImpulseKind::contact;
  BodyId body_a = 0;
  BodyId body_b = 0;                  // body_a gets `impulse`, body_b gets minus it
  Vec3 point_world = Vec3::Zero();    // m
  Vec3 normal_world = Vec3::Zero();   // unit, from b towards a
  Vec3 impulse_world = Vec3::Zero();  // N s, normal and friction together
  // The same as either body feels it, each in its own body space at the time of the impulse: pose by pose, so
  // that it does not matter how far the bodies went on in the step.
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();      // m
  Vec3 impulse_a = Vec3::Zero(), impulse_b = Vec3::Zero();  // N s, on a and on b
  double time = 0.0;            // s since the step's start: when the collision arrived; 0 for contact
  double closing_speed = 0.0;   // m/s along the normal before the collision; 0 for contact
  double duration = 0.0;        // s, if it is known by itself: of a blast; 0: that of the impact
  double spread = 0.0;          // m, radius of the disc over which a blast gave it; 0: that of the contact
  double effective_mass = 0.0;  // kg along the normal, from both full inverse masses
};

/// An impulse (N s, on a) at a point (m), as both bodies feel it where they are; `normal` (unit) from b
/// towards a.
inline LoggedImpulse log_impulse(ImpulseKind kind, BodyId a, const Pose& pose_a, BodyId b, const Pose& pose_b,
                                 const Vec3& point, const Vec3& normal, const Vec3& impulse) {
  LoggedImpulse entry;
  entry.kind = kind;
  entry.body_a = a;
  entry.body_b = b;
  entry.point_world = point;
  entry.normal_world = normal;
  entry.impulse_world = impulse;
  entry.point_a = pose_a.apply_inverse(point);
  entry.point_b = pose_b.apply_inverse(point);
  entry.impulse_a = pose_a.rotation.conjugate() * impulse;
  entry.impulse_b = pose_b.rotation.conjugate() * Vec3(-impulse);
  return entry;
}

using ImpulseLog = std::vector<LoggedImpulse>;

}  // namespace shatterbox::body
