// In which order an island's contacts are visited. In a large one, several that share no body are visited at
// once.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/dynamics/motion_work.h"

namespace shatterbox::dynamics {

struct ContactOrder {
  /// In islands of more contacts the rounds are colours of pairs; others are visited pair by pair.
  static constexpr std::size_t kMany = 1200;

  struct Range {
    std::size_t begin = 0, end = 0;
  };

  std::vector<int> contacts;  // numbers in MotionWork::contacts, as they are visited
  std::vector<Range> chunks;  // of `contacts`; the contacts of a pair are in one, those of a round together
  std::vector<Range> rounds;  // of `chunks`: those of one have no body in common that an impulse could move
};

/// The same for any number of threads. Pairs get the first colour that neither of their bodies has yet, in
/// the order of their numbers; those for which there is none come last, one by one.
ContactOrder order_contacts(const Island& island, const MotionWork& work);

}  // namespace shatterbox::dynamics
