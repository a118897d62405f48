// How long the shutter is open, and how wide the lens: several pictures make one frame of the film.
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::run {

class Exposure {
 public:
  explicit Exposure(const scene::CameraEntry& camera);

  /// Pictures that make a frame.
  int samples() const { return samples_; }
  /// Moments into which a frame's time is divided; those of the first samples() are shown. 1: no motion is
  /// blurred.
  int slots() const { return slots_; }
  /// Where on the lens, a disc of radius 1, a sample looks through.
  glm::vec2 lens_point(int sample) const;

 private:
  int samples_ = 1, slots_ = 1;
  bool has_lens_ = false;
};

}  // namespace shatterbox::sandbox::run
