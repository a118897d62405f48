#include "engine/dynamics/feature_search.h"

#include <algorithm>
#include <cmath>

#include "engine/core/index.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {
namespace {

using core::at;

constexpr std::size_t kBlock = 32;  // features of a list that is not swept
constexpr std::size_t kFew = 64;    // features for which a tighter bound is not worth while

// How far the material of a body was moved: by `way` + `turn` (x - the centre) from x.
struct Displacement {
  Vec3 way;
  Mat3 turn;
};

Displacement displacement(const Pose& from, const Pose& to) {
  const Mat3 before = from.rotation.toRotationMatrix();
  return {to.translation - from.translation, (to.rotation.toRotationMatrix() - before) * before.transpose()};
}

// Less another from the same pose.
Displacement operator-(Displacement x, const Displacement& y) {
  x.way -= y.way;
  x.turn -= y.turn;
  return x;
}

Displacement operator*(double s, Displacement x) {
  x.way *= s;
  x.turn *= s;
  return x;
}

// Points of a and b that were within `near` of each other at these poses were moved against each other by no
// more than this: what is common to both motions does not count, nor what is far from the other body.
double relative_bound(const WorkBody& a, const Pose& pose_a, const Displacement& moved_a, const WorkBody& b,
                      const Pose& pose_b, const Displacement& moved_b, double near) {
  if (a.collider->radius > 0.0 || b.collider->radius > 0.0) return 1e300;
  // Where in the space of a they are.
  const geometry::Box &box_a = a.collider->box, &box_b = b.collider->box;
  const Mat3 axes_a = pose_a.rotation.toRotationMatrix(), axes_b = pose_b.rotation.toRotationMatrix();
  const Mat3 from_b = axes_a.transpose() * axes_b;
  const Vec3 between = axes_a.transpose() * (pose_b.translation - pose_a.translation);
  const Vec3 centre = between + from_b * (0.5 * (box_b.low + box_b.high));
  const Vec3 grown = from_b.cwiseAbs() * (0.5 * (box_b.high - box_b.low)) + Vec3::Constant(near);
  const Vec3 low = box_a.low.cwiseMax(centre - grown), high = box_a.high.cwiseMin(centre + grown);
  if ((low.array() > high.array()).any()) return 0.0;
  const Mat3 change = (moved_a.turn - moved_b.turn) * axes_a;
  const Vec3 middle = moved_a.way - moved_b.way - moved_b.turn * (pose_a.translation - pose_b.translation) +
                      change * (0.5 * (low + high));
  const Mat3 sides = change * (0.5 * (high - low)).asDiagonal();
  double most_squared = 0.0;  // greatest at a corner of that box
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0})
        most_squared = std::max(most_squared, (middle + sides * Vec3(x, y, z)).squaredNorm());
  return (std::sqrt(most_squared) + moved_b.turn.norm() * near) * (1.0 + 1e-9);
}

// No two points of a and b were moved against each other by more than this.
double relative_bound(const WorkBody& a, const Displacement& moved_a, const WorkBody& b,
                      const Displacement& moved_b) {
  return (moved_a.way - moved_b.way).norm() + moved_a.turn.norm() * a.reach + moved_b.turn.norm() * b.reach;
}

double moved_at_most(const Pose& from_a, const WorkBody& a, const Pose& to_a, const Pose& from_b,
                     const WorkBody& b, const Pose& to_b) {
  const Vec3 way = (to_a.translation - from_a.translation) - (to_b.translation - from_b.translation);
  return way.norm() + turn_bound(from_a.rotation, to_a.rotation, a.reach) +
         turn_bound(from_b.rotation, to_b.rotation, b.reach);
}

// The same of points that were within `near` of each other.
double moved_where_near(const Pose& from_a, const WorkBody& a, const Pose& to_a, const Pose& from_b,
                        const WorkBody& b, const Pose& to_b, double near) {
  return relative_bound(a, from_a, displacement(from_a, to_a), b, from_b, displacement(from_b, to_b), near);
}

}  // namespace

bool is_same_pose(const Pose& x, const Pose& y) {
  return x.translation == y.translation && x.rotation.coeffs() == y.rotation.coeffs();
}

std::size_t FeatureSearch::block_count() const {
  return is_swept ? blocks.size() : (features.size() + kBlock - 1) / kBlock;
}

std::pair<std::size_t, std::size_t> FeatureSearch::features_of(std::size_t block) const {
  if (!is_swept) return {block * kBlock, std::min((block + 1) * kBlock, features.size())};
  const std::size_t end = block + 1 < blocks.size() ? at(blocks[block + 1].begin) : features.size();
  return {at(blocks[block].begin), end};
}

void PathMemory::forget_ends(const FeatureSearch* search) {
  for (std::size_t number = 0; number < blocks.size(); ++number) {
    blocks[number].free_until = -1.0;
    if (!blocks[number].is_begun) continue;
    const auto [begin, end] = search->features_of(number);
    for (std::size_t i = begin; i < end; ++i) features[i].free_until = -1.0;
  }
  parts.clear();
  part_count = 0;
}

double turn_bound(const Quat& from, const Quat& to, double reach) {
  // |q - p| of unit quaternions is 2 sin(theta / 4); the chord of a point at `reach` is 2 sin(theta / 2)
  // reach.
  const double apart = std::min((from.coeffs() - to.coeffs()).norm(), (from.coeffs() + to.coeffs()).norm());
  return std::min(2.0, 2.0 * apart) * reach;
}

double moved_since(const FeatureSearch& search, const WorkBody& a, const WorkBody& b, double near) {
  const double most = moved_at_most(search.start_a, a, a.start, search.start_b, b, b.start);
  if (most + near <= search.margin) return most;
  return std::min(most,
                  moved_where_near(search.start_a, a, a.start, search.start_b, b, b.start, near + most));
}

StartGaps gaps_of(std::shared_ptr<const FeatureSearch> search) {
  StartGaps gaps{search, search->start_a, search->start_b, {}};
  gaps.gaps.reserve(search->features.size());
  for (const collision::FeaturePair& features : search->features) gaps.gaps.push_back(features.bound);
  return gaps;
}

void carry_gaps(StartGaps& gaps, const WorkBody& a, const WorkBody& b) {
  const Pose &from_a = gaps.start_a, &from_b = gaps.start_b;
  double moved = moved_at_most(from_a, a, a.start, from_b, b, b.start);
  if (moved == 0.0) return;
  // The bound holds for what is so near now; all else is further.
  const double near = gaps.search->margin;
  if (gaps.gaps.size() > kFew)
    moved = std::min(moved, moved_where_near(from_a, a, a.start, from_b, b, b.start, near + moved));
  gaps.start_a = a.start;
  gaps.start_b = b.start;
  for (float& gap : gaps.gaps) gap = collision::round_down(std::min(gap - moved, near));
}

double approach_bound(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b,
                      double near) {
  return std::min(motion_bound(a, end_a, b, end_b),
                  moved_where_near(a.start, a, end_a, b.start, b, end_b, near));
}

double strays_from(const FeatureSearch& search, const WorkBody& a, const Pose& end_a, const WorkBody& b,
                   const Pose& end_b, double near) {
  if (!search.is_swept) {
    // The way of a vertex along a straight path is convex: it is greatest at an end.
    const Pose &from_a = search.start_a, &from_b = search.start_b;
    const double most = std::max(moved_at_most(from_a, a, a.start, from_b, b, b.start),
                                 moved_at_most(from_a, a, end_a, from_b, b, end_b));
    if (most + near <= search.margin) return most;
    return std::min(most, std::max(moved_where_near(from_a, a, a.start, from_b, b, b.start, near + most),
                                   moved_where_near(from_a, a, end_a, from_b, b, end_b, near + most)));
  }
  if (!is_same_pose(search.start_a, a.start) || !is_same_pose(search.start_b, b.start)) return 1e300;
  const Displacement gone_a = displacement(a.start, end_a), gone_b = displacement(b.start, end_b),
                     looked_a = displacement(a.start, search.end_a),
                     looked_b = displacement(b.start, search.end_b);
  const Vec3 looked = looked_a.way - looked_b.way, way = gone_a.way - gone_b.way;
  const double length_squared = looked.squaredNorm();
  const double share = length_squared > 0.0 ? std::clamp(way.dot(looked) / length_squared, 0.0, 1.0) : 1.0;
  // Paths are matched at a share `s` of the way that was looked at: x(t) against the path at s t.
  const auto by = [&](double s) {
    return relative_bound(a, gone_a - s * looked_a, b, gone_b - s * looked_b);
  };
  const double most = std::min({by(share), by(1.0), by(0.0)});
  if (most + near <= search.margin) return most;
  const double reach = near + motion_bound(a, end_a, b, end_b);
  const auto where_near = [&](double s) {
    return relative_bound(a, a.start, gone_a - s * looked_a, b, b.start, gone_b - s * looked_b, reach);
  };
  return std::min({most, where_near(1.0), where_near(share)});
}

}  // namespace shatterbox::dynamics
