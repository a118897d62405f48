// The empty floor and its backdrop: drawn once, kept while camera, lights and ground stay
// (floor_picture.h).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/floor_picture.h"
#include "render/pass/frame_block.h"

namespace shatterbox::render::pass {

class FloorPass {
 public:
  FloorPass(int width, int height);
  // Paints the empty floor if it is not the one kept, and copies it over the target's colours: over all of
  // them, or over the rectangles (left, bottom, right, top; pixels). The block must be bound. Binds what the
  // light pass wants of a patterned floor.
  void run(const FrameBlock& block, const gpu::Framebuffer& target, bool is_all,
           std::span<const glm::uvec4> rectangles);

 private:
  void find_whole_colour(const FrameBlock& block);

  gpu::Texture picture_, whole_;  // whole: one pixel
  gpu::Texture shares_;           // of a patterned floor's colour, half of it; made when first wanted
  gpu::Framebuffer kept_, whole_target_;
  gpu::Program whole_program_;
  FloorPicture made_;
  std::optional<FrameBlock> kept_of_;
  std::array<glm::vec4, 3> whole_of_{};  // what the colour below was found for
  std::array<std::uint8_t, 3> whole_bytes_{};
};

}  // namespace shatterbox::render::pass
