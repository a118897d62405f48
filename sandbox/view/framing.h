// An eye that has points in its picture.
#pragma once

#include <optional>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::sandbox::view {

struct Viewpoint {
  Vec3 position = Vec3::Zero(), target = Vec3::Zero();  // m
  double fov = 35.0;                                    // degrees, vertical
  double least_aspect = 0.0;                            // as of render::Camera
};

/// How far an eye has gone from where it would be, m.
struct Shift {
  Vec3 position = Vec3::Zero(), target = Vec3::Zero();

  Shift towards(const Shift& other, double share) const {
    return {position + share * (other.position - position), target + share * (other.target - target)};
  }
};

struct Framing {
  Vec3 up = Vec3::UnitY();
  double fov = 35.0;                        // degrees, vertical
  std::optional<Vec3> target;               // m; nothing: what shows the points largest
  std::optional<Vec3> away = std::nullopt;  // from the target to the eye, unit; nothing: as below
};

/// From in front of the wider side of the points (m, at least one), a little from the right and from above:
/// as near as all of them are in the middle of the picture with some room.
Viewpoint frame_points(const std::vector<Vec3>& points, const Framing& framing);

}  // namespace shatterbox::sandbox::view
