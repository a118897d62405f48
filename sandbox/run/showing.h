// One scene while it is shown: its world steps from frame to frame of the film, and each frame's pictures are
// made when they are wanted.
#pragma once

#include <optional>
#include <vector>

#include "sandbox/run/exposure.h"
#include "sandbox/run/job.h"
#include "sandbox/run/projector.h"
#include "sandbox/view/view.h"

namespace shatterbox::sandbox::run {

class Showing {
 public:
  /// Both must outlive it. Showings whose pictures one renderer draws have different numbers of their `shot`.
  Showing(Job& job, Recorder& recorder, int shot);

  /// Steps to the next frame. False when the film is over.
  bool advance();
  /// The first moment of the frame; good until expose().
  const view::Moment& moment() const { return *moment_; }
  /// Whether the frame shows a moment that is asked for.
  bool is_due() const { return is_due_; }
  /// What is not drawn has been seen all the same: the camera remembers whom it follows.
  void pass_over() { (void)view_.camera_at(*moment_); }

  /// Steps on while the shutter is open, and books the frame. The pictures of which the frame is the mean, if
  /// it is drawn.
  std::vector<render::Frame> expose(bool is_drawn);

  /// How far the film is, in frames of the world's time.
  int shown() const;
  /// How many they will be, at true speed.
  int expected() const;
  /// Steps on to the end of the scene.
  void finish();

  const world::World& world() const { return job_.built->world; }
  view::View& view() { return view_; }

 private:
  bool takes(double ahead);

  Job& job_;
  Recorder& recorder_;
  Exposure exposure_;
  Projector projector_;
  view::View view_;
  std::vector<double> stills_;  // s, not drawn yet
  bool has_all_;                // frames are drawn
  std::optional<view::Moment> moment_;
  bool is_due_ = false;
  double simulated_ = 0.0, audited_ = 0.0;  // ms of this frame so far; ms before it
};

}  // namespace shatterbox::sandbox::run
