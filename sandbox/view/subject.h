// What a camera without a place must see.
#pragma once

#include <optional>
#include <vector>

#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::view {

/// A fall that a camera without a place goes along with.
struct Fall {
  std::vector<Vec3> from, to;              // m: corners of what is there at the start and, with room for
                                           // pieces, on the floor
  double way = 0.0;                        // m, of the middle
  double speed = 0.0, acceleration = 0.0;  // m/s, m/s2, along the way
};

struct Subject {
  std::vector<Vec3> corners;   // m
  Vec3 centre = Vec3::Zero();  // m
  std::optional<Fall>
      fall;  // where things only fall and are thrown at, and so far that they would be small in one view
};

/// Corners of all bodies that have an end, where they are at the start, go along paths, are dropped, and will
/// land on planes below; of what neither moves nor breaks, as far as it is about the others; around the
/// origin if nothing has an end.
Subject find_subject(const scene::SceneDescription& scene, const scene::ScenePlan& plan);

}  // namespace shatterbox::sandbox::view
