// What contact remembers from step to step: a value that is copied for the snapshot and put back to go back
// in time. Impulses and ages are state and are hashed; feature lists are caches that change no result and are
// not.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "engine/body/body.h"
#include "engine/collision/collider.h"
#include "engine/core/hash.h"
#include "engine/core/vec.h"
#include "engine/dynamics/body_scratch.h"
#include "engine/dynamics/feature_search.h"
#include "engine/dynamics/free_motion.h"
#include "engine/dynamics/joint.h"
#include "engine/dynamics/part_memory.h"

namespace shatterbox::dynamics {

/// What is kept of one contact: enough to find it again and to start the solver from its last impulse.
struct RememberedContact {
  std::uint64_t feature_key = 0;         // kind and numbers of both features
  double normal_impulse = 0.0;           // N s, of one substep
  Vec3 friction_impulse = Vec3::Zero();  // N s, of one substep, world, on body a
  Vec3 creep = Vec3::Zero();             // m, world: how far a has crept on b since friction holds it
  double arrival_speed = 0.0;            // m/s: closing speed of an impact that has not bounced yet
  bool was_loaded = false;               // carried an impulse in the last step
  double hit_left = 0.0;                 // s: how long what it gives is still the hit's
};

inline constexpr int kNoTrouble = 1000;

/// One pair of bodies that were near each other in the last step.
struct PairState {
  body::BodyId body_a = 0, body_b = 0;  // body_a < body_b
  double kept_gap = 0.0;     // m: min(usual, least gap seen so far): never pushes newborn pieces apart
  bool is_touching = false;  // a sleeper and what disturbs it, or holds it up
  bool has_parted = false;   // pressed a step ago, and touches no longer
  double load = 0.0;         // N, that its contacts carry at rest, if anything may break; a sleeper's keep it
  int trouble_age = kNoTrouble;  // steps since the continuous pass last had to act here
  int stuck_steps = 0;           // steps in a row in which the pair had to be cut short
  bool is_hooked = false;    // cut short in a part as short as there is, and ever since: shorter is no help
  bool is_exempt = false;    // crossed when it was first seen, and still does: passes until it has come apart
  bool is_reported = false;  // as exempt
  std::vector<RememberedContact> contacts;

  std::shared_ptr<const StartGaps> gaps;  // a cache: its list of features, and how near these were last
  // The same for a pair that is not near: its surfaces were at least `clear` (m) apart when its bodies had
  // travelled `clear_since` (m) in all.
  double clear = kUnknownClear, clear_since = 0.0;

  static constexpr double kUnknownClear = -1e300;

  /// One of its contacts carried an impulse in the last step.
  bool was_loaded() const {
    return std::any_of(contacts.begin(), contacts.end(),
                       [](const RememberedContact& c) { return c.was_loaded; });
  }
  void forget_caches() {
    gaps.reset();
    clear = kUnknownClear;
  }
};

/// One body's own memory.
struct BodyState {
  body::BodyId id = 0;
  std::shared_ptr<const body::Shape> shape;
  std::shared_ptr<const collision::Collider> collider;  // of `shape`; shared between copies of the body
  PrincipalInertia inertia;
  Pose rest_pose;            // the body has stayed about here for its quiet time
  Pose last_pose;            // at the end of the last step: whoever moves a body by hand makes its lists void
  double slept_under = 0.0;  // N, of all its pairs, when it fell asleep
  double travelled = 0.0;    // m: no point of it has moved further, from step to step, since it is known
};

/// What the last step looked at, whatever became of it: a step that is taken again finds its colliders and
/// lists here. A cache that a state shares with its snapshots: with whatever no other thread steps.
struct SearchShelf {
  std::vector<BodyState> bodies;   // ascending id
  std::vector<BodyState> newborn;  // of shapes whose bodies no step has seen yet; without ids
  struct Row {
    body::BodyId body_a = 0, body_b = 0;
    std::shared_ptr<const StartGaps> gaps;
  };
  std::vector<Row> pairs;   // ascending (body_a, body_b)
  PartMemory part, former;  // of a part that may be taken again; of its taking before, while it is
  bool keeps_part = false;
  std::vector<BodyScratch> scratch;  // ascending id
};

struct ContactState {
  std::vector<PairState> pairs;           // ascending (body_a, body_b)
  std::vector<BodyState> bodies;          // ascending id
  std::map<body::BodyId, int> cut_steps;  // of those cut short in the last step: in so many, in a row
  std::vector<Joint> joints;              // ascending number; those that hold
  double substep = 0.0;                   // s, of the impulses that contacts remember
  int next_parts = 1;                     // in which the next step is taken: many bodies collide
  double swing = 0.0;                     // rad/s, the fastest of what joints pull taut
  std::shared_ptr<SearchShelf> shelf = std::make_shared<SearchShelf>();

  PairState* find_pair(body::BodyId a, body::BodyId b);
  const PairState* find_pair(body::BodyId a, body::BodyId b) const;
};

/// Makes what follows from the shape: collider and inertia.
void know_shape(BodyState& body);

/// Adds all that decides later steps to the hash; caches stay out, and loads, which follow from the impulses
/// of this step or an earlier one.
void add_to_hash(const ContactState& state, core::Hash& hash);

}  // namespace shatterbox::dynamics
