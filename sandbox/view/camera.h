// Where the camera is at a time: fixed, on a smooth path through keyframes, or chosen so that all is seen.
#pragma once

#include <optional>

#include "render/frame/frame.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::view {

/// A fall that a camera without a place goes along with: two balls, and how one becomes the other.
struct Fall {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // m, centres of what is there at the start and on the floor
  double radius_from = 0.0, radius_to = 0.0;    // m; on the floor with room for pieces
  double speed = 0.0, acceleration = 0.0;       // m/s, m/s2, along the way
};

/// What a camera without a place must see.
struct Subject {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 1.0;         // m
  std::optional<Fall> fall;    // where things only fall, and so far that they would be small in one view
};

/// A ball about all bodies that have an end and are there at the start, and the places on planes below where
/// they will land; about everything if nothing has.
Subject find_subject(const scene::SceneDescription& scene, const scene::ScenePlan& plan);

struct Viewpoint {
  Vec3 position = Vec3::Zero(), target = Vec3::Zero();  // m
  double fov = 35.0;                                    // degrees, vertical
};

/// The scene's own camera at `time` (s of the world), without what it follows. Keyframes are passed with
/// continuous velocity (cubic Hermite, tangents from neighbours).
Viewpoint viewpoint_at(const scene::CameraEntry& camera, const Subject& subject, double time);

}  // namespace shatterbox::sandbox::view
