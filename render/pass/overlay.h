// What is written on the finished picture, by the CPU: the caption, and the scale of the heat map with its
// numbers.
#pragma once
#include "render/frame/frame.h"
#include "render/output/image.h"

namespace shatterbox::render::pass {

void draw_overlay(Image& image, const Frame& frame);

// The heat map's colour at 0..1, linear; mirrors heat_colour in shaders/common/look.glsl.
glm::vec3 heat_colour(float t);

}  // namespace shatterbox::render::pass
