#include "engine/dynamics/feature_search.h"

#include <algorithm>
#include <cmath>

#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {
namespace {

bool is_same(const Pose& x, const Pose& y) {
  return x.translation == y.translation && x.rotation.coeffs() == y.rotation.coeffs();
}

// Paths are matched at the share `s` of the way that was looked at: x(t) against the path at s t.
double strays_at(double s, const FeatureSearch& f, const WorkBody& a, const Pose& end_a, const WorkBody& b,
                 const Pose& end_b) {
  const auto relative = [](const Pose& start_a, const Pose& to_a, const Pose& start_b, const Pose& to_b) {
    return Vec3((to_a.translation - start_a.translation) - (to_b.translation - start_b.translation));
  };
  const Vec3 way =
      relative(a.start, end_a, b.start, end_b) - s * relative(f.start_a, f.end_a, f.start_b, f.end_b);
  const auto turn = [s](const WorkBody& w, const Pose& end, const Pose& looked) {
    if (w.reach == 0.0 || (!w.is_active && is_same(end, looked))) return 0.0;
    const Mat3 from = w.start.rotation.toRotationMatrix();
    const Mat3 change =
        (end.rotation.toRotationMatrix() - from) - s * (looked.rotation.toRotationMatrix() - from);
    return change.norm() * w.reach;
  };
  return way.norm() + turn(a, end_a, f.end_a) + turn(b, end_b, f.end_b);
}

}  // namespace

double turn_bound(const Quat& from, const Quat& to, double reach) {
  // |q - p| of unit quaternions is 2 sin(theta / 4); the chord of a point at `reach` is 2 sin(theta / 2)
  // reach.
  const double apart = std::min((from.coeffs() - to.coeffs()).norm(), (from.coeffs() + to.coeffs()).norm());
  return std::min(2.0, 2.0 * apart) * reach;
}

double moved_since(const FeatureSearch& search, const WorkBody& a, const Pose& pose_a, const WorkBody& b,
                   const Pose& pose_b) {
  const Vec3 way =
      (pose_a.translation - search.start_a.translation) - (pose_b.translation - search.start_b.translation);
  return way.norm() + turn_bound(search.start_a.rotation, pose_a.rotation, a.reach) +
         turn_bound(search.start_b.rotation, pose_b.rotation, b.reach);
}

double strays_from(const FeatureSearch& search, const WorkBody& a, const Pose& end_a, const WorkBody& b,
                   const Pose& end_b) {
  if (!search.is_swept) {
    // The way of a vertex along a straight path is convex: it is greatest at an end.
    return std::max(moved_since(search, a, a.start, b, b.start), moved_since(search, a, end_a, b, end_b));
  }
  if (!is_same(search.start_a, a.start) || !is_same(search.start_b, b.start)) return 1e300;
  const Vec3 looked = (search.end_a.translation - search.start_a.translation) -
                      (search.end_b.translation - search.start_b.translation);
  const Vec3 way = (end_a.translation - a.start.translation) - (end_b.translation - b.start.translation);
  const double length_squared = looked.squaredNorm();
  const double share = length_squared > 0.0 ? std::clamp(way.dot(looked) / length_squared, 0.0, 1.0) : 1.0;
  const auto at = [&](double s) { return strays_at(s, search, a, end_a, b, end_b); };
  return std::min({at(share), at(1.0), at(0.0)});
}

}  // namespace shatterbox::dynamics
