// The empty floor and its backdrop, worked out on the CPU: it is smooth, so that a pixel costs a few sums and
// a look into a table, a fraction of what the rasteriser's own way to a pixel costs. The same law as
// shaders/common/floor.glsl.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/pass/frame_block.h"

namespace shatterbox::render::pass {

// Rows from below, of the block's viewport.
struct FloorPicture {
  std::vector<std::uint8_t> rgba;  // sRGB
  std::vector<std::uint16_t>
      shares;  // of a patterned floor, of its colour: 32768 (FloorPattern::kOne) is 1; empty if it is plain
};

// whole: what a plain floor is where it has not begun to fade.
void paint_floor(const FrameBlock& block, const std::array<std::uint8_t, 3>& whole, FloorPicture& picture);

}  // namespace shatterbox::render::pass
