// The last resort: bodies that are still in each other's way go as one (rigid impact zones, [BFA02]
// sec. 7.5). All vertices of a zone go along straight lines by one and the same affine map, so nothing in it
// can meet; and what is wedged in something that flies or spins goes on with it instead of holding it where
// it is.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/core/disjoint_sets.h"
#include "engine/core/vec.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/opening.h"

namespace shatterbox::dynamics {

class ImpactZones {
 public:
  /// Each body is a zone of its own, but those that joints hold: they keep their own ways, and go equally
  /// far. `work` must outlive it.
  explicit ImpactZones(MotionWork& work);

  /// From now on two bodies are in one zone. False if they were, or if one cannot be moved or has been
  /// stopped.
  bool unite(int a, int b);

  /// True if they were united, or are in the zone of some that were.
  bool are_one(int a, int b) {
    const int zone = zone_of(a);
    return zone == zone_of(b) && is_whole_[static_cast<std::size_t>(zone)] != 0;
  }

  /// True if any were united.
  bool has_wholes() const { return std::find(is_whole_.begin(), is_whole_.end(), 1) != is_whole_.end(); }

  /// A body's zone goes only this share of its present way, at most.
  void limit(int body, double share);

  /// Lets the zones that were united or limited since the last call go: several bodies by the motion that has
  /// the momentum and the angular momentum of their ways. True per body that ends elsewhere now.
  std::vector<char> go();

  /// Opens gaps between zones, which give way as wholes by their masses; those that were stopped do not.
  /// Their bodies lose approach one by one, as in open_gaps. Returns by how much each was moved.
  std::vector<EndMove> open(std::vector<Opening>& openings, double time_step);

  /// The least body of the zone that this one is in.
  int zone_of(int body) { return zones_.find(body); }

  /// The share of its way that a body's zone goes.
  double share(int body) { return shares_[static_cast<std::size_t>(zones_.find(body))]; }

 private:
  void go_as_one(const std::vector<int>& members, double share);

  MotionWork& work_;
  core::DisjointSets zones_;
  // Per zone, at its least body.
  std::vector<double> shares_, limits_;  // in all, and since the last call of `go`
  std::vector<char> is_united_;          // since then
  std::vector<char> is_whole_;           // united at any time
};

}  // namespace shatterbox::dynamics
