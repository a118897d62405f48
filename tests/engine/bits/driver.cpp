// Prints the chained hash of each step, for compilers.sh.
#include <cinttypes>
#include <cstdio>

#include "tests/engine/bits/scene.h"

int main() {
  constexpr int kSteps = 60;  // pieces hit the ground and each other, and break again
  for (const std::uint64_t hash : shatterbox::test::play_hashes(kSteps))
    std::printf("%016" PRIx64 "\n", hash);
}
