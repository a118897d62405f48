// The 256 colours that serve a picture best, for formats that allow no more.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/output/image.h"

namespace shatterbox::render {

struct Paletted {
  std::array<std::uint32_t, 256> argb{};
  std::vector<std::uint8_t> indices;  // width * height, row 0 on top
};

// Median cut over a histogram of five bits a channel; gradients are dithered by an ordered 8 x 8 pattern,
// which holds still from frame to frame.
Paletted find_palette(const Image& image);

}  // namespace shatterbox::render
