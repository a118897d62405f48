// What a floor is laid with, as a share of its colour at each point, about 1 in the mean. Made once, by sums
// and a hash: one period as a picture, and ever coarser ones for what is farther away.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame/frame.h"

namespace shatterbox::render::pass {

class FloorPattern {
 public:
  static constexpr int kOne = 32768;  // of a share

  // Of planks or concrete; made when first asked for.
  static const FloorPattern& of(GroundPattern pattern);

  // Periods: how often `pattern_size` goes into one.
  float units() const { return units_; }

  // How coarse a picture it takes to blur the pattern over `footprint` periods: 0 for the finest, one more
  // for each doubling.
  static float depth_of(float footprint);

  // Shares at `count` places in a row, from `from` on, `step` apart (periods), as coarse as `depth` and by
  // `depth_step` coarser from one to the next.
  void find_row(glm::dvec2 from, glm::dvec2 step, float depth, float depth_step, int count,
                std::uint16_t* shares) const;

 private:
  struct Level {
    int bits = 0;                       // 2^bits texels a side
    std::vector<std::uint16_t> shares;  // rows along x
  };

  FloorPattern(float units, std::vector<float> finest);
  static unsigned smooth(const Level& level, std::uint32_t x, std::uint32_t y);

  float units_;
  std::vector<Level> levels_;  // the finest first
};

// A checker's share: squares of one unit, smoothed over `footprint` units.
float checker_at(glm::vec2 place, float footprint);

}  // namespace shatterbox::render::pass
