#include "engine/dynamics/hand.h"

#include <algorithm>

#include "engine/dynamics/free_motion.h"

namespace shatterbox::dynamics {

namespace {

constexpr double kStiffness =
    60.0;  // rad/s: what is off by a millimetre is back within a twentieth of a second

/// The velocity that an implicit Euler step of x'' = -k2 (x - X) - 2 k (x' - X') gives to what would go on at
/// `velocity` and is `way` short of where it is to be at the step's end: stable for steps of any length.
Vec3 driven(const Vec3& velocity, const Vec3& way, const Vec3& goal_velocity, double time_step) {
  const double h = time_step, k = kStiffness;
  return (velocity + h * k * k * way + 2.0 * h * k * goal_velocity) / (1.0 + 2.0 * h * k + h * h * k * k);
}

Vec3 limited(const Vec3& v, double most) {
  const double size = v.norm();
  return size > most ? Vec3(v * (most / size)) : v;
}

}  // namespace

HandPush drive_by_hand(const body::Body& body, const Hand& hand, const Vec3& gravity, double time_step) {
  HandPush push;
  push.point = body.pose.apply(hand.grip);
  if (!body.is_dynamic()) return push;
  const Vec3 arm = push.point - body.pose.translation;
  const double mass = 1.0 / body.inverse_mass;
  const double most = hand.most_force * time_step;
  // The push comes at the step's start and gravity in its course: what counts is the mean velocity, which is
  // half of gravity's gain before that at either end.
  const Vec3 half_gain = 0.5 * time_step * gravity;
  const Vec3 turned =
      driven(body.angular_velocity, turn_between(body.pose.rotation, hand.attitude), Vec3::Zero(), time_step);
  const Vec3 grip_velocity = body.velocity_at(push.point) - half_gain;
  const Vec3 wanted = driven(grip_velocity, hand.place - push.point, hand.velocity, time_step) + half_gain;
  // First the weight, so that a hand that pulls with all its force lets nothing fall; then the way.
  const Vec3 weight = limited(-2.0 * mass * half_gain, most);
  const Vec3 drive = mass * (wanted - turned.cross(arm) - body.velocity);
  push.impulse = weight + limited(drive, most - weight.norm());
  const Mat3 rotation = body.pose.rotation.toRotationMatrix();
  const Mat3 inertia = rotation * body.shape->inertia * rotation.transpose();
  push.angular_impulse = limited(inertia * (turned - body.angular_velocity) - arm.cross(push.impulse),
                                 body.shape->bounding_radius * most);
  return push;
}

}  // namespace shatterbox::dynamics
