// Rigid bodies: what changes every step (pose, velocities, rest) together with what contact needs to know of
// a body.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/body/locked_axes.h"
#include "engine/body/scripted_path.h"
#include "engine/body/shape.h"
#include "engine/core/vec.h"

namespace shatterbox::body {

/// Bodies are numbered in the order of their birth; a number is never used again. Zero is no body.
using BodyId = std::uint32_t;

enum class Motion : std::uint8_t { fixed, scripted, dynamic };

/// How a scripted body follows its path. Who was in its way holds it up; then it comes on slowly, until it
/// has caught up with where it is to be. Who comes at full pace upon what can break and cannot give way
/// strikes it, as a free body of its mass and velocity would.
struct Script {
  std::shared_ptr<const ScriptedPath> path;  // none: it goes on at its velocity
  double time = 0.0;                         // s since it began
  double pace = 1.0;                         // share of its top speed that it may go at
  double wait = 0.0;                         // s until it tries again
  int blows = 0;                             // that it gave since it last went at full pace
  bool strikes = false;                      // this part of the step it goes as a free body: it is dynamic
};

struct Body {
  BodyId id = 0;
  std::string name;
  Motion motion = Motion::dynamic;
  std::shared_ptr<const Shape> shape;

  Pose pose;                             // of the centre of mass, world from body
  Vec3 velocity = Vec3::Zero();          // of the centre of mass, m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s, world
  double inverse_mass = 0.0;             // 1/kg; 0 unless dynamic, or scripted and striking
  Mat3 inverse_inertia = Mat3::Zero();   // body space, 1/(kg m2); 0 as well
  Vec3 force = Vec3::Zero();             // N, world, at the centre of mass, all the time; of dynamic bodies
  Vec3 torque = Vec3::Zero();            // N m, world
  LockedAxes locked;                     // of dynamic bodies

  double friction = 0.5;
  double rolling_friction = 0.0;  // m: radius of the patch that it rolls, and spins, on
  double restitution = 0.3;
  double young = 70e9;  // Pa, for the contact's own compliance
  double poisson = 0.22;
  int group = -1;          // bodies of one group >= 0 do not collide with each other: see collides_with
  BodyId family = 0;       // the body of the scene that this one is, or was, a part of; 0: of none
  int material = 0;        // number in the world's list of materials
  bool may_break = false;  // somebody judges the hits on it
  double bears = 0.0;      // N: under what rests on it, up to so much in all, it surely does not break

  Script script;  // of scripted bodies

  bool is_awake = true;
  double quiet_time = 0.0;  // s for which the body has hardly moved

  bool is_dynamic() const { return inverse_mass > 0.0; }
  bool sleeps() const { return is_dynamic() && !is_awake; }
  /// Scripted, and on its way in the step that begins here.
  bool is_driven() const {
    return motion == Motion::scripted && velocity.squaredNorm() + angular_velocity.squaredNorm() > 0.0;
  }
  /// Scripted, on its way, and the other stands still and would break rather than let it pass.
  bool comes_upon(const Body& other) const {
    return is_driven() && other.motion == Motion::fixed && other.may_break;
  }
  /// False for bodies of one group, unless they are pieces of one body, which collide in any case.
  bool collides_with(const Body& other) const {
    return group < 0 || group != other.group || (family != 0 && family == other.family);
  }
  /// 1/(kg m2): spin by angular impulse, where locked axes let it turn.
  Mat3 inverse_inertia_world() const;
  /// m/s2, of the centre of mass, where nothing touches.
  Vec3 free_acceleration(const Vec3& gravity) const {
    if (script.strikes) return Vec3::Zero();  // what drives it carries it
    return locked.let_move(is_forced() ? Vec3(gravity + inverse_mass * force) : gravity);
  }
  bool is_forced() const { return force.squaredNorm() + torque.squaredNorm() > 0.0; }
  Vec3 velocity_at(const Vec3& point_world) const {
    return velocity + angular_velocity.cross(point_world - pose.translation);
  }
  /// How it gives way at a point along a unit direction, both in body space: 1/kg; 0 if it cannot move so.
  double mobility(const Vec3& point_body, const Vec3& direction_body) const;
  /// Gives it an impulse, N s, at a point of the world; nothing if it is not dynamic.
  void push(const Vec3& impulse, const Vec3& point_world);
  void wake();
};

/// Kinetic energy, J; 0 for bodies that are not dynamic.
double kinetic_energy(const Body& body);

/// Angular momentum about the world's origin, kg m2/s; 0 for bodies that are not dynamic.
Vec3 angular_momentum(const Body& body);

/// The body with that id in `bodies` (ascending ids), or nothing. Pointers are good until the list changes.
Body* find_body(std::vector<Body>& bodies, BodyId id);
const Body* find_body(std::span<const Body> bodies, BodyId id);

}  // namespace shatterbox::body
