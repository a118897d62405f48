// The empty floor and its backdrop: drawn once, kept while camera, lights and ground stay
// (shaders/floor_base.frag).
#pragma once
#include <array>
#include <optional>

#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/frame_block.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class FloorPass {
 public:
  FloorPass(int width, int height);
  // Draws the empty floor if it is not the one kept, and copies it over the target's colours. Block and tiles
  // must be bound.
  void run(const FrameBlock& block, const Tiles& tiles, const gpu::Framebuffer& target);

 private:
  void find_whole_colour(const FrameBlock& block);

  gpu::Texture picture_, whole_;  // whole: one pixel
  gpu::Framebuffer kept_, whole_target_;
  gpu::Program smooth_, fading_, checkered_, whole_program_;
  std::optional<FrameBlock> kept_of_;
  std::array<glm::vec4, 3> whole_of_{};  // what the colour below was found for
  std::array<float, 3> whole_colour_{};  // linear, of exactly the bytes that the shader makes
};

}  // namespace shatterbox::render::pass
