// The vector types of the engine: double precision, SI units, right-handed, y up.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace shatterbox {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;
using VecX = Eigen::VectorXd;

/// Rigid transform: x_world = rotation * x_body + translation.
struct Pose {
  Quat rotation = Quat::Identity();
  Vec3 translation = Vec3::Zero();  // m

  Vec3 apply(const Vec3& point) const { return rotation * point + translation; }
  Vec3 apply_inverse(const Vec3& point) const { return rotation.conjugate() * (point - translation); }
};

}  // namespace shatterbox
