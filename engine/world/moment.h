// The state behind each stage of a step, quantity by quantity, as hashes: for finding where two runs part.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/body/body.h"

namespace shatterbox::world {

/// What is hashed of a body, in the order of BodyBits::quantities.
inline constexpr std::array kBodyQuantities{"position", "rotation", "velocity", "spin",
                                            "sleep",    "path",     "loads",    "stress"};

struct BodyBits {
  body::BodyId id = 0;
  std::array<std::uint64_t, kBodyQuantities.size()> quantities{};

  bool operator==(const BodyBits&) const = default;
};

struct Moment {
  const char* stage = "";   // that was just done: "acts", "motion", "joints", "fracture", "dents" or "sleep"
  long step = 0;            // from 1
  int part = 0, parts = 0;  // of the step, from 1
  int pass = 0;             // from 1: more where something broke and the part was taken again
  std::span<const body::Body> bodies;
  std::vector<BodyBits> bits;  // one a body
  std::uint64_t contacts = 0;  // what is remembered between bodies, their joints included
};

using Watcher = std::function<void(const Moment&)>;

}  // namespace shatterbox::world
