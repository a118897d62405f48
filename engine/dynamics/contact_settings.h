// What the motion stages are told: step, gravity, gaps, friction and restitution of pairs. Lengths are given
// as shares of the pair's size (twice the bounding radius of the smaller dynamic body), so that a scene in
// millimetres behaves like one in kilometres.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/core/vec.h"

namespace shatterbox::dynamics {

/// Friction and restitution of one pair of materials, in place of the usual rule.
struct PairOverride {
  int material_a = 0;  // Body::material; the order does not matter
  int material_b = 0;
  double friction = 0.5;
  double restitution = 0.3;
};

struct ContactSettings {
  double time_step = 1.0 / 240.0;        // s
  Vec3 gravity = Vec3(0.0, -9.81, 0.0);  // m/s2
  int substeps = 8;                      // of bodies in contact; bodies in free flight need none
  double kept_gap = 5e-4;                // gap kept at rest, share of the pair's size
  double speculative_margin = 2e-3;      // contacts are felt this far ahead, share of the pair's size
  double search_slack = 0.012;  // feature lists are kept until this share of the pair's size is used up
  double warm_start = 0.95;     // share of the last impulses to begin with, where few contacts are swept well
  int continuous_rounds = 6;    // rounds of the continuous pass before the failsafe; 0: that at once
  bool has_sleep = true;        // what rests falls asleep
  double sleep_time = 0.5;      // s of quiet before sleep, of what is neither small nor large
  bool has_ways = false;        // ContactReport::ways is filled
  bool has_caches = true;       // feature lists are kept between steps; the results are the same without
  std::vector<PairOverride> overrides;  // the first that fits is taken
};

/// Coulomb friction and Newton restitution of a pair. Without an override: the geometric mean and the lesser.
struct PairMaterial {
  double friction = 0.0;
  double restitution = 0.0;
  double rolling_friction = 0.0;  // m: the larger of both
};
PairMaterial pair_material(const body::Body& a, const body::Body& b, const ContactSettings& settings);

}  // namespace shatterbox::dynamics
