// Random and adversarial motions of a point and a triangle, or of two edges.
#pragma once

#include <array>
#include <cstdint>

#include "tests/support/exact_contact.h"

namespace shatterbox::test {

inline constexpr std::array<const char*, 10> kQueryKinds{
    "random", "touching on a lattice", "in one plane", "parallel edges",    "sliding", "sub-micron gap",
    "1 km/s", "far from the origin",   "turning",      "needles and points"};

/// The query of that number; its kind is number % 10.
Motion make_query(std::uint64_t seed, std::uint64_t number);

}  // namespace shatterbox::test
