// Where a scripted body is to be at each time: keyframes, and what lies between them.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::body {

/// Angles are about x, then y, then z; each is a number of its own, so that 0 to 4 pi are two turns.
struct Keyframe {
  double time = 0.0;             // s
  Vec3 position = Vec3::Zero();  // m
  Vec3 angles = Vec3::Zero();    // rad
};

/// What each number does from key to key.
enum class Between : std::uint8_t {
  smooth,    // without a jump in speed, at rest at both ends and where it turns round; never beyond its keys
  straight,  // at one speed from key to key
};

class ScriptedPath {
 public:
  /// `keys`: at least one, times ascending. A frame's origin goes from position to position, and the frame
  /// turns about it by the angles, and by `turn` on top. The poses are those of its point `centre` (m).
  explicit ScriptedPath(std::vector<Keyframe> keys, Between between = Between::smooth,
                        const Quat& turn = Quat::Identity(), const Vec3& centre = Vec3::Zero());

  /// Before the first key and after the last it rests there.
  Pose pose_at(double time) const;

  /// True if it is nowhere else between the two times.
  bool rests(double from, double to) const;

  double top_speed() const { return top_speed_; }  // m/s, not less than it ever moves
  double top_spin() const { return top_spin_; }    // rad/s, not less than it ever turns

 private:
  using Numbers = Eigen::Matrix<double, 6, 1>;  // position and angles
  Numbers numbers_at(double time) const;
  Numbers chord(std::size_t key) const;

  std::vector<Keyframe> keys_;
  std::vector<Numbers> slopes_;  // per key, 1/s
  Between between_;
  Quat turn_;
  Vec3 centre_;
  double top_speed_ = 0.0, top_spin_ = 0.0;
};

}  // namespace shatterbox::body
