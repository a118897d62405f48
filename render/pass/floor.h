// The empty floor and its backdrop: drawn once, kept while camera, lights and ground stay
// (shaders/floor_base.frag).
#pragma once
#include <optional>

#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/frame_block.h"

namespace shatterbox::render::pass {

class FloorPass {
 public:
  FloorPass(int width, int height);
  // Draws the empty floor if it is not the one kept, and copies it over the target's colours. The block must
  // be bound.
  void run(const FrameBlock& block, const gpu::Framebuffer& target);
  void bind() const;  // texture unit 8: the parts that floor.frag puts together

 private:
  gpu::Texture picture_, parts_;
  gpu::Framebuffer kept_;
  gpu::Program program_;
  std::optional<FrameBlock> kept_of_;
};

}  // namespace shatterbox::render::pass
