#include "engine/body/locked_axes.h"

#include <Eigen/LU>

#include "engine/core/index.h"

namespace shatterbox::body {

Mat3 LockedAxes::invert(const Mat3& inertia) const {
  if (count_turns() == 0) return Mat3::Zero();
  Mat3 of_free = inertia;
  const double unit = inertia.trace();
  for (int axis = 0; axis < 3; ++axis) {
    if (!turns[core::at(axis)]) continue;
    of_free.row(axis).setZero();
    of_free.col(axis).setZero();
    of_free(axis, axis) = unit;
  }
  Mat3 inverse = of_free.inverse();
  for (int axis = 0; axis < 3; ++axis)
    if (turns[core::at(axis)]) inverse(axis, axis) = 0.0;
  return inverse;
}

void LockedAxes::unite(const LockedAxes& others) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    moves[axis] = moves[axis] || others.moves[axis];
    turns[axis] = turns[axis] || others.turns[axis];
  }
}

}  // namespace shatterbox::body
