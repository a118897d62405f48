#include "engine/dynamics/turned_box.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::dynamics {
namespace {

double half_width(const TurnedBox::Place& box, const Vec3& direction) {
  return std::abs(box.sides.col(0).dot(direction)) + std::abs(box.sides.col(1).dot(direction)) +
         std::abs(box.sides.col(2).dot(direction));
}

double apart_along(const TurnedBox::Place& a, const TurnedBox::Place& b, const Vec3& direction) {
  return direction.dot(a.centre - b.centre) - half_width(a, direction) - half_width(b, direction);
}

TurnedBox::Place place_box(const geometry::Box& box, const Mat3& axes, const Vec3& translation) {
  TurnedBox::Place place;
  place.centre = translation + axes * (0.5 * (box.low + box.high));
  place.sides = axes * (0.5 * (box.high - box.low)).asDiagonal();
  return place;
}

}  // namespace

TurnedBox turn_box(const geometry::Box& box, const Pose& start, const Pose& end) {
  TurnedBox turned;
  turned.axes = start.rotation.toRotationMatrix();
  turned.start = place_box(box, turned.axes, start.translation);
  turned.end = place_box(box, end.rotation.toRotationMatrix(), end.translation);
  return turned;
}

double clearance(const TurnedBox& a, const TurnedBox& b, double enough) {
  const Vec3 apart = a.start.centre - b.start.centre;
  double best = -1e300;
  // Along a fixed direction, points that go straight are within what they were at both ends.
  const auto look = [&](const Vec3& direction) {
    const double at_start = apart_along(a.start, b.start, direction);
    if (at_start <= best) return false;
    best = std::max(best, std::min(at_start, apart_along(a.end, b.end, direction)));
    return best > enough;
  };
  const double length = apart.norm();
  if (length > 0.0 && look(apart / length)) return best;
  for (const TurnedBox* box : {&a, &b}) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = box->axes.col(k);
      if (look(apart.dot(axis) >= 0.0 ? axis : Vec3(-axis))) return best;
    }
  }
  return best;
}

}  // namespace shatterbox::dynamics
