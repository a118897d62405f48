// Axes of the world along which, and about which, a body does not move, whatever pushes it: a wheel on its
// axle, a piston, a scene in a plane. Who holds it takes what an impulse would give it along them, wherever
// it acts.
#pragma once

#include <array>

#include "engine/core/vec.h"

namespace shatterbox::body {

/// What yields to an impulse by no more than this, as a share of what it would if nothing were locked, does
/// not.
inline constexpr double kLeastYield = 1e-9;

struct LockedAxes {
  std::array<bool, 3> moves{}, turns{};  // of the centre of mass along, and about, x, y, z

  bool any() const { return any_of(moves) || any_of(turns); }
  bool is_all() const { return let_move(Vec3::Ones()).isZero(0.0) && let_turn(Vec3::Ones()).isZero(0.0); }
  /// What is left of a velocity, acceleration or way.
  Vec3 let_move(const Vec3& way) const { return cleared(way, moves); }
  /// What is left of a spin or couple.
  Vec3 let_turn(const Vec3& turn) const { return cleared(turn, turns); }
  /// How far it yields to an impulse along a unit direction, as a share of what it would unlocked.
  double share_along(const Vec3& direction) const {
    return any_of(moves) ? let_move(direction).squaredNorm() : 1.0;
  }
  /// How many axes it may turn about.
  int count_turns() const { return 3 - turns[0] - turns[1] - turns[2]; }
  /// Spin by angular impulse (world, 1/(kg m2)) of a body with this inertia (world, kg m2): S (S^T I S)^-1
  /// S^T, where S are the axes that it may turn about.
  Mat3 invert(const Mat3& inertia) const;
  /// What several bodies must keep to that move as one, `others` of one more among them.
  void unite(const LockedAxes& others);

 private:
  static bool any_of(const std::array<bool, 3>& axes) { return axes[0] || axes[1] || axes[2]; }
  static Vec3 cleared(const Vec3& v, const std::array<bool, 3>& axes) {
    return {axes[0] ? 0.0 : v[0], axes[1] ? 0.0 : v[1], axes[2] ? 0.0 : v[2]};
  }
};

}  // namespace shatterbox::body
