#include "engine/core/hash.h"

#include <bit>
#include <catch2/catch.hpp>
#include <set>

namespace shatterbox::core {

TEST_CASE("the hash sees every bit, the order and the length, but not the sign of zero") {
  std::set<std::uint64_t> seen{Hash().value()};
  seen.insert(Hash().add(std::uint64_t{0}).value());
  seen.insert(Hash().add(std::uint64_t{0}).add(std::uint64_t{0}).value());
  for (int bit = 0; bit < 64; ++bit) seen.insert(Hash().add(std::uint64_t{1} << bit).value());
  CHECK(seen.size() == 67);
  CHECK(Hash().add(1.0).add(2.0).value() != Hash().add(2.0).add(1.0).value());
  CHECK(Hash().add(-0.0).value() == Hash().add(0.0).value());
  CHECK(Hash().add(1.0).value() != Hash().add(1.0 + 0x1.0p-52).value());
  CHECK(Hash().add(Vec3(1, 2, 3)).value() == Hash().add(1.0).add(2.0).add(3.0).value());
  CHECK(Hash().add(Quat(1, 2, 3, 4)).value() == Hash().add(1.0).add(2.0).add(3.0).add(4.0).value());
}

TEST_CASE("one bit in flips about half of the bits out") {
  int flips = 0;
  for (std::uint64_t word = 0; word < 64; ++word)
    for (int bit = 0; bit < 64; ++bit)
      flips += std::popcount(Hash().add(word).value() ^ Hash().add(word ^ (std::uint64_t{1} << bit)).value());
  CHECK(flips == Approx(64.0 * 64.0 * 32.0).epsilon(0.01));
}

}  // namespace shatterbox::core
