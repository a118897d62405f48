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

  /// It was asked since the last clear_out().
  void note_use(body::BodyId id) { used_[id].turn = turn_; }

  /// Where there are more, pieces give theirs up, those first that were not used for longest, until four
  /// fifths are left; wherever else a piece's Fragile is kept, it gives them up there. Whole bodies keep what
  /// they got at load. Not while anyone is judged.
  void clear_out(const Fragiles& fragiles, const std::map<body::BodyId, Ancestry>& ancestry);

 private:
  struct Use {
    long turn = 0;       // the last one in which it was asked
    double bytes = 0.0;  // as they were when that turn ended; 0 of whole bodies
  };

  void give_up_oldest(double sum, const Fragiles& fragiles, const std::map<body::BodyId, Ancestry>& ancestry);

  double most_bytes_;
  long turn_ = 0;
  std::map<body::BodyId, Use> used_;
};

}  // namespace shatterbox::world
