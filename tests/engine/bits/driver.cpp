// Prints the chained hash of each step, for compilers.sh.
#include <cinttypes>
#include <cstdio>

#include "tests/engine/bits/scene.h"

int main() {
  for (const std::uint64_t hash : shatterbox::test::play_hashes()) std::printf("%016" PRIx64 "\n", hash);
}
