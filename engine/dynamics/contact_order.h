// In which order an island's contacts are visited. A large one is parted in space, in halves of halves: the
// contacts within a smallest part are visited one after the other, those of other parts at once, and then,
// from level to level, those across where two parts meet (nested dissection, [Geo73]).
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
  std::vector<Range> chunks;  // of `contacts`: visited one after the other
  std::vector<Range> rounds;  // of `chunks`: those of one have no body in common that an impulse could move
  // Of large islands only.
  std::vector<Range> slices;  // of `contacts`, short ones; as in chunks, the contacts of a pair are in one
  std::vector<int> bodies;    // the island's, part by part
};

/// The same for any number of threads. Small islands are visited pair by pair.
ContactOrder order_contacts(const Island& island, const MotionWork& work);

}  // namespace shatterbox::dynamics
