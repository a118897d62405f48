// Boxes that turn with their bodies: the cheapest answer to whether two bodies that pass by each other come
// near at all.
#pragma once

#include "engine/core/vec.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::dynamics {

/// A box at both ends of a way on which its body's points go straight.
struct TurnedBox {
  struct Place {
    Vec3 centre = Vec3::Zero();  // m
    Mat3 sides = Mat3::Zero();   // columns: from the centre to the middle of a side, m
  };
  Mat3 axes = Mat3::Identity();  // at the start
  Place start, end;
};

/// `box` in body space; where the body stands and where it goes.
TurnedBox turn_box(const geometry::Box& box, const Pose& start, const Pose& end);

/// A lower bound of how far apart they stay, m, by directions that separate them all the way; negative if
/// none is found. Stops looking once it is more than `enough`.
double clearance(const TurnedBox& a, const TurnedBox& b, double enough);

}  // namespace shatterbox::dynamics
