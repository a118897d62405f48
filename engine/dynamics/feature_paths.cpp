#include "engine/dynamics/feature_paths.h"

#include <algorithm>
#include <memory>

#include "engine/collision/feature_gap.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {
namespace {

using core::at;
using Size = std::size_t;

constexpr double kFloor = 1e-5;  // below this a direction is not to be trusted
constexpr double kClear = 1.3;   // times the least separation: where a start does not lower it
constexpr double kClearlyApart = 1.01 * kClear;  // where rounding does not count
constexpr Size kBlocksToTask = 64;

// Some features of a pair, one after the other.
class Follower {
 public:
  Follower(const WorkBody& a, const WorkBody& b, const PairPaths& paths, WorkPair& pair)
      : a_(a),
        b_(b),
        paths_(paths),
        pair_(pair),
        search_(*pair.search),
        known_(pair.known),
        safe_(kSafe * pair.kept_gap),
        radii_(a.collider->radius + b.collider->radius),
        spare_(paths.spare) {}

  void follow_block(Size number) {
    PathMemory::Block& block = known_.blocks[number];
    if (block.free_until > known_.moved) {
      note_free(block.free_until);
      return;
    }
    block.free_until = -1.0;
    if (part_as_one(number, block)) return;
    const auto [begin, end] = search_.features_of(number);
    all_free_until_ = 1e300;
    if (!block.is_begun && !begins(begin, end)) {
      block.free_until = all_free_until_;
      return;
    }
    block.is_begun = true;
    for (Size i = begin; i < end; ++i) follow(i);
    block.free_until = all_free_until_;
  }

  double spare() const { return spare_; }
  std::vector<PathHit>& hits() { return hits_; }

 private:
  void note_free(double until) {
    spare_ = std::min(spare_, until - known_.moved);
    all_free_until_ = std::min(all_free_until_, until);
  }

  // Sets what is known of the features [begin, end). False if they all start out of reach.
  bool begins(Size begin, Size end) {
    const StartGaps* known = known_.start_gaps.get();
    if (known) {
      float least = known->gaps[begin];
      for (Size i = begin + 1; i < end; ++i) least = std::min(least, known->gaps[i]);
      if (is_out_of_reach(least)) return false;
    }
    for (Size i = begin; i < end; ++i)
      known_.features[i] = {known ? known->gaps[i] : PathMemory::kUnknown, -1.0, Vec3::Zero()};
    return true;
  }

  // Along one direction the triangles of two leaves are apart at both ends.
  bool part_as_one(Size number, PathMemory::Block& block) {
    if (search_.blocks.empty()) return false;
    const collision::FeatureBlock& leaves = search_.blocks[number];
    const auto along = [&](const std::vector<Vec3>& at_a, const std::vector<Vec3>& at_b,
                           const Vec3& direction) {
      return collision::leaf_span(*a_.collider, leaves.leaf_a, at_a, direction).least -
             collision::leaf_span(*b_.collider, leaves.leaf_b, at_b, direction).most - radii_;
    };
    const auto part = [&](const Vec3& direction) {
      const double left = along(paths_.ends_a, paths_.ends_b, direction) - safe_;
      if (!(left >= spare_)) return false;
      block.free_until = known_.moved + left;
      return true;
    };
    // Along that at which they parted before, they did so at the start.
    if (block.parting != Vec3::Zero() && part(block.parting)) return true;
    if (parting_ == Vec3::Zero() || parting_ == block.parting ||
        !(along(a_.placed.start, b_.placed.start, parting_) > kClear * safe_))
      return false;
    block.parting = parting_;
    return part(parting_);
  }

  void follow(Size i) {
    PathMemory::Feature& known = known_.features[i];
    if (known.free_until > known_.moved) {
      note_free(known.free_until);
      return;
    }
    const collision::FeaturePair& features = search_.features[i];
    if (features.bound > paths_.listed) {
      note_room((features.bound - paths_.listed) + paths_.spare);
      return;
    }
    if (is_out_of_reach(known.start_gap) || parts_along(features, known)) return;
    const auto start =
        collision::gather(features, *a_.collider, a_.placed.start, *b_.collider, b_.placed.start);
    const Vec3 hint = direction_hint(a_, b_, start);
    const collision::FeatureGap gap = collision::measure(start, hint);
    known.start_gap = gap.gap;
    if (is_out_of_reach(known.start_gap)) return;
    parting_ = gap.normal;
    if (gap.gap > kClearlyApart * safe_) known.parting = parting_;
    const auto end = collision::gather(features, *a_.collider, paths_.ends_a, *b_.collider, paths_.ends_b);
    const auto path = collision::follow_paths(start, end, least_separation(gap.gap, pair_), hint, &gap);
    spare_ = std::min(spare_, path.spare);
    known.free_until = path.has_hit ? -1.0 : known_.moved + path.spare;
    all_free_until_ = std::min(all_free_until_, known.free_until);
    if (path.has_hit)
      hits_.push_back({path.time, 1.0, collision::contact_at_impact(features, start, path.gap), gap.gap});
  }

  // Along one direction the features are apart at both ends.
  bool parts_along(const collision::FeaturePair& features, PathMemory::Feature& known) {
    const auto along = [&](const std::vector<Vec3>& at_a, const std::vector<Vec3>& at_b,
                           const Vec3& direction) {
      return collision::separation_along(features, *a_.collider, at_a, *b_.collider, at_b, direction);
    };
    const auto part = [&](const Vec3& direction) {
      const double left = along(paths_.ends_a, paths_.ends_b, direction) - safe_;
      if (!(left >= spare_)) return false;
      known.free_until = known_.moved + left;
      all_free_until_ = std::min(all_free_until_, known.free_until);
      return true;
    };
    if (known.parting != Vec3::Zero() && part(known.parting)) return true;
    if (known.parting == parting_ || !(along(a_.placed.start, b_.placed.start, parting_) > kClear * safe_))
      return false;
    known.parting = parting_;
    return part(parting_);
  }

  bool is_out_of_reach(double start_gap) {
    if (!(start_gap > paths_.reach + spare_)) return false;
    note_room(start_gap - paths_.reach);
    return true;
  }

  void note_room(double left) {
    all_free_until_ = std::min(all_free_until_, known_.moved + std::min(left, paths_.ample));
  }

  const WorkBody &a_, &b_;
  const PairPaths& paths_;
  const WorkPair& pair_;
  const FeatureSearch& search_;
  PathMemory& known_;
  const double safe_, radii_;  // m
  double spare_;
  double all_free_until_ = 1e300;  // of a block
  // Neighbouring features part along about the same direction.
  Vec3 parting_ = Vec3::Zero();
  std::vector<PathHit> hits_;
};

}  // namespace

double least_separation(double gap, const WorkPair& pair) {
  const double floor = kFloor * pair.kept_gap;
  if (gap > floor) return std::max(floor, std::min(kSafe * pair.kept_gap, 0.8 * gap));
  return pair.has_sides ? gap - 1e-9 * std::abs(gap) - pair.rounding : gap * (1.0 - 1e-9);
}

std::vector<PathHit> follow_features(const WorkBody& a, const WorkBody& b, const PairPaths& paths,
                                     WorkPair& pair, double& spare) {
  const FeatureSearch& search = *pair.search;
  const Size blocks = search.block_count();
  if (pair.known.blocks.empty()) {
    pair.known.blocks.resize(blocks);
    pair.known.features = std::make_unique_for_overwrite<PathMemory::Feature[]>(search.features.size());
  }
  struct Found {
    double spare = 0.0;
    std::vector<PathHit> hits;
  };
  const auto follow = [&](Size begin, Size end) {
    Follower follower(a, b, paths, pair);
    for (Size block = begin; block < end; ++block) follower.follow_block(block);
    return Found{follower.spare(), std::move(follower.hits())};
  };
  if (blocks <= kBlocksToTask) {
    Found all = follow(0, blocks);
    spare = all.spare;
    return std::move(all.hits);
  }
  std::vector<Found> found((blocks + kBlocksToTask - 1) / kBlocksToTask);
  core::parallel_chunks(blocks, kBlocksToTask,
                        [&](Size begin, Size end) { found[begin / kBlocksToTask] = follow(begin, end); });
  std::vector<PathHit> hits;
  spare = paths.spare;
  for (const Found& some : found) {
    spare = std::min(spare, some.spare);
    hits.insert(hits.end(), some.hits.begin(), some.hits.end());
  }
  return hits;
}

}  // namespace shatterbox::dynamics
