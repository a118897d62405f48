#include "engine/dynamics/motion_work.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/parallel.h"

namespace shatterbox::dynamics {

void place_at(const WorkBody& body, const Pose& pose, std::vector<Vec3>& out) {
  collision::place_vertices(*body.collider, pose, out);
}

bool MotionWork::has_pair(int a, int b) const {
  const std::pair key(a, b);
  const auto missed = static_cast<std::ptrdiff_t>(missed_pairs.size());
  const auto found =
      std::lower_bound(pairs.begin(), pairs.end() - missed, key,
                       [](const WorkPair& p, const auto& k) { return std::pair(p.a, p.b) < k; });
  if (found != pairs.end() - missed && std::pair(found->a, found->b) == key) return true;
  return std::binary_search(missed_pairs.begin(), missed_pairs.end(), key);
}

void free_pairs(MotionWork& work) {
  core::parallel_for(work.pairs.size(), 64, [&](std::size_t p) { work.pairs[p] = WorkPair(); });
}

Mat3 inertia_at(const WorkBody& body, const Quat& rotation) {
  const Mat3 axes = (rotation * body.inertia.body_from_axes).toRotationMatrix();
  return axes * body.inertia.moments.asDiagonal() * axes.transpose();
}

double kinetic_energy(const WorkBody& body, const Quat& rotation, const Vec3& velocity, const Vec3& spin) {
  return 0.5 * velocity.squaredNorm() / body.inverse_mass + 0.5 * spin.dot(inertia_at(body, rotation) * spin);
}

Mat3 inverse_inertia_at(const WorkBody& body, const Quat& rotation) {
  if (body.locked.any()) return body.locked.invert(inertia_at(body, rotation));
  const Mat3 axes = (rotation * body.inertia.body_from_axes).toRotationMatrix();
  return axes * body.inverse_moments.asDiagonal() * axes.transpose();
}

void advance_turning(const WorkBody& body, double time, Quat& rotation, Vec3& spin) {
  const auto kick = [&] {
    if (!body.torque.isZero(0.0)) spin += 0.5 * time * (inverse_inertia_at(body, rotation) * body.torque);
  };
  kick();
  advance_turn(body.inertia, body.locked, time, SpinOrder::fourth, rotation, spin);
  kick();
}

void place(WorkBody& body) {
  if (body.is_placed) return;
  body.placed.collider = body.collider;
  place_at(body, body.start, body.placed.start);
  body.is_placed = true;
}

void place_in_boxes(WorkBody& body) {
  place(body);
  if (body.placed.boxes.nodes.empty()) collision::refit_boxes(body.placed);
}

Vec3 direction_hint(const WorkBody& a, const WorkBody& b, const collision::FeaturePoints& points) {
  const Vec3& touch = points.points[0];
  if (!body::is_mesh(b.shape->kind)) return touch - b.start.translation;
  if (!body::is_mesh(a.shape->kind)) return a.start.translation - touch;
  return a.start.translation - b.start.translation;
}

Vec3 carry(const WorkBody& body, const Vec3& point, const Pose& from, const Pose& to) {
  if (body.shape->kind == body::ShapeKind::sphere) return point - from.translation + to.translation;
  if (body.shape->kind == body::ShapeKind::capsule) {  // what is nearest on its axis turns with it
    const double half = body.shape->half_length;
    const Vec3 on_axis(0.0, std::clamp(from.apply_inverse(point).y(), -half, half), 0.0);
    return to.apply(on_axis) + (point - from.apply(on_axis));
  }
  return to.apply(from.apply_inverse(point));
}

Pose blend(const Pose& from, const Pose& to, double time) {
  Pose pose;
  pose.translation = from.translation + time * (to.translation - from.translation);
  const double sign = from.rotation.dot(to.rotation) < 0.0 ? -1.0 : 1.0;
  const Quat::Coefficients mixed = (1.0 - time) * from.rotation.coeffs() + time * sign * to.rotation.coeffs();
  pose.rotation = Quat(mixed).normalized();
  return pose;
}

Pose pose_on_way(const WorkBody& body, double time) {
  if (time <= 0.0) return body.start;
  if (time >= 1.0) return body.end;
  if (body.knots.empty()) return blend(body.start, body.end, time);
  const double place = time * static_cast<double>(body.knots.size() - 1);
  const auto knot = std::min(static_cast<std::size_t>(place), body.knots.size() - 2);
  return blend(body.knots[knot], body.knots[knot + 1], place - static_cast<double>(knot));
}

double find_bow(const WorkBody& body) {
  double bow = 0.0;
  for (std::size_t k = 1; k + 1 < body.knots.size(); ++k) {
    const double time = static_cast<double>(k) / static_cast<double>(body.knots.size() - 1);
    const Vec3 straight = body.start.translation + time * (body.end.translation - body.start.translation);
    bow = std::max(bow, (body.knots[k].translation - straight).norm());
  }
  return bow;
}

double free_turn_angle(const WorkBody& body, double time_step) {
  if (body.shape->kind == body::ShapeKind::sphere) return 0.0;
  return time_step * std::max(body.spin_start.norm(), body.predicted_spin.norm());
}

int count_straight_parts(double turn_angle) {
  constexpr int kMost = 64;
  int parts = 1;
  while (parts < kMost && parts * kStraightTurn < turn_angle) parts *= 2;
  return parts;
}

void turn_end(WorkBody& body, const Quat& rotation) {
  const Quat before = body.end.rotation;
  body.end.rotation = rotation;
  if (body.inverse_mass == 0.0 || body.shape->kind == body::ShapeKind::sphere) return;
  const Vec3 spin = body.spin;
  body.spin = rotation * (before.conjugate() * spin);
  if (!body.locked.any()) return;
  body.spin = body.locked.let_turn(body.spin);
  const double most = spin.dot(inertia_at(body, before) * spin);  // twice its energy
  const double now = body.spin.dot(inertia_at(body, rotation) * body.spin);
  if (now > most) body.spin *= std::sqrt(most / now);
}

void shift_end(WorkBody& body, const Vec3& shift, const Vec3& turn) {
  body.end.translation += shift;
  turn_end(body, (rotation_by(turn) * body.end.rotation).normalized());
  body.is_free = false;
  body.turn_angle += turn.norm();
  if (body.knots.empty()) return;
  const double last = static_cast<double>(body.knots.size() - 1);
  for (std::size_t k = 1; k + 1 < body.knots.size(); ++k) {
    const double time = static_cast<double>(k) / last;
    body.knots[k].rotation = (rotation_by(time * turn) * body.knots[k].rotation).normalized();
    body.knots[k].translation += time * shift;
  }
  body.knots.back() = body.end;
}

void shorten(WorkBody& body, double share) {
  body.is_free = false;
  body.gone *= std::max(0.0, share);
  if (share <= 0.0) {
    body.end.translation = body.start.translation;
    turn_end(body, body.start.rotation);
    body.turn_angle = 0.0;
    body.straight_parts = 1;
    body.knots.clear();
    return;
  }
  std::vector<Pose> knots;
  for (std::size_t k = 0; k < body.knots.size(); ++k) {
    const double time = share * static_cast<double>(k) / static_cast<double>(body.knots.size() - 1);
    knots.push_back(pose_on_way(body, time));
  }
  const Pose end = pose_on_way(body, share);
  body.end.translation = end.translation;
  turn_end(body, end.rotation);
  body.knots = std::move(knots);
  body.turn_angle *= share;
}

collision::BodyWay straight_way(const WorkBody& body, const Pose& from, const Pose& to, double begin,
                                double end) {
  collision::BodyWay way;
  way.centre = body.start.translation;
  const auto between = [](double share, const auto& x, const auto& y) {
    return (1.0 - share) * x + share * y;
  };
  const Vec3 way_from = from.translation - way.centre, way_to = to.translation - way.centre;
  way.from = begin == 0.0 ? way_from : Vec3(between(begin, way_from, way_to));
  way.to = end == 1.0 ? way_to : Vec3(between(end, way_from, way_to));
  if (body.shape->kind == body::ShapeKind::sphere) return way;  // its one vertex does not turn
  const auto turned = [&](const Quat& rotation) {
    if (rotation.coeffs() == body.start.rotation.coeffs()) return Mat3(Mat3::Identity());
    return (rotation * body.start.rotation.conjugate()).toRotationMatrix();
  };
  const Mat3 turned_from = turned(from.rotation), turned_to = turned(to.rotation);
  way.turned_from = begin == 0.0 ? turned_from : Mat3(between(begin, turned_from, turned_to));
  way.turned_to = end == 1.0 ? turned_to : Mat3(between(end, turned_from, turned_to));
  way.least_length = std::min(1.0, std::abs(from.rotation.dot(to.rotation)));
  return way;
}

double closest_approach(const Vec3& apart, const Vec3& way) {
  const double length_squared = way.squaredNorm();
  const double t = length_squared > 0.0 ? std::clamp(-apart.dot(way) / length_squared, 0.0, 1.0) : 0.0;
  return (apart + t * way).norm();
}

double clearance_of_balls(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b,
                          double wanted) {
  const Vec3 way_a = end_a.translation - a.start.translation, way_b = end_b.translation - b.start.translation;
  const Vec3 apart = a.start.translation - b.start.translation, way = way_a - way_b;
  const double bows = find_bow(a) + find_bow(b);
  const double between = closest_approach(apart, way) * (1.0 - 1e-9) - (a.reach + b.reach + bows);
  if (between > wanted || (turns_far(a) && turns_far(b))) return between;
  const WorkBody &ball = turns_far(a) ? a : b, &other = turns_far(a) ? b : a;
  const Pose &end_ball = turns_far(a) ? end_a : end_b, &end_other = turns_far(a) ? end_b : end_a;
  const bool may_meet =
      collision::may_meet_ball(other.placed, straight_way(other, other.start, end_other),
                               straight_way(ball, ball.start, end_ball), ball.reach, wanted + bows);
  return may_meet ? between : std::nextafter(wanted, 1e300);
}

double turn_bound(const WorkBody& body, const Pose& end) {
  constexpr double kAllWaysRound = 3.0;  // rad: the end says nothing about the way
  if (body.turn_angle > kAllWaysRound) return 2.0 * body.reach;
  return turn_bound(body.start.rotation, end.rotation, body.reach);
}

std::shared_ptr<const FeatureSearch> search_paths(const WorkBody& a, const Pose& end_a, const WorkBody& b,
                                                  const Pose& end_b, double margin) {
  auto search = std::make_shared<FeatureSearch>();
  search->is_swept = true;
  search->margin = margin;
  search->start_a = a.start;
  search->start_b = b.start;
  search->end_a = end_a;
  search->end_b = end_b;
  collision::list_met_features(a.placed, straight_way(a, a.start, end_a), b.placed,
                               straight_way(b, b.start, end_b), margin, search->features, &search->blocks);
  return search;
}

double travelled_at_most(const WorkBody& body, const Pose& end) {
  return ((end.translation - body.start.translation).norm() + turn_bound(body, end)) * (1.0 + 1e-9);
}

double motion_bound(const WorkBody& a, const Pose& end_a, const WorkBody& b, const Pose& end_b) {
  const Vec3 way = (end_a.translation - a.start.translation) - (end_b.translation - b.start.translation);
  return way.norm() + find_bow(a) + find_bow(b) + turn_bound(a, end_a) + turn_bound(b, end_b);
}

}  // namespace shatterbox::dynamics
