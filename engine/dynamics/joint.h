// What holds two bodies together, until it opens: over an area, or at a point about which they turn freely.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/core/hash.h"
#include "engine/core/vec.h"

namespace shatterbox::dynamics {

struct Joint {
  int number = 0;
  body::BodyId body_a = 0, body_b = 0;
  // In the body spaces: the middle of the area, its normal (x, from b towards a) and its principal axes.
  Pose frame_a, frame_b;
  bool is_pivot = false;        // holds a point; otherwise no turn either
  bool may_meet = false;        // of a pivot: its bodies were apart when they were joined, and collide
  double area = 0.0;            // m2
  Vec3 moments = Vec3::Zero();  // m4, second moments of the area about the three axes; unused of a pivot
  // What it gave to a in the last part of a step, in its axes: b got the opposite, at the same point.
  Vec3 impulse = Vec3::Zero();  // N s
  Vec3 couple = Vec3::Zero();   // N m s, about the middle
  // As much of them as answers what struck the bodies it holds together; only if something did.
  Vec3 blow_impulse = Vec3::Zero(), blow_couple = Vec3::Zero();
  bool is_struck = false;
};

/// Adds what decides later steps to the hash.
void add_to_hash(const std::vector<Joint>& joints, core::Hash& hash);

}  // namespace shatterbox::dynamics
