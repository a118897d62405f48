#include "engine/dynamics/pair_search.h"

#include <algorithm>
#include <cmath>

#include "engine/collision/broad_phase.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/joint_work.h"
#include "engine/dynamics/turned_box.h"

namespace shatterbox::dynamics {
namespace {

using body::Body;
using body::ShapeKind;
using core::at;

// How far impulses may push a body off its predicted way, as shares of its size: what lies still is pushed
// little, and who is pushed further after all is looked about for once more.
constexpr double kMostSlack = 0.015;
constexpr double kLeastSlack = 0.005;
constexpr double kFelt = 0.004;  // the same: further apart nothing is felt

geometry::Box box_at(const WorkBody& w, const Pose& pose) {
  const auto& box = w.collider->box;
  const Mat3 r = pose.rotation.toRotationMatrix();
  const Vec3 centre = pose.translation + r * (0.5 * (box.low + box.high));
  const Vec3 half = r.cwiseAbs() * (0.5 * (box.high - box.low));
  return {centre - half, centre + half};
}

bool may_meet(const Body& a, const Body& b, const WorkBody& wa, const WorkBody& wb) {
  if (!a.is_dynamic() && !b.is_dynamic() && !a.comes_upon(b) && !b.comes_upon(a)) return false;
  if (!wa.is_active && !wb.is_active) return false;
  return a.collides_with(b);
}

void add_pairs_with_planes(const MotionWork& work, const std::vector<char>& is_wanted,
                           std::vector<collision::IndexPair>& pairs) {
  for (std::size_t p = 0; p < work.bodies.size(); ++p) {
    if (work.bodies[p].shape->kind != ShapeKind::plane) continue;
    const Vec3 normal = work.bodies[p].start.rotation * Vec3::UnitY();
    const double level = std::max(normal.dot(work.bodies[p].start.translation),
                                  normal.dot(work.bodies[p].predicted.translation));
    for (std::size_t i = 0; i < work.bodies.size(); ++i) {
      if (work.bodies[i].shape->kind == ShapeKind::plane || (!is_wanted[p] && !is_wanted[i])) continue;
      const auto& box = work.bodies[i].looked;
      const double lowest =
          normal.dot(0.5 * (box.low + box.high)) - normal.cwiseAbs().dot(0.5 * (box.high - box.low));
      if (lowest > level) continue;
      pairs.push_back({static_cast<int>(std::min(p, i)), static_cast<int>(std::max(p, i))});
    }
  }
}

// Boxes about the ways of the bodies in these pairs; of the others none.
std::vector<TurnedBox> box_ways(const MotionWork& work, const std::vector<collision::IndexPair>& pairs) {
  std::vector<char> is_wanted(work.bodies.size(), 0);
  for (const auto& pair : pairs) is_wanted[at(pair.a)] = is_wanted[at(pair.b)] = 1;
  std::vector<TurnedBox> boxes(work.bodies.size());
  for (std::size_t i = 0; i < work.bodies.size(); ++i) {
    const WorkBody& w = work.bodies[i];
    if (is_wanted[i] && w.shape->kind != ShapeKind::plane)
      boxes[i] = turn_box(w.collider->box, w.start, w.looked_end);
  }
  return boxes;
}

}  // namespace

void look_about(const ContactSettings& settings, const Pose& end, WorkBody& w) {
  const double dt = settings.time_step;
  w.looked_end = end;
  const double pull = std::max(settings.gravity.norm(), w.gravity.norm());
  const double size = 2.0 * w.reach;
  w.reserve =
      1.1 * pull * dt * dt + std::min(kMostSlack * size, kLeastSlack * size + travelled_at_most(w, end));
  w.is_looked_straight = !turns_far(w);
  w.looked = box_at(w, w.start);
  if (!w.is_active) return;
  w.looked.include(box_at(w, end));
  const double grow = w.reserve + (w.is_looked_straight ? 0.0 : 1.1 * (turn_bound(w, end) + find_bow(w)));
  w.looked.low.array() -= grow;
  w.looked.high.array() += grow;
}

bool is_within_looked(const ContactSettings& settings, const WorkBody& w) {
  const bool is_straight = !turns_far(w);
  if (is_straight && w.is_looked_straight) {
    const double stray = (w.end.translation - w.looked_end.translation).norm() +
                         turn_bound(w.looked_end.rotation, w.end.rotation, w.reach);
    return stray <= w.reserve - kFelt * 2.0 * w.reach;
  }
  if (w.is_looked_straight) return false;
  const geometry::Box end = box_at(w, w.end);
  const double gap =
      2.0 * settings.kept_gap * w.reach + (is_straight ? 0.0 : turn_bound(w, w.end) + find_bow(w));
  return (end.low.array() - gap >= w.looked.low.array()).all() &&
         (end.high.array() + gap <= w.looked.high.array()).all();
}

std::vector<FoundPair> find_pairs(const std::vector<Body>& bodies, const MotionWork& work,
                                  const std::vector<char>& is_wanted) {
  std::vector<collision::SweptBound> bounds(work.bodies.size());
  for (std::size_t i = 0; i < work.bodies.size(); ++i) {
    const WorkBody& w = work.bodies[i];
    if (w.shape->kind == ShapeKind::plane) continue;  // they have their own loop
    bounds[i] = {w.looked, is_wanted[i] != 0};
  }
  auto near = collision::find_overlapping_pairs(bounds);
  const auto without_planes = static_cast<std::ptrdiff_t>(near.size());
  add_pairs_with_planes(work, is_wanted, near);
  const auto by_number = [](const auto& x, const auto& y) { return x.a < y.a || (x.a == y.a && x.b < y.b); };
  std::sort(near.begin() + without_planes, near.end(), by_number);
  std::inplace_merge(near.begin(), near.begin() + without_planes, near.end(), by_number);
  std::erase_if(near, [&](const collision::IndexPair& pair) {
    return !may_meet(bodies[at(pair.a)], bodies[at(pair.b)], work.bodies[at(pair.a)],
                     work.bodies[at(pair.b)]) ||
           share_pivot(work, pair.a, pair.b);
  });
  const std::vector<TurnedBox> boxes = box_ways(work, near);
  std::vector<double> clearances(near.size(), -1e300);
  std::vector<char> is_near(near.size(), 1);
  core::parallel_for(near.size(), 64, [&](std::size_t k) {
    const WorkBody &a = work.bodies[at(near[k].a)], &b = work.bodies[at(near[k].b)];
    const bool has_plane = a.shape->kind == ShapeKind::plane || b.shape->kind == ShapeKind::plane;
    if (has_plane || !a.is_looked_straight || !b.is_looked_straight) return;
    const double reserve = a.reserve + b.reserve;
    clearances[k] = clearance(boxes[at(near[k].a)], boxes[at(near[k].b)], reserve);
    is_near[k] = clearances[k] <= reserve;
  });
  std::vector<FoundPair> pairs;
  for (std::size_t k = 0; k < near.size(); ++k)
    if (is_near[k]) pairs.push_back({near[k].a, near[k].b, clearances[k]});
  return pairs;
}

}  // namespace shatterbox::dynamics
