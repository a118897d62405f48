#include "engine/dynamics/path_test.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/collision/analytic_contact.h"
#include "engine/collision/feature_gap.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
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
constexpr double kAmple = 20.0;  // times the kept gap: more room than rounds take

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

// Where a body began is free.
bool stays(const WorkBody& w) {
  return is_same_pose(w.start, w.end) && w.knots.empty();
}

// The centres do not come closer than this on a straight part.
double centre_distance(const Vec3& apart, const Vec3& way) {
  const double length_squared = way.squaredNorm();
  const double t = length_squared > 0.0 ? std::clamp(-apart.dot(way) / length_squared, 0.0, 1.0) : 0.0;
  return (apart + t * way).norm();
}

}  // namespace

bool PathTest::turns_far(const WorkPair& pair) const {
  return work_.bodies[at(pair.a)].straight_parts > 1 || work_.bodies[at(pair.b)].straight_parts > 1;
}

PathTest::Look PathTest::look_at(const WorkPair& pair, double& clear) const {
  clear = -1e300;
  if (pair.is_plane || pair.is_analytic) return Look::listed;
  if (turns_far(pair)) return Look::turning;
  clear = clearance(paths_[at(pair.a)].box, paths_[at(pair.b)].box, kAmple * pair.kept_gap);
  if (clear > pair.kept_gap) return Look::apart;
  const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
  const bool is_known =
      pair.search && strays_from(*pair.search, a, a.end, b, b.end, kLooked * pair.kept_gap) + pair.kept_gap <=
                         pair.search->margin;
  return is_known ? Look::listed : Look::searched;
}

// Boxes about the ways of the bodies in the pairs that are due.
void PathTest::box_ways(const std::vector<char>& is_due) {
  std::vector<char> must_box(work_.bodies.size(), 0);
  for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
    if (is_due[p]) must_box[at(work_.pairs[p].a)] = must_box[at(work_.pairs[p].b)] = 1;
  }
  core::parallel_for(work_.bodies.size(), 32, [&](std::size_t i) {
    const WorkBody& w = work_.bodies[i];
    if (must_box[i] && w.shape->kind != ShapeKind::plane)
      paths_[i].box = turn_box(w.collider->box, w.start, w.end);
  });
}

void PathTest::prepare(const std::vector<char>& is_due) {
  paths_.resize(work_.bodies.size());
  looks_.resize(work_.pairs.size());
  clearances_.resize(work_.pairs.size());
  box_ways(is_due);
  core::parallel_for(work_.pairs.size(), 16, [&](std::size_t p) {
    if (is_due[p]) looks_[p] = look_at(work_.pairs[p], clearances_[p]);
  });
  std::vector<char> must_place(work_.bodies.size(), 0), must_sweep(work_.bodies.size(), 0);
  std::vector<std::size_t> to_search, turning;
  for (std::size_t p = 0; p < work_.pairs.size(); ++p) {
    if (!is_due[p] || looks_[p] == Look::apart) continue;
    const WorkPair& pair = work_.pairs[p];
    must_place[at(pair.a)] = must_place[at(pair.b)] = 1;
    if (looks_[p] == Look::listed) continue;
    must_sweep[at(pair.a)] = must_sweep[at(pair.b)] = 1;
    (looks_[p] == Look::turning ? turning : to_search).push_back(p);
  }
  core::parallel_for(work_.bodies.size(), 8, [&](std::size_t i) {
    WorkBody& w = work_.bodies[i];
    if (!must_place[i] || w.shape->kind == ShapeKind::plane) return;
    place(w);
    place_at(w, w.end, paths_[i].end);
    if (must_sweep[i]) sweep(w, w.end);
  });
  divide(turning);
  core::parallel_for(to_search.size(), 1, [&](std::size_t k) {
    WorkPair& pair = work_.pairs[to_search[k]];
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    // Wider than needed: openings move the ends a little; those that were moved further may be again.
    const double slack = settings_.search_slack * pair.size, before = pair.known.searched;
    const double margin = std::max(2.0 * pair.kept_gap + kStrayed * slack, std::min(kWiden * before, slack));
    pair.search = search_paths(a, a.end, b, b.end, margin);
    pair.known = PathMemory();
    pair.known.searched = margin;
  });
}

int PathTest::level_of(const WorkPair& pair) const {
  const int parts =
      std::max(work_.bodies[at(pair.a)].straight_parts, work_.bodies[at(pair.b)].straight_parts);
  int level = 0;
  while ((1 << level) < parts) ++level;
  return level;
}

// Pairs in which one turns far and that are not surely apart are followed in parts, both bodies in as many.
void PathTest::divide(const std::vector<std::size_t>& turning) {
  in_parts_.resize(work_.pairs.size());
  core::parallel_for(turning.size(), 8, [&](std::size_t k) {
    const WorkPair& pair = work_.pairs[turning[k]];
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    in_parts_[turning[k]] = keep_apart_as_balls(a, a.end, b, b.end, 2.0 * pair.kept_gap) ? 0 : 1;
  });
  std::vector<std::array<bool, kLevels>> needs(work_.bodies.size());
  for (const std::size_t p : turning) {
    if (!in_parts_[p]) continue;
    const int level = level_of(work_.pairs[p]);
    needs[at(work_.pairs[p].a)][at(level)] = needs[at(work_.pairs[p].b)][at(level)] = true;
  }
  core::parallel_for(work_.bodies.size(), 1, [&](std::size_t i) {
    for (int level = 0; level < kLevels; ++level)
      if (needs[i][at(level)]) fill_parts(work_.bodies[i], level, paths_[i]);
  });
}

// A body has one way, whoever it meets: where it is divided further than it turns, vertices stay on the
// straight lines between the ends of its own parts.
void PathTest::fill_parts(const WorkBody& w, int level, Path& path) const {
  const int count = 1 << level, halvings = count / w.straight_parts;
  std::vector<Part>& parts = path.in_parts[at(level)];
  parts.assign(at(count), {});
  std::vector<Vec3> own_begin = w.placed.start, own_end, turned;
  for (int k = 0; k < count; ++k) {
    Part& part = parts[at(k)];
    if (k % halvings == 0) {
      if (k > 0) own_begin = std::move(own_end);
      own_end.clear();
      place_at(w, pose_on_way(w, static_cast<double>(k / halvings + 1) / w.straight_parts), own_end);
    }
    const int done = k % halvings + 1;
    part.to = own_end;
    if (done < halvings) {
      const double share = static_cast<double>(done) / halvings;
      for (std::size_t v = 0; v < part.to.size(); ++v)
        part.to[v] = own_begin[v] + share * (own_end[v] - own_begin[v]);
    }
    const Vec3 whole = w.end.translation - w.start.translation;
    part.centre = w.start.translation + (static_cast<double>(k) / count) * whole;
    part.way = whole / count;
    turned = part.to;
    for (Vec3& p : turned) p -= part.way;
    part.placed.collider = w.collider;
    collision::refit_swept_boxes(part.placed, k == 0 ? w.placed.start : parts[at(k - 1)].to, turned);
  }
}

std::vector<PathHit> PathTest::find_hits(std::size_t pair_number, double& spare) {
  WorkPair& pair = work_.pairs[pair_number];
  std::vector<PathHit> hits;
  spare = 0.0;
  if (stays(work_.bodies[at(pair.a)]) && stays(work_.bodies[at(pair.b)])) return hits;
  if (looks_[pair_number] == Look::apart) {
    spare = clearances_[pair_number] - kSafe * pair.kept_gap;
  } else if (pair.is_plane) {
    hits = test_plane(pair, spare);
  } else if (pair.is_analytic) {
    hits = test_solids(pair);
  } else {
    if (looks_[pair_number] != Look::turning)
      hits = test_straight(pair, spare);
    else if (in_parts_[pair_number])
      hits = test_in_parts(pair, spare);
    else
      spare = pair.kept_gap;
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
    const std::vector<Vec3>& to = part + 1 < parts ? knot : paths_[at(other_number)].end;
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
        find_first_touch({a, pose_on_way(a, begin), pose_on_way(a, end)},
                         {b, pose_on_way(b, begin), pose_on_way(b, end)}, least, pair.kept_gap);
    if (!touch.has_touched) continue;
    for (const auto& c : touch.contacts) hits.push_back({begin + touch.time / parts, end, c, c.gap});
  }
  return hits;
}

std::vector<PathHit> PathTest::test_straight(WorkPair& pair, double& spare) const {
  const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
  const FeatureSearch& search = *pair.search;
  const double safe = kSafe * pair.kept_gap;
  const double ample = kAmple * pair.kept_gap;
  const double reach = safe + approach_bound(a, a.end, b, b.end, motion_bound(a, a.end, b, b.end) + ample);
  // What is beyond the search is at least so far from all that it may stray.
  const double strays = strays_from(search, a, a.end, b, b.end, kLooked * pair.kept_gap);
  spare = std::min(search.margin - strays - safe, pair.kept_gap);
  const double listed =
      search.is_swept ? spare + safe + strays_from(search, a, a.end, b, b.end, ample) : 1e300;
  return follow_features(a, b,
                         {paths_[at(pair.a)].end, paths_[at(pair.b)].end, reach, spare, listed, ample - safe},
                         pair, spare);
}

// A body that turns far is followed through several straight parts.
std::vector<PathHit> PathTest::test_in_parts(const WorkPair& pair, double& spare) const {
  const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
  const std::size_t level = at(level_of(pair));
  const auto &parts_a = paths_[at(pair.a)].in_parts[level], &parts_b = paths_[at(pair.b)].in_parts[level];
  const double safe = kSafe * pair.kept_gap, margin = 2.0 * pair.kept_gap;
  const double share = 1.0 / static_cast<double>(parts_a.size());
  std::vector<PathHit> hits;
  collision::FeatureList list;
  spare = margin - safe;
  for (std::size_t k = 0; k < parts_a.size() && hits.empty(); ++k) {
    const Part &part_a = parts_a[k], &part_b = parts_b[k];
    if (centre_distance(part_a.centre - part_b.centre, part_a.way - part_b.way) > a.reach + b.reach + margin)
      continue;
    collision::list_swept_features(part_a.placed, part_b.placed, part_b.way - part_a.way, margin, list);
    const auto& from_a = k == 0 ? a.placed.start : parts_a[k - 1].to;
    const auto& from_b = k == 0 ? b.placed.start : parts_b[k - 1].to;
    const double begin = share * static_cast<double>(k);
    for (const auto& features : list) {
      const auto from = collision::gather(features, *a.collider, from_a, *b.collider, from_b);
      const auto to = collision::gather(features, *a.collider, part_a.to, *b.collider, part_b.to);
      const Vec3 hint = direction_hint(a, b, from);
      auto path = collision::follow_paths(from, to, safe, hint);
      if (path.has_hit) {  // unless they began closer than that
        const auto start =
            collision::gather(features, *a.collider, a.placed.start, *b.collider, b.placed.start);
        const double start_gap = collision::measure(start, hint).gap;
        const double least = least_separation(start_gap, pair);
        if (least < safe) path = collision::follow_paths(from, to, least, hint);
        if (path.has_hit)
          hits.push_back({begin + share * path.time, begin + share,
                          collision::contact_at_impact(features, start, path.gap), start_gap});
      }
      spare = std::min(spare, path.spare);
    }
  }
  return hits;
}

}  // namespace shatterbox::dynamics
