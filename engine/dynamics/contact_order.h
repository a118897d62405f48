// In which order an island's contacts are visited. A large one is parted in space, in halves of halves: the
// contacts within a smallest part are visited one after the other, those of other parts at once, and once
// both halves of a part are done, those across where they meet (nested dissection, [Geo73]).
#pragma once

#include <cstddef>
#include <vector>

#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

struct ContactOrder {
  struct Range {
    std::size_t begin = 0, end = 0;
  };

  std::vector<int> contacts;  // numbers in MotionWork::contacts, as they are visited
  // Of `contacts`, a heap: the halves of part k are 2 k and 2 k + 1, the whole is 1, and there is no part 0.
  // Each has those contacts that neither of its halves has, and they are visited one after the other, after
  // its halves. Two parts of which none is within the other have no body in common that an impulse could
  // move.
  std::vector<Range> parts;
  // Of large islands only.
  std::vector<Range> slices;  // of `contacts`, short ones; as in parts, the contacts of a pair are in one
  std::vector<int> bodies;    // the island's, part by part

  /// How many have no halves: the last ones of `parts`.
  std::size_t count_smallest() const { return parts.size() / 2; }
};

/// The same for any number of threads. Small islands are visited pair by pair.
ContactOrder order_contacts(const Island& island, const MotionWork& work);

}  // namespace shatterbox::dynamics
