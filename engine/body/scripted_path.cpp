// Between keys: straight lines, or monotone cubics with the slopes of Fritsch and Butland [FB84].
#include "engine/body/scripted_path.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"

namespace shatterbox::body {
namespace {

Quat turn_about(double angle, const Vec3& axis) {
  const auto [s, c] = core::sin_cos(0.5 * angle);
  return {c, s * axis.x(), s * axis.y(), s * axis.z()};
}

// The slope at a key between two chords of these lengths (s): none where they turn round, and nowhere so
// steep that the cubic would leave its keys.
double slope_between(double before, double after, double time_before, double time_after) {
  if (before * after <= 0.0) return 0.0;
  const double weight_before = 2.0 * time_after + time_before;
  const double weight_after = time_after + 2.0 * time_before;
  return (weight_before + weight_after) / (weight_before / before + weight_after / after);
}

}  // namespace

ScriptedPath::ScriptedPath(std::vector<Keyframe> keys, Between between, const Quat& turn, const Vec3& centre)
    : keys_(std::move(keys)), between_(between), turn_(turn), centre_(centre) {
  slopes_.assign(keys_.size(), Numbers::Zero());
  for (std::size_t k = 1; k + 1 < keys_.size(); ++k) {
    const Numbers before = chord(k - 1), after = chord(k);
    for (int i = 0; i < 6; ++i)
      slopes_[k][i] = slope_between(before[i], after[i], keys_[k].time - keys_[k - 1].time,
                                    keys_[k + 1].time - keys_[k].time);
  }
  for (std::size_t k = 0; k + 1 < keys_.size(); ++k) {
    Numbers fastest = chord(k).cwiseAbs();
    if (between_ == Between::smooth) {
      // The speed is a parabola in time: fastest at an end or where it is between them 1.5 chords less a
      // quarter of the ends, at most.
      const Numbers ends = slopes_[k].cwiseAbs().cwiseMax(slopes_[k + 1].cwiseAbs());
      fastest = ends.cwiseMax(1.5 * fastest);
    }
    // The centre goes round the frame's origin.
    const double spin = fastest.tail<3>().sum();
    top_spin_ = std::max(top_spin_, spin);
    top_speed_ = std::max(top_speed_, fastest.head<3>().norm() + spin * centre_.norm());
  }
}

ScriptedPath::Numbers ScriptedPath::chord(std::size_t key) const {
  const Keyframe &from = keys_[key], &to = keys_[key + 1];
  Numbers way;
  way << to.position - from.position, to.angles - from.angles;
  return way / (to.time - from.time);
}

ScriptedPath::Numbers ScriptedPath::numbers_at(double time) const {
  const auto numbers = [&](std::size_t k) {
    Numbers n;
    n << keys_[k].position, keys_[k].angles;
    return n;
  };
  if (time <= keys_.front().time) return numbers(0);
  if (time >= keys_.back().time) return numbers(keys_.size() - 1);
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                      [](double t, const Keyframe& key) { return t < key.time; });
  const auto k = static_cast<std::size_t>(after - keys_.begin()) - 1;
  const double span = keys_[k + 1].time - keys_[k].time, since = time - keys_[k].time;
  if (between_ == Between::straight) return numbers(k) + since * chord(k);
  const double s = since / span;
  const Numbers from = slopes_[k], mean = chord(k), to = slopes_[k + 1];
  return numbers(k) + since * (from + s * ((3.0 * mean - 2.0 * from - to) + s * (from + to - 2.0 * mean)));
}

Pose ScriptedPath::pose_at(double time) const {
  const Numbers n = numbers_at(time);
  Pose pose;
  pose.rotation = (turn_ * turn_about(n[5], Vec3::UnitZ()) * turn_about(n[4], Vec3::UnitY()) *
                   turn_about(n[3], Vec3::UnitX()))
                      .normalized();
  pose.translation = n.head<3>() + pose.rotation * centre_;
  return pose;
}

bool ScriptedPath::rests(double from, double to) const {
  for (std::size_t k = 0; k + 1 < keys_.size(); ++k) {
    const bool is_passed = keys_[k].time < to && keys_[k + 1].time > from;
    if (is_passed && chord(k).squaredNorm() > 0.0) return false;
  }
  return true;
}

}  // namespace shatterbox::body
