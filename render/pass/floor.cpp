#include "render/pass/floor.h"

#include <glad/gl.h>

#include <cstring>

namespace shatterbox::render::pass {
namespace {

// The block without what the empty floor does not depend on.
FrameBlock without_bodies(const FrameBlock& block) {
  FrameBlock out = block;
  out.shadow_from_world = glm::mat4(0.0F);
  out.shadow_texel = out.shadow_on_floor = out.scalar_range = glm::vec4(0.0F);
  out.sun_radiance.w = 0.0F;
  return out;
}

}  // namespace

FloorPass::FloorPass(int width, int height)
    : picture_(width, height, GL_SRGB8_ALPHA8, gpu::Filter::nearest),
      kept_({&picture_}, nullptr),
      smooth_("tile.vert", "floor_base.frag", {"FLOOR SMOOTH"}),
      fading_("tile.vert", "floor_base.frag", {"FLOOR FADING"}),
      checkered_("tile.vert", "floor_base.frag", {"FLOOR CHECKERED"}) {}

void FloorPass::run(const FrameBlock& block, const Tiles& tiles, const gpu::Framebuffer& target) {
  static_assert(sizeof(FrameBlock) % sizeof(glm::vec4) == 0);  // no padding to compare
  const FrameBlock wanted = without_bodies(block);
  if (!kept_of_ || std::memcmp(&*kept_of_, &wanted, sizeof wanted) != 0) {
    kept_.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    smooth_.use();
    Tiles::draw(tiles.empty_smooth());
    (block.ground_colour.w > 0.0F ? checkered_ : fading_).use();
    Tiles::draw(tiles.empty_uneven());
    kept_of_ = wanted;
  }
  glBlitNamedFramebuffer(kept_.name(), target.name(), 0, 0, kept_.width(), kept_.height(), 0, 0,
                         kept_.width(), kept_.height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace shatterbox::render::pass
