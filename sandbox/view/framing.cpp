#include "sandbox/view/framing.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
};

// Where beside the eye must be, that as much is left free on the one side of the picture as on the other: of
// points (place, depth), from so far back (more than any depth). What is highest in the picture depends on
// where the eye is: a few times the two that were are made even.
double even_middle(const std::vector<Vec2>& points, double back) {
  constexpr int kTimes = 8;
  double middle = 0.0;
  for (int k = 0; k < kTimes; ++k) {
    const auto slope = [&](const Vec2& p) { return (p.x() - middle) / (back - p.y()); };
    const auto [low, high] = std::minmax_element(
        points.begin(), points.end(), [&](const Vec2& p, const Vec2& q) { return slope(p) < slope(q); });
    const double far_low = back - low->y(), far_high = back - high->y();
    const double before =
        std::exchange(middle, (low->x() * far_high + high->x() * far_low) / (far_low + far_high));
    if (middle == before) break;
  }
  return middle;
}

}  // namespace

Viewpoint frame_points(const std::vector<Vec3>& points, const Framing& framing) {
  const Vec3 up = framing.up.normalized(), away = framing.away ? *framing.away : choose_side(points, up);
  const Vec3 right = up.cross(away).normalized(), upwards = away.cross(right);
  const double half = framing.fov * core::kPi / 360.0;
  const double slope = kFilled * core::sin(half) / core::cos(half);
  Side across{kAspect * slope}, along{slope};
  std::vector<Vec2> places_across, places_along;
  geometry::Box box;
  double nearest = -1e300;
  for (const Vec3& p : points) {
    const double depth = p.dot(away);
    nearest = std::max(nearest, depth);
    across.include(p.dot(right), depth);
    along.include(p.dot(upwards), depth);
    places_across.emplace_back(p.dot(right), depth);
    places_along.emplace_back(p.dot(upwards), depth);
    box.include(p);
  }
  const double size = std::max((box.high - box.low).norm(), kLeastSize);
  Vec3 target = framing.target.value_or(0.5 * (box.low + box.high));
  double back = framing.target
                    ? std::max(across.back_at(target.dot(right)), along.back_at(target.dot(upwards)))
                    : std::max(across.back(), along.back());
  back = std::max(back, nearest + kLeastDistance * size);
  if (!framing.target)
    target += (even_middle(places_across, back) - target.dot(right)) * right +
              (even_middle(places_along, back) - target.dot(upwards)) * upwards;
  return {target + (back - target.dot(away)) * away, target, framing.fov, kAspect};
}

}  // namespace shatterbox::sandbox::view
