// What a part of a step came to, for when it is taken again because bodies broke in it: two bodies that begin
// as they began then meet as they met, and as long as they end as they ended, on their ways too. A cache that
// changes no result.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "engine/body/body.h"
#include "engine/collision/collider.h"
#include "engine/collision/contact.h"
#include "engine/core/vec.h"
#include "engine/dynamics/feature_paths.h"
#include "engine/dynamics/feature_search.h"

namespace shatterbox::dynamics {

struct PairState;
struct WorkBody;
struct WorkPair;
class MotionWork;

/// Where a body is at the end of the way that was tested, and how it went there.
struct WayEnd {
  Pose end;
  int straight_parts = 1;
  std::vector<Pose> knots;

  bool is_of(const WorkBody& body) const;
};

struct PartMemory {
  /// All that the meeting of two bodies depends on, of one of them.
  struct Begin {
    body::BodyId id = 0;
    const collision::Collider* collider = nullptr;
    Pose start, predicted;
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero(), predicted_spin = Vec3::Zero();
    double turn_angle = 0.0, inverse_mass = 0.0;
    bool is_active = false;

    bool operator==(const Begin& other) const;
  };
  /// A test of the ways of a pair.
  struct Test {
    WayEnd a, b;
    std::vector<PathHit> hits;
    double spare = 0.0;  // m
  };
  struct Pair {
    body::BodyId body_a = 0, body_b = 0;
    // What was known of it before.
    struct Before {
      double kept_gap = 0.0;  // m
      bool is_seen = false, is_touching = false, is_exempt = false;
      int trouble_age = 0;
      std::size_t contacts = 0;

      bool operator==(const Before&) const = default;
    };
    Before before;
    // What came of it.
    bool is_free_certified = false, is_exempt = false, passes = false;
    double kept_gap = 0.0, least_gap = 0.0;  // m
    std::vector<collision::Contact> contacts;
    std::shared_ptr<const StartGaps> gaps;  // where features were listed
    bool keeps_gaps = false;                // for later steps
    std::vector<Test> tests;                // in their order
  };
  double time_step = 0.0;     // s, of the part; 0: nothing is known
  std::vector<Begin> bodies;  // ascending id
  std::vector<Pair> pairs;    // ascending (body_a, body_b)
};

/// Begins the memory of a part whose pairs were found and classified but have not met, and tells the pairs
/// whose bodies both begin as they did in `former` which row of it is theirs. Pairs that met in an earlier
/// round, of which `memory` is, had before what they had then.
void begin_part(double time_step, const std::vector<PairState>& states, const PartMemory& former,
                MotionWork& work, PartMemory& memory);

/// Keeps what came of the pairs, as far as later stages do not change it: that is moved out of `work` by
/// end_part().
void keep_meetings(const std::vector<PairState>& states, const MotionWork& work, PartMemory& memory);
void end_part(MotionWork& work, PartMemory& memory);

}  // namespace shatterbox::dynamics
