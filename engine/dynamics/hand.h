// A hand that holds a body: a stiff, critically damped drive of the point where it was grabbed, and of its
// attitude, to where the hand is, with a force that has a limit. What the body meets can hold it back.
#pragma once

#include "engine/body/body.h"

namespace shatterbox::dynamics {

struct Hand {
  int number = 0;
  body::BodyId body = 0;
  Vec3 grip = Vec3::Zero();          // m, body space: the point held
  Quat attitude = Quat::Identity();  // of the body, as it was grabbed
  Vec3 place = Vec3::Zero();         // m, world: where the hand is at the step's end
  Vec3 velocity = Vec3::Zero();      // m/s, of the hand
  double most_force = 0.0;           // N; the greatest torque is that times the body's bounding radius
};

/// What a hand gives to a body in `time_step` (s) under `gravity`, whose pull it expects.
struct HandPush {
  Vec3 impulse = Vec3::Zero();          // N s, world, at the grip
  Vec3 angular_impulse = Vec3::Zero();  // N m s, world, beside that
  Vec3 point = Vec3::Zero();            // m, world: the grip
};
HandPush drive_by_hand(const body::Body& body, const Hand& hand, const Vec3& gravity, double time_step);

}  // namespace shatterbox::dynamics
