// The events of a scene as plain data: when, and what. Lengths in metres, SI units, y up. Times of what
// happens in the world are simulated seconds; how long a picture's doings last is in seconds of the film.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/core/vec.h"
#include "sandbox/scene/body_ref.h"
#include "sandbox/scene/problem.h"

namespace shatterbox::sandbox::scene {

/// A place in the picture: from its middle, in heights of the picture, to the right and up. So it does not
/// depend on the picture's size.
struct ScreenPlace {
  double right = 0.0, up = 0.0;
};

struct Projectile {
  std::optional<Vec3> from;  // m; nothing: from the camera
  std::variant<Vec3, BodyRef, ScreenPlace> target = Vec3(Vec3::Zero());
  double speed = 0.0;
  Vec3 spin = Vec3::Zero();
};
/// With all copies of the body.
struct Drop {
  std::optional<Vec3> position;  // nothing: the body's own
};
struct Push {
  Vec3 impulse = Vec3::Zero();  // N s, world
  std::optional<Vec3> point;    // m, world; nothing: through the centre of mass
};
struct Remove {};

struct Gravity {
  Vec3 gravity = Vec3::Zero();  // m/s2
  double ramp = 0.0;            // s, from what it was to this one
};

struct Explosion {
  Vec3 centre = Vec3::Zero();  // m
  double energy = 0.0;         // J
  double duration = 0.0;       // s; 0: by the law of the blast
};

struct Grab {
  std::optional<Vec3> point;    // m; nothing: the body's centre
  std::optional<double> force;  // N, greatest; nothing: ten times what the body weighs on earth
};
/// The hand that holds the body goes there.
struct Carry {
  Vec3 to = Vec3::Zero();  // m
  double duration = 1.0;   // s
};
struct Release {};

/// Slow motion: the film's seconds show `factor` times as many of the world's.
struct Speed {
  double factor = 1.0;
  double ramp = 0.0;  // s of the film, from the old factor to this one
};

enum class CameraMove : std::uint8_t {
  cut,     // there at once
  dolly,   // goes there
  orbit,   // round what it looks at
  follow,  // keeps a body in the middle of the picture
};

struct CameraChange {
  CameraMove move = CameraMove::cut;
  std::optional<Vec3> position, target;  // m; of cuts and dollies; nothing: as before
  std::optional<double> fov;             // degrees
  double angle = 0.0;                    // rad, of an orbit; positive: against the clock, seen from above
  std::optional<Vec3> offset;            // m, of a follower from the body; nothing: it stays and turns
  double duration = 0.0;                 // s of the film
  bool is_smooth = true;                 // begins and ends at rest
};

/// From now on.
struct OverlayChange {
  std::string name;            // of kOverlayNames
  std::optional<double> most;  // top of its scale, in its unit
};

struct Caption {
  std::string text;
  double duration = 3.0, fade = 0.4;  // s of the film
};

enum class When : std::uint8_t {
  time,         // at `at`
  first_break,  // `at` after the step in which something first breaks, or `whose` parts first do
  rest,         // `at` after everything that can move has been quiet for kRestTime
};

inline constexpr double kRestTime = 0.5;  // s

struct EventEntry {
  Place place;
  std::string name;
  When when = When::time;
  double at = 0.0;  // s
  BodyRef whose;    // break it waits for; nobody: whoever breaks
  BodyRef who;      // what comes in (with its copies), is pushed or goes
  std::variant<Projectile, Drop, Push, Remove, Gravity, Explosion, Grab, Carry, Release, Speed, CameraChange,
               OverlayChange, Caption>
      action;
};

/// An event for the picture whose time has come.
struct Cue {
  double film = 0.0;                  // s of the film
  const EventEntry* event = nullptr;  // never null; of the scene
};

inline bool is_for_picture(const EventEntry& event) {
  return std::holds_alternative<CameraChange>(event.action) ||
         std::holds_alternative<OverlayChange>(event.action) || std::holds_alternative<Caption>(event.action);
}

inline const std::vector<std::string> kWhenNames{"first break", "rest"};
inline const std::vector<std::string> kEventVerbs{"projectile", "drop",    "push",   "remove",  "gravity",
                                                  "explosion",  "grab",    "move",   "release", "speed",
                                                  "camera",     "overlay", "caption"};

}  // namespace shatterbox::sandbox::scene
