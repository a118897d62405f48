#include "sandbox/view/camera.h"

#include <algorithm>
#include <cmath>

namespace shatterbox::sandbox::view {

namespace {

/// Position, target and field of view as one point of a space in which the path runs.
Eigen::Matrix<double, 7, 1> point_of(const scene::CameraKey& key) {
  Eigen::Matrix<double, 7, 1> point;
  point << key.position, key.target, key.fov;
  return point;
}

scene::CameraKey on_path(const std::vector<scene::CameraKey>& path, double time) {
  if (time <= path.front().at || path.size() == 1) return path.front();
  if (time >= path.back().at) return path.back();
  const auto after = std::upper_bound(path.begin(), path.end(), time,
                                      [](double t, const scene::CameraKey& key) { return t < key.at; });
  const auto i = static_cast<std::size_t>(after - path.begin());
  const auto slope = [&path](std::size_t k) -> Eigen::Matrix<double, 7, 1> {
    if (k == 0 || k + 1 == path.size())
      return Eigen::Matrix<double, 7, 1>::Zero();  // starts and ends at rest
    return (point_of(path[k + 1]) - point_of(path[k - 1])) / (path[k + 1].at - path[k - 1].at);
  };
  const double span = path[i].at - path[i - 1].at;
  const double s = (time - path[i - 1].at) / span;
  const double s2 = s * s, s3 = s2 * s;
  const Eigen::Matrix<double, 7, 1> point =
      (2 * s3 - 3 * s2 + 1) * point_of(path[i - 1]) + (s3 - 2 * s2 + s) * span * slope(i - 1) +
      (3 * s2 - 2 * s3) * point_of(path[i]) + (s3 - s2) * span * slope(i);
  return {time, point.head<3>(), point.segment<3>(3), point[6]};
}

/// How much of its way it has made, 0 to 1; a mean over a tenth of a second, so that the camera stops softly.
double fallen_share(const Fall& fall, double time) {
  constexpr int kSamples = 5;  // before and after
  constexpr double kApart = 0.01;
  double sum = 0.0;
  for (int i = -kSamples; i <= kSamples; ++i) {
    const double t = std::max(time + kApart * i, 0.0);
    sum += std::min((fall.speed + 0.5 * fall.acceleration * t) * t / std::max(fall.way, 1e-9), 1.0);
  }
  return sum / (2 * kSamples + 1);
}

}  // namespace

Viewpoint viewpoint_at(const scene::CameraEntry& camera, const Subject& subject, double time) {
  if (!camera.path.empty()) {
    const scene::CameraKey key = on_path(camera.path, time);
    return {key.position, key.target, key.fov};
  }
  const Framing framing{camera.up, camera.fov, camera.target};
  if (camera.position) return {*camera.position, camera.target.value_or(subject.centre), camera.fov};
  if (!subject.fall || camera.target) return frame_points(subject.corners, framing);
  const double share = fallen_share(*subject.fall, time);
  const Viewpoint from = frame_points(subject.fall->from, framing),
                  to = frame_points(subject.fall->to, framing);
  return {from.position + share * (to.position - from.position),
          from.target + share * (to.target - from.target), camera.fov, from.least_aspect};
}

}  // namespace shatterbox::sandbox::view
