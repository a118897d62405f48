// In which order an island's contacts are visited. In a large one, several that share no body are visited at
// once, and all loops go through it from one end in space to the other: two threads that begin at its ends
// mostly have bodies of their own.
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
  std::vector<Range> chunks;  // of `contacts`; the contacts of a pair are in one, those of a round together
  std::vector<Range> rounds;  // of `chunks`: those of one have no body in common that an impulse could move
  // Of large islands only, from end to end: the numbers of all chunks, and the island's bodies.
  std::vector<std::size_t> chunks_along;
  std::vector<int> bodies_along;
};

/// The same for any number of threads. Small islands are visited pair by pair. In large ones pairs get the
/// first colour that neither of their bodies has yet, in the order of their numbers; those for which there is
/// none come last, one by one.
ContactOrder order_contacts(const Island& island, const MotionWork& work);

}  // namespace shatterbox::dynamics
