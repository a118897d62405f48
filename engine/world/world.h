// The door of the engine: make a world, add bodies, step, read poses, pieces and impacts.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/body/body.h"
#include "engine/body/impulse_log.h"
#include "engine/body/way.h"
#include "engine/core/result.h"
#include "engine/core/stop.h"
#include "engine/dynamics/blast.h"
#include "engine/geometry/tet_quality.h"
#include "engine/material/material.h"
#include "engine/world/description.h"
#include "engine/world/inventory.h"
#include "engine/world/moment.h"
#include "engine/world/report.h"
#include "engine/world/settings.h"
#include "engine/world/stress_picture.h"

namespace shatterbox::dynamics {
struct ContactReport;
struct StepPart;
}  // namespace shatterbox::dynamics

namespace shatterbox::world {

struct EvaluatedImpact;
struct JointVerdict;
struct MovingState;
struct PartBegin;
struct StepBegin;

/// Where a body came from.
struct Ancestry {
  body::BodyId parent = 0;    // 0: not born of a break
  body::BodyId original = 0;  // the body of the scene that it is, or was, a part of
  double birth_time = 0.0;    // s
};

class World {
 public:
  /// Throws std::invalid_argument: less than one step a second, substep or generation, durations that are
  /// none, a gravity beyond limits.h.
  explicit World(const WorldSettings& settings);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// The world as it is now, kept: it goes on as this one would, to the same bits, whatever becomes of this
  /// one. It shares what never changes. Nobody stops or watches it.
  World copy() const;

  /// Adds a material and returns its number. Reasons for refusal: a value out of its range.
  core::Result<int> add_material(const material::Material& material);
  /// Both materials must be there: std::out_of_range; friction is not negative, restitution 0 to 1:
  /// std::invalid_argument.
  void add_pair(const PairOverride& pair);

  /// Adds a body now: before the first step, or between two steps (the script's drop and projectile). Reasons
  /// for refusal: an unknown material, a form without extent, a mesh that geometry::mend would change,
  /// numbers beyond limits.h.
  core::Result<body::BodyId> add_body(const BodyDescription& description);

  /// Joins two bodies where they are now, until what they bear opens it. Returns its number; 0 if nothing
  /// moves, or mortar finds no faces so near. Reasons for refusal: no such body, no strength, gap or place.
  core::Result<int> add_joint(const JointDescription& description);

  /// Removes a body; false if there is none of that id.
  bool remove_body(body::BodyId id);

  /// Gives an impulse (N s) at a point (m, world) and wakes the body; false if it is not there or not
  /// dynamic, or would be quicker than limits.h has it.
  bool push_body(body::BodyId id, const Vec3& impulse, const Vec3& point);

  /// From the coming step on, m/s2. Wakes everything. Beyond limits.h: std::invalid_argument.
  void set_gravity(const Vec3& gravity);

  /// An explosion in the coming step (dynamics/blast.h). False if it has no energy, or is beyond limits.h.
  bool explode(const dynamics::Blast& blast);

  /// A hand takes hold of a body at a point (m, world), with at most that force (N), and keeps it there and
  /// as it is turned (dynamics/hand.h). Returns its number; 0 if the body is not there or not dynamic, or
  /// place or force are none.
  int grab(body::BodyId id, const Vec3& point, double most_force);
  /// Where a hand is at the end of the coming step, m; from then on it rests there. False if there is no such
  /// hand or place, or what it held is gone.
  bool move_hand(int hand, const Vec3& place);
  void release(int hand);

  /// Factors of all breakable shapes, or what their solves need, which would otherwise be made at the first
  /// hit. Optional.
  void prepare();

  /// From now on `ways` tells how bodies went through the last step. Changes no result.
  void keep_ways();

  /// Asked whether to end: before each step; where something may break, in it too, often, and from several
  /// threads at once. Where much breaks into very much, a step can take minutes.
  void set_stop(core::StopQuestion wants_to_stop);

  /// From now on the watcher is called behind every stage of a step; none: no longer. Changes no result.
  void watch(Watcher watcher);

  /// Advances by one step of 1 / steps_per_second seconds. False if it was asked to stop: then everything is
  /// as before the step, but for the impulse log, the times of its stages and pictures of stress, and it can
  /// be taken again.
  bool step();

  std::span<const body::Body> bodies() const;
  const material::Material& material(int number) const;
  Ancestry ancestry(body::BodyId id) const;
  StressPicture stress_picture(body::BodyId id) const;
  const WorldReport& report() const;
  /// Of bodies that did not go straight through the last step, ascending by id, and behind them of those that
  /// broke in the midst of it; none unless `keep_ways` was called.
  std::span<const body::Way> ways() const;
  /// Impulses of the last step, of the pass that was kept.
  const body::ImpulseLog& impulse_log() const;
  const WorldSettings& settings() const;

  /// What it has made of its optional parts.
  std::vector<PartCount> inventory() const;
  /// How well-shaped the tetrahedra of a solid that can break are; nothing of others.
  std::optional<geometry::TetQuality> tetrahedra(body::BodyId id) const;

  double time() const;  // s
  long steps() const;

  /// Chained over all steps; equal for equal scenes whatever the number of threads.
  std::uint64_t state_hash() const;

 private:
  struct State;
  explicit World(std::unique_ptr<State> state);

  /// What a step leaves behind if it is abandoned: nothing.
  StepBegin note_begin() const;
  void keep_begin(const MovingState& snapshot);
  void put_back(MovingState&& snapshot);

  void tell_watcher(const char* stage, const dynamics::StepPart& part, int pass) const;

  /// All parts of the step, up to sleep. `snapshot`: at the begin of the part that is taken.
  void take_parts(dynamics::ContactReport& contact, MovingState& snapshot);
  /// How often a part of the step was taken again so far.
  struct Passes {
    int breaks = 0, openings = 0;  // with pieces in place of the whole; without joints that opened
    int count() const { return breaks + openings; }
  };
  struct MovedPart;
  MovedPart move_part(const dynamics::StepPart& part, const Passes& passes);
  /// What becomes of a part of a step that was moved. Unless it is accepted, it is taken again from its
  /// begin:
  enum class PartEnd : std::uint8_t {
    accepted,
    subdivided,              // in shorter parts
    retaken_without_joints,  // those that opened in it
    retaken_with_pieces,     // what broke in it is replaced by its pieces
    retaken_in_full,         // it was a trial, which ends early, and nothing opened in it
  };
  PartEnd judge_part(MovedPart& done, MovingState& snapshot, dynamics::StepPart& part,
                     dynamics::ContactReport& contact);
  /// Stages "dents" and "sleep", behind the last of `count` parts.
  void finish_parts(int count, const MovingState& snapshot, dynamics::ContactReport& contact);
  int count_parts() const;
  std::optional<dynamics::StepPart> divide_where_cut(const dynamics::StepPart& part,
                                                     const dynamics::ContactReport& moved) const;
  /// Stages "explosions" and "hands", of one part of the step.
  body::ImpulseLog act(const dynamics::StepPart& part);
  /// Stage "motion", of one part of the step.
  dynamics::ContactReport move_bodies(const dynamics::StepPart& part, body::ImpulseLog& log);
  /// Stage "stress", of the impulses of one part.
  std::vector<EvaluatedImpact> judge_impacts(const body::ImpulseLog& log, const PartBegin& begin);
  /// Tells the report of all impacts, and lets what cracks in one piece crack. Returns those that break.
  std::vector<const EvaluatedImpact*> book_verdicts(std::span<const EvaluatedImpact> impacts,
                                                    MovingState& snapshot, int pass);
  /// Stage "fracture": goes back and puts pieces in place. True if the part must be taken again.
  bool break_bodies(std::span<const EvaluatedImpact* const> broken, MovingState& snapshot);
  /// Stage "dents": what impacts that are over have left.
  /// Returns who has become whom by it.
  std::vector<BreakRow> dent_bodies(const MovingState& snapshot);
  /// Stage "joints", of the impulses of one part.
  std::vector<JointVerdict> judge_joints(const dynamics::StepPart& part, const body::ImpulseLog& log);
  /// Opens those that are overloaded most. True if the part must be taken again.
  bool open_joints(std::span<const JointVerdict> verdicts, MovingState& snapshot, bool may_go_back);
  /// What held a body that broke, as it was in `parent`, holds pieces of it from `time` (s) on, or nothing.
  void hang_on(const body::Body& parent, const std::vector<body::BodyId>& born, double time);
  void inherit_stress(body::BodyId parent, const std::vector<body::BodyId>& born);
  void book_momentum(const std::vector<body::Body>& before, std::span<const body::LoggedImpulse> log,
                     double time_step);
  void book_breaks(const std::vector<body::Body>& before, std::span<const body::LoggedImpulse> paid);
  void book_conservation(const std::vector<body::Body>& before, const body::ImpulseLog& log,
                         double time_step);

  std::unique_ptr<State> state_;
};

}  // namespace shatterbox::world
