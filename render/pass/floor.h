// The empty floor and its backdrop: drawn once, kept while camera, lights and ground stay
// (shaders/floor_base.frag).
#pragma once
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
  gpu::Texture picture_;
  gpu::Framebuffer kept_;
  gpu::Program smooth_, fading_, checkered_;
  std::optional<FrameBlock> kept_of_;
};

}  // namespace shatterbox::render::pass
