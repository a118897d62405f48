// What happens when: the events of a scene, played on step borders, so that the same script gives the same
// run.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"
#include "sandbox/script/conditions.h"
#include "sandbox/script/film_clock.h"
#include "sandbox/script/forces.h"

namespace shatterbox::sandbox::script {

/// Where the camera is and looks, for what is thrown at a place of the picture.
struct Sight {
  Vec3 eye = Vec3::Zero(), target = Vec3::Zero();  // m
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitY();  // m, at the target: a height of the picture
};

/// A body that an event has thrown.
struct Throw {
  body::BodyId body = 0;
  const scene::EventEntry* event = nullptr;  // never null; of the scene
  double arrival = 0.0;                      // s: when it is to be at its target
};

class Script {
 public:
  /// `scene` must outlive the script.
  explicit Script(const scene::SceneDescription& scene);

  /// Brings in the copies and plays the events that are due before the coming step (each lands on the first
  /// step border at or after its time). A copy for which there is no room waits until there is; an event is
  /// refused. Returns what could not be done, in sentences.
  /// `sight` tells of the camera; it is asked only if an event needs it.
  std::vector<std::string> play(scene::BuiltScene& built, const std::function<Sight()>& sight = {});

  /// Whether nothing is left to come.
  bool is_over() const;

  /// Whether the film may yet be slowed down or sped up.
  bool may_change_speed() const;

  /// Events for the picture that were played since the last call.
  std::vector<scene::Cue> take_cues() { return std::exchange(cues_, {}); }

  /// What was thrown since the last call.
  std::vector<Throw> take_throws() { return std::exchange(thrown_, {}); }

  /// What the film shows when.
  const FilmClock& clock() const { return clock_; }

 private:
  /// A copy of a body that comes in later than the first.
  struct LateCopy {
    long due = 0;  // step
    int entry = 0, copy = 0;
    Pose pose;
    bool was_told = false;  // that it waits for room
  };

  void bring_copies(scene::BuiltScene& built, std::vector<std::string>& faults);
  using Look = std::function<Sight()>;
  void play_events(scene::BuiltScene& built, const Look& sight, std::vector<std::string>& faults);
  /// The events that are due, in the order of their times, then of the scene.
  std::vector<std::size_t> take_due(const scene::BuiltScene& built);
  /// A sentence why it could not be done, or nothing.
  std::string play_event(const scene::EventEntry& event, scene::BuiltScene& built, const Look& sight,
                         std::vector<std::string>& faults);
  /// All copies of a body, one after another where it says so.
  void drop_copies(const scene::EventEntry& event, const scene::BuiltScene& built);
  /// A sentence why it could not be done, or nothing.
  std::string bring_in(const scene::EventEntry& event, scene::BuiltScene& built, const Look& sight,
                       std::vector<std::string>& faults);

  const scene::SceneDescription& scene_;
  std::vector<LateCopy> copies_;   // ascending in time
  std::vector<LateCopy> waiting_;  // due, but something is in the way
  std::size_t next_copy_ = 0;
  std::vector<std::size_t> coming_;  // events that have not been played
  Conditions conditions_;
  Forces forces_;
  FilmClock clock_;
  std::vector<scene::Cue> cues_;
  std::vector<Throw> thrown_;
  std::vector<int> throws_;  // per [[body]]: how often it was brought in
};

/// The velocity with which a body thrown from `from` flies through `target` under `gravity` (m/s2), the
/// quicker of the two ways; nothing where the speed does not reach that far.
std::optional<Vec3> aim(const Vec3& from, const Vec3& target, double speed, const Vec3& gravity);

/// What moves, and how it goes on: falling, or at its velocity.
struct MovingTarget {
  Vec3 place = Vec3::Zero();     // m
  Vec3 velocity = Vec3::Zero();  // m/s
  bool is_falling = false;
};
/// The place where something thrown from there would meet it, m; where it is now, if nothing would.
Vec3 lead(const Vec3& from, const MovingTarget& target, double speed, const Vec3& gravity);

}  // namespace shatterbox::sandbox::script
