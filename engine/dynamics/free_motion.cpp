#include "engine/dynamics/free_motion.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/core/elementary.h"

namespace shatterbox::dynamics {
namespace {

// State of the split flows: rotation (world from principal axes) and angular momentum in these axes.
struct Spin {
  Quat rotation;
  Vec3 momentum;

  void turn_about(int axis, double angle) {
    const auto [s, c] = core::sin_cos(0.5 * angle);
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    // rotation times (c, s along the axis), without the zeros
    auto& q = rotation.coeffs();
    const double w = q[3], x = q[axis], y = q[i], z = q[j];
    q[3] = c * w - s * x;
    q[axis] = c * x + s * w;
    q[i] = c * y + s * z;
    q[j] = c * z - s * y;
    const double cos_full = 1.0 - 2.0 * s * s, sin_full = 2.0 * s * c;
    const double mi = momentum[i], mj = momentum[j];
    momentum[i] = cos_full * mi + sin_full * mj;
    momentum[j] = cos_full * mj - sin_full * mi;
  }

  // Strang's splitting without its first and last turn, which neighbours share: `turn_first` does those.
  void turn_first(const Vec3& moments, double time) { turn_about(0, time * momentum[0] / moments[0]); }
  void turn_rest(const Vec3& moments, double time) {
    turn_about(1, 0.5 * time * momentum[1] / moments[1]);
    turn_about(2, time * momentum[2] / moments[2]);
    turn_about(1, 0.5 * time * momentum[1] / moments[1]);
  }
};

// Of a turn with locked axes. A slender body's spin about its own axis may grow a hundredfold while it turns:
// what would change its energy by more is followed in halves, and what they do not reach is not turned in
// that time.
constexpr double kEnergyError = 1e-6;
constexpr int kMostTries = 10000;

// In which a turn of so much (rad) is followed.
int count_parts(double angle) {
  constexpr double kMostAngle = 0.05;  // rad a part, unless there would be too many
  constexpr double kMostParts = 4000.0;
  return 1 + static_cast<int>(std::min(angle / kMostAngle, kMostParts));
}

}  // namespace

PrincipalInertia find_principal_inertia(const Mat3& inertia) {
  PrincipalInertia result;
  const double scale = inertia.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) {
    result.is_round = true;
    return result;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
  Mat3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) = -axes.col(0);
  const Vec3 moments = solver.eigenvalues();
  result.moments = moments.cwiseMax(1e-12 * moments[2]);
  result.body_from_axes = Quat(axes).normalized();
  result.is_round = moments[2] - moments[0] <= 1e-12 * moments[2];
  return result;
}

Quat rotation_by(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle < 1e-150) return Quat::Identity();
  const Vec3 axis = rotation_vector * (core::sin(0.5 * angle) / angle);
  return Quat(core::cos(0.5 * angle), axis.x(), axis.y(), axis.z());
}

Vec3 turn_between(const Quat& from, const Quat& to) {
  Quat way = to * from.conjugate();
  if (way.w() < 0.0) way.coeffs() = -way.coeffs();
  const double sine = way.vec().norm();
  if (sine < 1e-150) return Vec3::Zero();
  return way.vec() * (2.0 * core::atan2(sine, way.w()) / sine);
}

void advance_spin(const PrincipalInertia& inertia, double time, SpinOrder order, Quat& rotation, Vec3& spin) {
  constexpr double kSuzuki = 0.4144907717943757;  // 1 / (4 - 4^(1/3))
  const double speed = spin.norm();
  if (speed * time < 1e-150) return;
  if (inertia.is_round) {
    rotation = (rotation_by(time * spin) * rotation).normalized();
    return;
  }
  Spin s;
  s.rotation = rotation * inertia.body_from_axes;
  s.momentum = inertia.moments.cwiseProduct(s.rotation.conjugate() * spin);
  const Vec3 momentum_world = s.rotation * s.momentum;
  const int parts = count_parts(speed * time);
  const double part = time / parts;
  static constexpr std::array<double, 1> kOnce = {1.0};
  static constexpr std::array<double, 5> kFive = {kSuzuki, kSuzuki, 1.0 - 4.0 * kSuzuki, kSuzuki, kSuzuki};
  const std::span<const double> shares =
      order == SpinOrder::second ? std::span<const double>(kOnce) : std::span<const double>(kFive);
  double first = 0.5 * shares.front() * part;  // of the turn about the first axis, still to be done
  for (int i = 0; i < parts; ++i) {
    for (std::size_t k = 0; k < shares.size(); ++k) {
      s.turn_first(inertia.moments, first);
      s.turn_rest(inertia.moments, shares[k] * part);
      first = 0.5 * (shares[k] + shares[(k + 1) % shares.size()]) * part;
    }
  }
  s.turn_first(inertia.moments, 0.5 * shares.back() * part);
  s.rotation.normalize();
  // From the momentum in the world, which is kept, not from the rotated one, which gathers rounding.
  spin = s.rotation * (s.rotation.conjugate() * momentum_world).cwiseQuotient(inertia.moments);
  rotation = (s.rotation * inertia.body_from_axes.conjugate()).normalized();
}

void advance_locked_spin(const PrincipalInertia& inertia, const body::LockedAxes& locked, double time,
                         Quat& rotation, Vec3& spin) {
  const double speed = spin.norm();
  if (speed * time < 1e-150) return;
  if (inertia.is_round || locked.count_turns() == 1) {
    rotation = (rotation_by(time * spin) * rotation).normalized();
    return;
  }
  const auto inertia_at = [&](const Quat& at) {
    const Mat3 axes = (at * inertia.body_from_axes).toRotationMatrix();
    return Mat3(axes * inertia.moments.asDiagonal() * axes.transpose());
  };
  const Vec3 momentum = locked.let_turn(inertia_at(rotation) * spin);
  const double energy = momentum.dot(spin);  // twice
  const double longest = time / count_parts(speed * time);
  double left = time, part = longest;
  for (int tries = 0; left > 1e-12 * time && tries < kMostTries; ++tries) {
    part = std::min(part, left);
    // The turn of a part at the spin that the body has where a turn by `so_far` brings it.
    const auto turn = [&](const Vec3& so_far) {
      return Vec3(part * (locked.invert(inertia_at(rotation_by(so_far) * rotation)) * momentum));
    };
    const Vec3 first = turn(Vec3::Zero());
    const Vec3 second = turn(0.5 * first);
    const Vec3 third = turn(0.5 * second - 0.125 * first.cross(second));
    const Vec3 fourth = turn(third);
    const Vec3 whole = (first + 2.0 * second + 2.0 * third + fourth) / 6.0 - first.cross(fourth) / 12.0;
    const Quat turned = (rotation_by(whole) * rotation).normalized();
    const Vec3 then = locked.invert(inertia_at(turned)) * momentum;
    if (!(std::abs(momentum.dot(then) - energy) < kEnergyError * energy)) {
      part *= 0.5;
      continue;
    }
    rotation = turned;
    spin = then;
    left -= part;
    part = std::min(longest, 1.2 * part);
  }
}

void advance_turn(const PrincipalInertia& inertia, const body::LockedAxes& locked, double time,
                  SpinOrder order, Quat& rotation, Vec3& spin) {
  if (locked.any())
    advance_locked_spin(inertia, locked, time, rotation, spin);
  else
    advance_spin(inertia, time, order, rotation, spin);
}

}  // namespace shatterbox::dynamics
