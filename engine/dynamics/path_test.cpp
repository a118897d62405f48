#include "engine/dynamics/path_test.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/collision/analytic_contact.h"
#include "engine/collision/feature_gap.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/joint_work.h"
#include "engine/dynamics/solid_touch.h"

namespace shatterbox::dynamics {
namespace {

using body::ShapeKind;
using core::at;

constexpr std::size_t kMostHits = 6;
constexpr double kStrayed = 0.1;  // of the slack of searches
constexpr double kWiden = 3.0;    // times the margin of a search that did not last
// times the kept gap: what is looked at, with what is spare and what later rounds move
constexpr double kLooked = 3.0;
constexpr double kMostOff = 0.5;     // of a gap, that a joint may be off
constexpr double kHardlyOff = 1e-6;  // the same, of the pair's size,
constexpr double kOffByTurn = 0.05;  // and times the square of how far it turns in the step
constexpr double kAmple = 20.0;      // times the kept gap: more room than rounds take

void keep_first(std::vector<PathHit>& hits, double size) {
  std::sort(hits.begin(), hits.end(), [](const PathHit& x, const PathHit& y) {
    return x.time < y.time || (x.time == y.time && x.contact.key < y.contact.key);
  });
  std::vector<PathHit> kept;
  for (const PathHit& hit : hits) {
    const bool is_doubled = std::any_of(kept.begin(), kept.end(), [&](const PathHit& k) {
      return k.contact.normal.dot(hit.contact.normal) > 0.97 &&
             (k.contact.on_a - hit.contact.on_a).norm() < 0.02 * size;
    });
    if (!is_doubled) kept.push_back(hit);
    if (kept.size() == kMostHits) break;
  }
  hits = std::move(kept);
}

// No feature that was listed is so near at the start, as far as is known before any test.
bool starts_beyond(const WorkPair& pair, double reach) {
  const auto& gaps = pair.known.start_gaps;
  return pair.known.blocks.empty() && gaps && gaps->search == pair.search && gaps->least > reach;
}

// What a joint holds close together stays as close, but for what the joint is off, and more so where it
// turns: to open that would be to pull at the joint, step after step.
bool is_held_by_joint(const WorkPair& pair, const MotionWork& work) {
  if (pair.joint < 0) return false;
  const double turn = std::min(work.bodies[at(pair.a)].turn_angle, work.bodies[at(pair.b)].turn_angle);
  const double usual = (kHardlyOff + kOffByTurn * turn * turn) * pair.size;
  return off_at_end(work.joints[at(pair.joint)], work) <= std::max(kMostOff * pair.least_gap, usual);
}

// A part of so many of a body's way: all of one of its own straight parts, or a share of that.
SolidWay part_of_way(const WorkBody& w, int part, int parts) {
  const int shares = parts / w.straight_parts, own = part / shares, share = part % shares;
  return {w, pose_on_way(w, static_cast<double>(own) / w.straight_parts),
          pose_on_way(w, static_cast<double>(own + 1) / w.straight_parts),
          static_cast<double>(share) / shares, static_cast<double>(share + 1) / shares};
}

// Where a body began is free.
bool stays(const WorkBody& w) {
  return is_same_pose(w.start, w.end) && w.knots.empty();
}

}  // namespace

PathTest::Look PathTest::look_at(std::size_t pair_number) {
  const WorkPair& pair = work_.pairs[pair_number];
  double& clear = clearances_[pair_number];
  clear = -1e300;
  if (pair.is_plane || pair.is_analytic) return Look::listed;
  const auto turns = [&](int i) { return work_.bodies[at(i)].straight_parts > 1; };
  if (turns(pair.a) || turns(pair.b)) return Look::turning;
  const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
  if (pair.clear > pair.kept_gap) clear = pair.clear - motion_bound(a, a.end, b, b.end);
  if (clear > pair.kept_gap) return Look::apart;
  clear = clearance(boxes_[at(pair.a)], boxes_[at(pair.b)], kAmple * pair.kept_gap);
  if (clear > pair.kept_gap) return Look::apart;
  if (!pair.search) return Look::searched;
  double& strays = strays_[pair_number];
  strays = strays_from(*pair.search, a, a.end, b, b.end, kLooked * pair.kept_gap);
  return strays + pair.kept_gap <= pair.search->margin ? Look::listed : Look::searched;
}

// Boxes about the ways of the bodies in the pairs that are due.
void PathTest::box_ways(const std::vector<std::size_t>& due) {
  std::vector<char> must_box(work_.bodies.size(), 0);
  for (const std::size_t p : due) must_box[at(work_.pairs[p].a)] = must_box[at(work_.pairs[p].b)] = 1;
  core::parallel_for(work_.bodies.size(), 32, [&](std::size_t i) {
    const WorkBody& w = work_.bodies[i];
    if (must_box[i] && w.shape->kind != ShapeKind::plane)
      boxes_[i] = turn_box(w.collider->box, w.start, w.end);
  });
}

void PathTest::prepare(const std::vector<std::size_t>& due) {
  boxes_.resize(work_.bodies.size());
  looks_.resize(work_.pairs.size());
  clearances_.resize(work_.pairs.size());
  strays_.resize(work_.pairs.size());
  box_ways(due);
  core::parallel_for(due.size(), 16, [&](std::size_t k) { looks_[due[k]] = look_at(due[k]); });
  std::vector<char> must_place(work_.bodies.size(), 0), must_box_in(work_.bodies.size(), 0);
  std::vector<std::size_t> to_search, turning;
  for (const std::size_t p : due) {
    if (looks_[p] == Look::apart) continue;
    const WorkPair& pair = work_.pairs[p];
    must_place[at(pair.a)] = must_place[at(pair.b)] = 1;
    if (looks_[p] == Look::listed) continue;
    const bool is_turning = looks_[p] == Look::turning;
    (is_turning ? turning : to_search).push_back(p);
    if (is_turning && turning_.is_listed(pair)) continue;
    must_box_in[at(pair.a)] = must_box_in[at(pair.b)] = 1;
  }
  core::parallel_for(work_.bodies.size(), 8, [&](std::size_t i) {
    WorkBody& w = work_.bodies[i];
    if (!must_place[i] || w.shape->kind == ShapeKind::plane) return;
    place(w);
    place_at(w, w.end, w.end_vertices);
    if (must_box_in[i]) place_in_boxes(w);
  });
  turning_.divide(turning);
  core::parallel_for(to_search.size(), 1, [&](std::size_t k) {
    WorkPair& pair = work_.pairs[to_search[k]];
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    // Wider than needed: openings move the ends a little; those that were moved further may be again.
    const double slack = settings_.search_slack * pair.size, before = pair.known.searched;
    const double margin = std::max(2.0 * pair.kept_gap + kStrayed * slack, std::min(kWiden * before, slack));
    pair.search = search_paths(a, a.end, b, b.end, margin);
    pair.known = PathMemory();
    pair.known.searched = margin;
    strays_[to_search[k]] = strays_from(*pair.search, a, a.end, b, b.end, kLooked * pair.kept_gap);
  });
}

std::vector<PathHit> PathTest::find_hits(std::size_t pair_number, double& spare) {
  WorkPair& pair = work_.pairs[pair_number];
  std::vector<PathHit> hits;
  spare = 0.0;
  if (stays(work_.bodies[at(pair.a)]) && stays(work_.bodies[at(pair.b)])) return hits;
  if (is_held_by_joint(pair, work_)) return hits;
  if (looks_[pair_number] == Look::apart) {
    spare = clearances_[pair_number] - kSafe * pair.kept_gap;
  } else if (pair.is_plane) {
    hits = test_plane(pair, spare);
  } else if (pair.is_analytic) {
    hits = test_solids(pair);
  } else if (looks_[pair_number] == Look::turning) {
    hits = turning_.find_hits(pair_number, spare);
  } else {
    hits = test_straight(pair, strays_[pair_number], spare);
  }
  keep_first(hits, pair.size);
  return hits;
}

std::vector<PathHit> PathTest::test_plane(const WorkPair& pair, double& spare) const {
  const int other_number = pair.is_flipped ? pair.b : pair.a;
  const WorkBody& plane = work_.bodies[at(pair.is_flipped ? pair.a : pair.b)];
  const WorkBody& other = work_.bodies[at(other_number)];
  const Vec3 normal = plane.start.rotation * Vec3::UnitY();
  const auto level_at = [&](double time) {
    return normal.dot(pose_on_way(plane, time).translation) + other.collider->radius;
  };
  std::vector<PathHit> hits;
  const int parts = other.straight_parts;
  std::vector<Vec3> knot;
  spare = 1e300;
  for (int part = 0; part < parts && hits.empty(); ++part) {
    const double begin = static_cast<double>(part) / parts, share = 1.0 / parts;
    const std::vector<Vec3> from = std::exchange(knot, {});
    if (part + 1 < parts) place_at(other, pose_on_way(other, begin + share), knot);
    const std::vector<Vec3>& to = part + 1 < parts ? knot : other.end_vertices;
    const double level_from = level_at(begin), level_to = level_at(begin + share);
    for (std::size_t v = 0; v < to.size(); ++v) {
      const double end = normal.dot(to[v]) - level_to;
      spare = std::min(spare, std::max(0.0, end - kSafe * pair.kept_gap));
      if (end >= kSafe * pair.kept_gap) continue;
      const double start = normal.dot(other.placed.start[v]) - level_at(0.0);
      if (end >= least_separation(start, pair)) continue;
      const double height = part == 0 ? start : normal.dot(from[v]) - level_from;
      PathHit hit;
      hit.time = begin + share * (height > end ? std::clamp(height / (height - end), 0.0, 1.0) : 0.0);
      hit.knot = begin + share;
      hit.contact.key = v;
      hit.contact.gap = hit.start_gap = start;
      hit.contact.is_time_of_impact = true;
      const Vec3 on_other = other.placed.start[v] - other.collider->radius * normal;
      hit.contact.on_a = pair.is_flipped ? Vec3(on_other - start * normal) : on_other;
      hit.contact.on_b = pair.is_flipped ? on_other : Vec3(on_other - start * normal);
      hit.contact.normal = pair.is_flipped ? Vec3(-normal) : normal;
      hit.contact.lean = pair.is_flipped ? 0.0 : 1.0;
      hits.push_back(hit);
    }
  }
  return hits;
}

std::vector<PathHit> PathTest::test_solids(const WorkPair& pair) const {
  const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
  if (pair.least_gap - kSafe * pair.kept_gap > motion_bound(a, a.end, b, b.end)) return {};
  const double least = least_separation(pair.least_gap, pair);
  const int parts = std::max(a.straight_parts, b.straight_parts);
  std::vector<PathHit> hits;
  for (int part = 0; part < parts && hits.empty(); ++part) {
    const double begin = static_cast<double>(part) / parts, end = static_cast<double>(part + 1) / parts;
    const SolidTouch touch =
        find_first_touch(part_of_way(a, part, parts), part_of_way(b, part, parts), least, pair.kept_gap);
    if (!touch.has_touched) continue;
    const double knot = touch.knot == 1.0 ? end : begin + touch.knot / parts;
    for (const auto& c : touch.contacts) hits.push_back({begin + touch.time / parts, knot, c, c.gap});
  }
  return hits;
}

std::vector<PathHit> PathTest::test_straight(WorkPair& pair, double strays, double& spare) const {
  const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
  const FeatureSearch& search = *pair.search;
  const double safe = kSafe * pair.kept_gap;
  const double ample = kAmple * pair.kept_gap;
  const double motion = motion_bound(a, a.end, b, b.end);
  // What is beyond the search is at least so far from all that it may stray.
  spare = std::min(search.margin - strays - safe, pair.kept_gap);
  if (starts_beyond(pair, safe + motion + spare)) return {};
  const double reach = safe + approach_bound(a, a.end, b, b.end, motion + ample);
  const double listed =
      search.is_swept ? spare + safe + strays_from(search, a, a.end, b, b.end, ample) : 1e300;
  return follow_features(a, b, {a.end_vertices, b.end_vertices, reach, spare, listed, ample - safe}, pair,
                         spare);
}

}  // namespace shatterbox::dynamics
