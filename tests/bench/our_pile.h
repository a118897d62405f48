// Our own world as one of the piles.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/bench/peer_pile.h"

namespace shatterbox::bench {

struct OurPile {
  PeerScene scene;  // for the others
  std::unique_ptr<PeerPile> pile;
};

/// Reads a scene, with changes as of --set; sleep is off. A sentence in `fault` if it cannot be.
OurPile make_our_pile(const std::string& scene, const std::vector<std::string>& changes, int threads,
                      std::string& fault);

}  // namespace shatterbox::bench
