#include "sandbox/view/framing.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::sandbox::view {
namespace {

constexpr double kFilled = 0.75;  // of the picture's width and height
constexpr double kAspect =
    4.0 / 3.0;                        // of the picture that they fill; narrower ones see more above and below
constexpr double kFromBeside = 0.45;  // of the way that the eye is in front
constexpr double kFromAbove = 0.35;
constexpr double kMuchDeeper = 1.5;     // times as deep as wide is looked at from the side
constexpr double kLeastDistance = 0.1;  // of the size of it all, from what is nearest
constexpr double kLeastSize = 1e-6;     // m

// To the right and towards the eye, level, as they lie before one who stands upright before the world.
struct Level {
  Vec3 right, front;
};

Level level_axes(const Vec3& up) {
  const Vec3 across = std::abs(up.x()) < 0.9 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY());
  const Vec3 right = (across - across.dot(up) * up).normalized();
  return {right, right.cross(up)};
}

Vec3 choose_side(const std::vector<Vec3>& points, const Vec3& up) {
  Level level = level_axes(up);
  geometry::Box seen;
  for (const Vec3& p : points) seen.include(Vec3(p.dot(level.right), 0.0, p.dot(level.front)));
  const Vec3 width = seen.high - seen.low;
  if (width.z() > kMuchDeeper * width.x()) level = {-level.front, level.right};
  return (kFromBeside * level.right + kFromAbove * up + level.front).normalized();
}

// Along one side of the picture: how far back the eye must be, and where beside, so that no point is more
// than `slope` away from its axis at the depth at which it is.
struct Side {
  double slope = 0.0;
  double most = -1e300, least = 1e300;  // of place + slope * depth, and of place - slope * depth

  void include(double place, double depth) {
    most = std::max(most, place + slope * depth);
    least = std::min(least, place - slope * depth);
  }
  double back() const { return 0.5 * (most - least) / slope; }
  double back_at(double middle) const { return std::max(most - middle, middle - least) / slope; }
  double middle() const { return 0.5 * (most + least); }
};

}  // namespace

Viewpoint frame_points(const std::vector<Vec3>& points, const Framing& framing) {
  const Vec3 up = framing.up.normalized(), away = choose_side(points, up);
  const Vec3 right = up.cross(away).normalized(), upwards = away.cross(right);
  const double half = framing.fov * core::kPi / 360.0;
  const double slope = kFilled * core::sin(half) / core::cos(half);
  Side across{kAspect * slope}, along{slope};
  geometry::Box box;
  double nearest = -1e300;
  for (const Vec3& p : points) {
    nearest = std::max(nearest, p.dot(away));
    across.include(p.dot(right), p.dot(away));
    along.include(p.dot(upwards), p.dot(away));
    box.include(p);
  }
  Vec3 target = framing.target.value_or(0.5 * (box.low + box.high));
  double back = 0.0;
  if (framing.target) {
    back = std::max(across.back_at(target.dot(right)), along.back_at(target.dot(upwards)));
  } else {
    back = std::max(across.back(), along.back());
    target +=
        (across.middle() - target.dot(right)) * right + (along.middle() - target.dot(upwards)) * upwards;
  }
  const double size = std::max((box.high - box.low).norm(), kLeastSize);
  const double distance = std::max(back, nearest + kLeastDistance * size) - target.dot(away);
  return {target + distance * away, target, framing.fov, kAspect};
}

}  // namespace shatterbox::sandbox::view
