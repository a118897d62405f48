#include "sandbox/run/exposure.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::sandbox::run {

Exposure::Exposure(const scene::CameraEntry& camera) : has_lens_(camera.aperture > 0.0) {
  if (camera.shutter <= 0.0 && !has_lens_) return;
  samples_ = camera.samples;
  if (camera.shutter > 0.0)
    slots_ = std::max(samples_, static_cast<int>(std::lround(samples_ / camera.shutter)));
}

// A spiral of golden angles fills the disc evenly; the first sample looks through its middle. It is taken in
// strides, so that what moves is not seen first through the lens's middle and last through its rim.
glm::vec2 Exposure::lens_point(int sample) const {
  if (!has_lens_) return {0.0F, 0.0F};
  constexpr double kGoldenAngle = 2.399963229728653;
  const int turn = sample % 2 == 0 ? sample / 2 : samples_ - 1 - sample / 2;
  const double radius = std::sqrt(turn / (samples_ - 1.0)), angle = kGoldenAngle * turn;
  return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle))};
}

}  // namespace shatterbox::sandbox::run
