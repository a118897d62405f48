// What a frame of the film shows.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "engine/body/body.h"
#include "sandbox/scene/body_ref.h"
#include "sandbox/view/framing.h"

namespace shatterbox::sandbox::view {

struct Moment {
  double film = 0.0;    // s of the film
  double time = 0.0;    // s of the world
  double factor = 1.0;  // seconds of the world in a second of the film
  std::span<const body::Body> bodies;
  Shift shift{};  // of a camera without a place, which goes after what would leave its picture
};

/// Where a body of the scene is: its centre, or that of its copies and pieces, m; nothing if it is not there.
using Whereabouts = std::function<std::optional<Vec3>(scene::BodyRef who)>;

}  // namespace shatterbox::sandbox::view
