// A small stroke font of our own: letters as lines and curves on a grid, drawn smoothly at any size on the
// CPU.
#pragma once
#include <array>
#include <string_view>

#include "render/output/image.h"

namespace shatterbox::render::pass {

// `unit`: pixels a grid step; a capital is six steps high. y is the baseline, from the top. Light letters get
// a dark soft edge so that they can be read on anything.
void draw_text(Image& image, float x, float y, float unit, std::array<std::uint8_t, 3> colour,
               std::string_view text, float opacity = 1.0F);

float text_width(std::string_view text, float unit);  // pixels

}  // namespace shatterbox::render::pass
