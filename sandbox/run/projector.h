// Steps a world from frame to frame of its film: the script plays, the world steps, and a frame shows the
// moment that is due, between two steps too.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "sandbox/run/inspector.h"
#include "sandbox/run/recorder.h"
#include "sandbox/run/throws.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/script/script.h"
#include "sandbox/view/reframing.h"
#include "sandbox/view/view.h"

namespace shatterbox::sandbox::run {

class Projector {
 public:
  /// All must outlive it. Shows `slots` moments of each frame, evenly over its time.
  Projector(const scene::SceneDescription& scene, scene::BuiltScene& built, Recorder& recorder,
            bool has_audit, int frames_per_second, int slots = 1);

  /// Whoever is to be asked whether the film is to break off, in the middle of a step too; until then it is
  /// whether the run is interrupted.
  void set_stop(core::StopQuestion wants_to_stop);

  /// Steps to the next moment, which is good until the next call; nothing when the film is over or broken
  /// off.
  std::optional<view::Moment> next();

  /// What the script asked of the picture up to that moment.
  std::vector<scene::Cue> take_cues() { return std::exchange(cues_, {}); }

  /// The world's time that the frame after the last one will show first, s, unless the script changes that.
  double time_ahead() const;

  /// Steps on to the end of the scene: the last frame's picture shows its begin. Then it is known what hit
  /// nothing.
  void finish();

 private:
  /// False if the step was broken off.
  bool step(double film);
  /// Before the coming step.
  view::Moment now() const;
  view::Whereabouts whereabouts() const;
  /// The camera before the coming step.
  script::Sight look();
  /// The step border, in steps, of a moment of the film; whole where it is one.
  double steps_at(double film) const;
  long last_step() const;

  const scene::SceneDescription& scene_;
  scene::BuiltScene& built_;
  Recorder& recorder_;
  script::Script script_;
  view::CameraRig rig_;  // as the script sees it: at step borders, whatever frames there are
  view::Reframing reframing_;
  Inspector inspector_;
  Throws throws_;
  core::StopQuestion wants_to_stop_;
  int frames_per_second_, slots_;
  int slot_ = -1;                   // of the last moment, counted through all frames
  std::vector<body::Body> before_;  // before the last step, if a frame shows a moment within it
  long steps_before_ = -1;
  std::vector<body::Body> between_;
  std::vector<scene::Cue> cues_;
};

}  // namespace shatterbox::sandbox::run
