#include "engine/fracture/crack_set.h"

#include <algorithm>

namespace shatterbox::fracture {
namespace {
constexpr std::size_t kBlock = 8;  // stretches that share a bounding ball
}

void CrackSet::add(const CrackStretch& stretch) {
  const bool fits = !blocks_.empty() && blocks_.back().stretches.size() < kBlock &&
                    blocks_.back().stretches.back().crack == stretch.crack &&
                    blocks_.back().stretches.back().branch == stretch.branch;
  if (!fits) {
    blocks_.emplace_back();
    blocks_.back().centre = 0.5 * (stretch.begin + stretch.end);
  }
  Block& block = blocks_.back();
  block.stretches.push_back(stretch);
  for (const Vec3* p : {&stretch.begin, &stretch.end})
    block.radius = std::max(block.radius, (*p - block.centre).norm());
}

}  // namespace shatterbox::fracture
