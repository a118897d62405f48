#include "engine/dynamics/turning_paths.h"

#include <algorithm>
#include <utility>

#include "engine/collision/feature_gap.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"

namespace shatterbox::dynamics {
namespace {

using core::at;
using Positions = std::vector<Vec3>;

constexpr double kNear = 2.0;    // times the kept gap: what is nearer is followed
constexpr double kSlack = 0.05;  // of the slack of searches
constexpr double kGrow = 3.0;    // times the margin of lists that did not last
constexpr std::size_t kFeaturesToFollow = 512;

// Where both bodies of a pair are at the ends of a straight part.
struct PartEnds {
  const Positions &from_a, &to_a, &from_b, &to_b;
  double begin = 0.0, share = 1.0;  // of the step
};

// Some features of a pair on a straight part, one after the other.
class PartFollower {
 public:
  PartFollower(const WorkBody& a, const WorkBody& b, const PartEnds& ends, const WorkPair& pair,
               PathMemory::Part& known, double spare)
      : a_(a), b_(b), ends_(ends), pair_(pair), known_(known), safe_(kSafe * pair.kept_gap), spare_(spare) {}

  void follow(std::size_t i) {
    const double moved = pair_.known.moved;
    double& free_until = known_.free_until[i];
    if (free_until > moved) {
      spare_ = std::min(spare_, free_until - moved);
      return;
    }
    const collision::FeaturePair& features = known_.features[i];
    const double apart = parting_ == Vec3::Zero() ? 0.0 : part_along(features, parting_);
    if (apart > 0.0 && apart >= spare_) {
      free_until = moved + apart;
      return;
    }
    const auto from = collision::gather(features, *a_.collider, ends_.from_a, *b_.collider, ends_.from_b);
    const auto to = collision::gather(features, *a_.collider, ends_.to_a, *b_.collider, ends_.to_b);
    const Vec3 hint = direction_hint(a_, b_, from);
    const collision::FeatureGap gap = collision::measure(from, hint);
    parting_ = gap.normal;
    const auto path = collision::follow_paths(from, to, safe_, hint, &gap);
    if (path.has_hit) return add_hit(features, from, to, hint, path);
    spare_ = std::min(spare_, path.spare);
    free_until = moved + path.spare;
  }

  double spare() const { return spare_; }
  std::vector<PathHit>& hits() { return hits_; }

 private:
  // By how much they stay apart along one direction, beyond what is safe, m.
  double part_along(const collision::FeaturePair& features, const Vec3& direction) const {
    const auto along = [&](const Positions& at_a, const Positions& at_b) {
      return collision::separation_along(features, *a_.collider, at_a, *b_.collider, at_b, direction);
    };
    const double then = along(ends_.to_a, ends_.to_b) - safe_;
    return then > 0.0 ? std::min(then, along(ends_.from_a, ends_.from_b) - safe_) : then;
  }

  // Unless they began closer than what is safe, and come no closer than that allows.
  void add_hit(const collision::FeaturePair& features, const collision::FeaturePoints& from,
               const collision::FeaturePoints& to, const Vec3& hint, collision::PathResult path) {
    const auto start =
        collision::gather(features, *a_.collider, a_.placed.start, *b_.collider, b_.placed.start);
    const double start_gap = collision::measure(start, hint).gap;
    const double least = least_separation(start_gap, pair_);
    if (least < safe_) path = collision::follow_paths(from, to, least, hint);
    spare_ = std::min(spare_, path.spare);
    if (path.has_hit)
      hits_.push_back({ends_.begin + ends_.share * path.time, ends_.begin + ends_.share,
                       collision::contact_at_impact(features, start, path.gap), start_gap});
  }

  const WorkBody &a_, &b_;
  const PartEnds& ends_;
  const WorkPair& pair_;
  PathMemory::Part& known_;
  const double safe_;  // m
  double spare_;
  Vec3 parting_ = Vec3::Zero();  // neighbouring features part along about the same direction
  std::vector<PathHit> hits_;
};

}  // namespace

bool TurningPaths::is_followed(std::size_t pair_number) const {
  return apart_[pair_number] <= kNear * work_.pairs[pair_number].kept_gap;
}

std::size_t TurningPaths::level_of(const WorkPair& pair) const {
  const int parts =
      std::max(work_.bodies[at(pair.a)].straight_parts, work_.bodies[at(pair.b)].straight_parts);
  std::size_t level = 0;
  while ((1 << level) < parts) ++level;
  return level;
}

bool TurningPaths::is_listed(const WorkPair& pair) const {
  const PathMemory& known = pair.known;
  return known.part_count == std::size_t{1} << level_of(pair) &&
         known.searched - (known.moved - known.listed_at) >= kNear * pair.kept_gap;
}

void TurningPaths::divide(const std::vector<std::size_t>& pairs) {
  bodies_.resize(work_.bodies.size());
  apart_.resize(work_.pairs.size());
  core::parallel_for(pairs.size(), 8, [&](std::size_t k) {
    const WorkPair& pair = work_.pairs[pairs[k]];
    const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
    const double wanted = kNear * pair.kept_gap;
    apart_[pairs[k]] = is_listed(pair) ? 0.0 : clearance_of_balls(a, a.end, b, b.end, wanted);
  });
  std::vector<std::array<char, kLevels>> needs(work_.bodies.size());
  std::vector<std::size_t> to_list;
  for (const std::size_t p : pairs) {
    if (!is_followed(p)) continue;
    WorkPair& pair = work_.pairs[p];
    const std::size_t level = level_of(pair);
    needs[at(pair.a)][level] = needs[at(pair.b)][level] = 1;
    if (is_listed(pair)) continue;
    const double slack = settings_.search_slack * pair.size;
    pair.known.searched =
        kNear * pair.kept_gap + std::max(kSlack * slack, std::min(kGrow * pair.known.searched, slack));
    pair.known.listed_at = pair.known.moved;
    pair.known.parts.clear();
    pair.known.part_count = std::size_t{1} << level;
    to_list.push_back(p);
  }
  core::parallel_for(work_.bodies.size(), 1, [&](std::size_t i) {
    for (std::size_t level = 0; level < kLevels; ++level)
      if (needs[i][level]) fill_parts(work_.bodies[i], level, bodies_[i]);
  });
  core::parallel_for(to_list.size(), 1, [&](std::size_t k) { list_parts(work_.pairs[to_list[k]]); });
}

// A body has one way, whoever it meets: where it is divided further than it turns, vertices stay on the
// straight lines between the ends of its own parts.
void TurningPaths::fill_parts(const WorkBody& w, std::size_t level, Divided& divided) const {
  const int count = 1 << level, halvings = count / w.straight_parts;
  std::vector<Part>& parts = divided[level];
  parts.assign(at(count), {});
  Positions own_begin = w.placed.start, own_end;
  Pose begin, end = w.start;
  for (int k = 0; k < count; ++k) {
    Part& part = parts[at(k)];
    if (k % halvings == 0) {
      begin = end;
      end = pose_on_way(w, static_cast<double>(k / halvings + 1) / w.straight_parts);
      if (k > 0) own_begin = std::move(own_end);
      own_end.clear();
      place_at(w, end, own_end);
    }
    const int done = k % halvings + 1;
    part.to = own_end;
    if (done < halvings) {
      const double share = static_cast<double>(done) / halvings;
      for (std::size_t v = 0; v < part.to.size(); ++v)
        part.to[v] = own_begin[v] + share * (own_end[v] - own_begin[v]);
    }
    part.way = straight_way(w, begin, end, static_cast<double>(done - 1) / halvings,
                            static_cast<double>(done) / halvings);
  }
}

void TurningPaths::list_parts(WorkPair& pair) const {
  const std::size_t level = level_of(pair);
  const WorkBody &body_a = work_.bodies[at(pair.a)], &body_b = work_.bodies[at(pair.b)];
  const double reach = body_a.reach + body_b.reach;
  for (std::size_t k = 0; k < pair.known.part_count; ++k) {
    const Part &a = bodies_[at(pair.a)][level][k], &b = bodies_[at(pair.b)][level][k];
    const Vec3 apart = (a.way.centre + a.way.from) - (b.way.centre + b.way.from),
               way = (a.way.to - a.way.from) - (b.way.to - b.way.from);
    if (closest_approach(apart, way) > reach + pair.known.searched) continue;
    PathMemory::Part part;
    part.number = k;
    collision::list_met_features(body_a.placed, a.way, body_b.placed, b.way, pair.known.searched,
                                 part.features);
    if (part.features.empty()) continue;
    part.free_until.assign(part.features.size(), -1.0);
    pair.known.parts.push_back(std::move(part));
  }
}

std::vector<PathHit> TurningPaths::find_hits(std::size_t pair_number, double& spare) {
  WorkPair& pair = work_.pairs[pair_number];
  std::vector<PathHit> hits;
  spare = apart_[pair_number] - kSafe * pair.kept_gap;
  if (!is_followed(pair_number)) return hits;
  PathMemory& known = pair.known;
  spare = known.searched - (known.moved - known.listed_at) - kSafe * pair.kept_gap;
  spare = std::min(spare, kNear * pair.kept_gap);
  for (PathMemory::Part& part : known.parts)
    if (hits.empty()) hits = follow_part(pair, part, spare);
  return hits;
}

std::vector<PathHit> TurningPaths::follow_part(const WorkPair& pair, PathMemory::Part& known,
                                               double& spare) const {
  const std::size_t number = known.number;
  const WorkBody &a = work_.bodies[at(pair.a)], &b = work_.bodies[at(pair.b)];
  const std::size_t level = level_of(pair);
  const std::vector<Part>&parts_a = bodies_[at(pair.a)][level], &parts_b = bodies_[at(pair.b)][level];
  const double share = 1.0 / static_cast<double>(parts_a.size());
  const PartEnds ends{number == 0 ? a.placed.start : parts_a[number - 1].to,
                      parts_a[number].to,
                      number == 0 ? b.placed.start : parts_b[number - 1].to,
                      parts_b[number].to,
                      share * static_cast<double>(number),
                      share};
  struct Found {
    double spare = 0.0;
    std::vector<PathHit> hits;
  };
  const std::size_t count = known.features.size();
  std::vector<Found> found((count + kFeaturesToFollow - 1) / kFeaturesToFollow);
  core::parallel_chunks(count, kFeaturesToFollow, [&](std::size_t begin, std::size_t end) {
    PartFollower follower(a, b, ends, pair, known, spare);
    for (std::size_t i = begin; i < end; ++i) follower.follow(i);
    found[begin / kFeaturesToFollow] = {follower.spare(), std::move(follower.hits())};
  });
  std::vector<PathHit> hits;
  for (const Found& some : found) {
    spare = std::min(spare, some.spare);
    hits.insert(hits.end(), some.hits.begin(), some.hits.end());
  }
  return hits;
}

}  // namespace shatterbox::dynamics
