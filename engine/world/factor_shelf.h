// Which pieces keep the factors of their stress: those that were hit last. A cache that changes no result,
// bounded because shards are born by the thousand and most are hit once.
#pragma once

#include <map>

#include "engine/world/fragile.h"
#include "engine/world/world.h"

namespace shatterbox::world {

class FactorShelf {
 public:
  /// `most_bytes` of the factors of all pieces of shells together.
  explicit FactorShelf(double most_bytes = 2e9) : most_bytes_(most_bytes) {}

  void note_use(body::BodyId id, long step) { used_[id] = step; }

  /// Where there are more, pieces give theirs up, those first that were not used for longest, until half is
  /// left. Whole bodies keep what they got at load.
  void clear_out(Fragiles& fragiles, const std::map<body::BodyId, Ancestry>& ancestry);

 private:
  double most_bytes_;
  std::map<body::BodyId, long> used_;  // the last step in which they were
};

}  // namespace shatterbox::world
