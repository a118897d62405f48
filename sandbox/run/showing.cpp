#include "sandbox/run/showing.h"

#include <algorithm>

#include "engine/core/clock.h"

namespace shatterbox::sandbox::run {

using core::Clock;
using core::milliseconds_since;

Showing::Showing(Job& job, Recorder& recorder, int shot)
    : job_(job),
      recorder_(recorder),
      exposure_(job.scene->camera),
      projector_(*job.scene, *job.built, recorder, job.options.has_audit, job.options.frames_per_second,
                 exposure_.slots()),
      view_(*job.scene, *job.built, shot),
      stills_(job.options.stills),
      has_all_(stills_.empty()) {
  if (job.options.has_trace) recorder.watch(job.built->world);
}

bool Showing::takes(double ahead) {
  return std::erase_if(stills_, [ahead](double time) { return time < ahead - 1e-9; }) > 0 || has_all_;
}

bool Showing::advance() {
  const auto start = Clock::now();
  audited_ = recorder_.record.audit_time;
  moment_ = projector_.next();
  if (!moment_) return false;
  for (const scene::Cue& cue : projector_.take_cues()) view_.begin(cue, *moment_);
  is_due_ = takes(projector_.time_ahead());
  simulated_ = milliseconds_since(start);
  return true;
}

std::vector<render::Frame> Showing::expose(bool is_drawn) {
  const auto start = Clock::now();
  std::vector<render::Frame> samples;
  std::optional<view::Moment> now = moment_;
  const int samples_a_slot = exposure_.slots() == 1 ? exposure_.samples() : 1;
  for (int slot = 0; slot < exposure_.slots(); ++slot) {
    if (slot > 0) {
      now = projector_.next();
      if (!now) break;
      for (const scene::Cue& cue : projector_.take_cues()) view_.begin(cue, *now);
    }
    for (int i = 0; is_drawn && i < samples_a_slot && slot < exposure_.samples(); ++i) {
      const auto number = static_cast<int>(samples.size());
      samples.push_back(view_.make_frame(*now, exposure_.lens_point(number)));
      samples.back().caption = samples.front().caption;  // numbers are not blurred
      samples.back().title = samples.front().title;
    }
  }
  const double audit = recorder_.record.audit_time - audited_;
  recorder_.note_frame(world(), simulated_ + milliseconds_since(start) - audit, audit);
  return samples;
}

void Showing::finish() {
  projector_.finish();
  recorder_.note_parts(view_.inventory());
}

int Showing::shown() const {
  return static_cast<int>(projector_.time_ahead() * job_.options.frames_per_second + 1e-6);
}

int Showing::expected() const {
  return std::max(1, static_cast<int>(job_.scene->seconds * job_.options.frames_per_second + 0.5));
}

}  // namespace shatterbox::sandbox::run
