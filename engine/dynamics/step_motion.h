// The motion of rigid bodies through one step, as named stages that can each be called alone.
//
// [GBF03]'s order is collide, velocity, contact, position. Here the step is divided into substeps and in each
// of them the four are done in turn: half a kick of gravity, contact with what arrives (velocity, contact),
// drift (position), half a kick, contact, and the bounce of what has now arrived (collide). So `solve_motion`
// groups resolve collisions, integrate velocities, resolve contacts and advance positions; a body in free
// flight takes the whole step at once. A body is seen to touch before it bounces: contacts ahead of it only
// make it arrive.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "engine/body/body.h"
#include "engine/body/impulse_log.h"
#include "engine/body/way.h"
#include "engine/dynamics/contact_settings.h"
#include "engine/dynamics/contact_state.h"

namespace shatterbox::dynamics {

struct ContactReport {
  int contacts = 0;         // with a gap below twice the kept gap at the step's end
  int solver_contacts = 0;  // all that the solver was given, speculative ones included
  double least_gap =
      1e300;             // m, over all pairs that do not cross, at the step's start; 1e300 without any near
  int hits = 0;          // pairs in which the continuous pass had to act
  int turning_hits = 0;  // of them: with one that turns far in a whole step
  int rounds = 0;        // rounds of the continuous pass
  long ways_tested = 0;  // pairs of bodies whose ways it tested, in all of them
  double test_bytes = 0.0;  // that it kept for that, hits apart
  int failsafe_steps = 0;   // bodies whose step was cut short
  int newly_cut = 0;        // of them: by others than those they are hooked to
  int longest_cut = 0;      // steps in a row, of what was cut longest; and, at last, by this pair:
  std::pair<body::BodyId, body::BodyId> longest_cut_pair{};
  int crossing_pairs = 0;  // crossed when they were first seen, and still do
  std::vector<std::pair<body::BodyId, body::BodyId>> new_crossing_pairs;  // seen in this step
  std::vector<std::pair<body::BodyId, body::BodyId>> parted;  // lay exactly in each other: parting.h
  double frozen_share = 0.0;  // of the motion of awake dynamic bodies: that of those cut short
  double residual = 0.0;      // m/s: greatest closing speed left in a touching contact
  int awake_bodies = 0;
  int near_bodies = 0;          // of them: in a pair that had to be looked at
  double crowd_turn = 0.0;      // rad in a step: more than one in twenty of these turn so far, spheres apart
  double torn = 0.0;            // the most that a joint is off at the end, of the lesser reach
  std::vector<body::Way> ways;  // ascending id; if asked for: of bodies that did not go straight
  double drift = 0.0;           // m, of surfaces from their bodies; of the paper's scheme alone
  bool is_unfinished = false;   // a trial found ways that are not free: its end poses are good for nothing
};

/// Scratch of one step, handed from stage to stage. Holds no state: a new one gives the same results.
class MotionWork;  // motion_work.h

/// Stage: wakes bodies whose support vanished or moves, or that were given a velocity; floods through
/// touching pairs.
void wake_bodies(std::vector<body::Body>& bodies, const ContactSettings& settings, ContactState& state);

/// One of the equal parts in which a step is taken. What happens in a part is known at its end, so that who
/// breaks bodies goes back no further than to its beginning.
struct StepPart {
  int number = 0, count = 1;
  bool may_return = false;  // it may be taken again
  bool is_again = false;    // it is: from its beginning, but for bodies that broke and what they touched
  // It ends where ways would have to be opened: what opens is known by then, and goes other ways.
  bool is_trial = false;
};

/// In how many parts the step that begins here should be taken: several if pieces are newborn, which lie in
/// each other's way and go far against their own size while they part, and after that while many spin so fast
/// and collide; or if many were hit on their ways in the step before. Many of those that are near others: who
/// is far from all does not matter.
int count_parts(const std::vector<body::Body>& bodies, const ContactSettings& settings,
                const ContactState& state);

/// The motion of one part in the order of the stages below. `settings` are those of the whole step. `bodies`
/// ascend by id; they may have grown, shrunk or been replaced since the last call. Appends to `log` one entry
/// a contact that gave an impulse, with its time since the step began.
ContactReport move_part(std::vector<body::Body>& bodies, const ContactSettings& settings,
                        const StepPart& part, ContactState& state, body::ImpulseLog& log);

/// The part with which the step should go on in place of this one so that none is longer than `longest` (s):
/// the first of several, if it is; there is a bound to how many the step has in all.
StepPart divide_to(const ContactSettings& settings, const StepPart& part, double longest);

/// The part with which the step should go on in place of this one, now that its motion is known: the first of
/// several that are shorter, if many stood still in it because they found no room; else none.
std::optional<StepPart> divide_where_cut(const ContactSettings& settings, const StepPart& part,
                                         const ContactReport& moved);

/// Whether a trial of the part may tell what opens in it: it is as short as parts get, so that it would not
/// be divided whatever comes of it.
bool may_be_tried(const ContactSettings& settings, const StepPart& part);

/// Adds what a part reports to the report of its step.
void add_part(const StepPart& part, ContactReport&& moved, ContactReport& step);

/// After the last of so many parts: decides whether the next step is one that is taken in parts too.
void end_step(const ContactSettings& settings, const ContactReport& step, int parts, ContactState& state);

/// All parts of a step, one after the other.
ContactReport step_motion(std::vector<body::Body>& bodies, const ContactSettings& settings,
                          ContactState& state, body::ImpulseLog& log);

/// Stage: brings `state` in line with `bodies`, finds pairs by their swept bounds, and their contacts at this
/// pose.
void find_candidate_pairs(const std::vector<body::Body>& bodies, const ContactSettings& settings,
                          ContactState& state, MotionWork& work);

/// Keeps what was searched for a step that is taken again from here.
void put_on_shelf(const MotionWork& work, ContactState& state);
/// Keeps for the next part the memory that bodies wrote their places into; of no use to them any more.
void keep_scratch(MotionWork& work, ContactState& state);

/// Stage: collisions, velocities, contacts and positions by substeps (see the head of this file). Ends with
/// end poses in `work`; `bodies` are not changed yet.
void solve_motion(const std::vector<body::Body>& bodies, const ContactSettings& settings, MotionWork& work);

/// The same anew, from the start of the step, for the islands with a body that is dirty; all their bodies are
/// dirty then.
void solve_islands(const std::vector<body::Body>& bodies, const ContactSettings& settings,
                   std::vector<char>& is_dirty, MotionWork& work);

/// Pairs that only the impulses of this step brought together: bodies that end far from where they were
/// predicted to. Appends to the pairs of `work`.
void find_missed_pairs(const std::vector<body::Body>& bodies, const ContactSettings& settings,
                       ContactState& state, MotionWork& work);

/// Stage: no vertex path may cross another surface; hits are opened again in position and tested again, at
/// last by cutting steps short. Ends at once, with nothing done, where somebody is struck in his sleep: who,
/// is in `work.to_wake`. `slept`: who of `bodies` slept when the step began; empty: nobody sleeps.
void guard_motion(const std::vector<body::Body>& bodies, const ContactSettings& settings,
                  const std::vector<char>& slept, ContactState& state, MotionWork& work,
                  ContactReport& report);

/// Stage: writes end poses and velocities to `bodies`, impulses to `log`, warm start to `state`.
void finish_motion(std::vector<body::Body>& bodies, ContactState& state, MotionWork& work,
                   body::ImpulseLog& log, ContactReport& report);

/// Stage: what has been quiet for `sleep_time` (longer if it is large, shorter if it is small), as has all
/// that it touches, falls asleep.
void put_to_sleep(std::vector<body::Body>& bodies, const ContactSettings& settings, ContactState& state);

}  // namespace shatterbox::dynamics
