#include "render/pass/floor.h"

#include <glad/gl.h>

#include <cmath>
#include <cstdint>
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
      whole_(1, 1, GL_SRGB8_ALPHA8, gpu::Filter::nearest),
      kept_({&picture_}, nullptr),
      whole_target_({&whole_}, nullptr),
      smooth_("tile.vert", "floor_base.frag", {"FLOOR SMOOTH"}),
      fading_("tile.vert", "floor_base.frag", {"FLOOR FADING"}),
      checkered_("tile.vert", "floor_base.frag", {"FLOOR CHECKERED"}),
      whole_program_("full_screen.vert", "floor_whole.frag") {}

// Clearing converts to sRGB otherwise than drawing does, by a level here and there: so the shader is asked.
void FloorPass::find_whole_colour(const FrameBlock& block) {
  const std::array<glm::vec4, 3> wanted = {block.floor_sun, block.floor_sky, glm::vec4(block.eye_exposure.w)};
  if (wanted == whole_of_) return;
  whole_of_ = wanted;
  whole_target_.bind();
  whole_program_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::array<std::uint8_t, 4> bytes{};
  glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  for (std::size_t i = 0; i < 3; ++i) {
    const float x = static_cast<float>(bytes[i]) / 255.0F;
    whole_colour_[i] = x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
  }
}

void FloorPass::run(const FrameBlock& block, const Tiles& tiles, const gpu::Framebuffer& target) {
  static_assert(sizeof(FrameBlock) % sizeof(glm::vec4) == 0);  // no padding to compare
  const FrameBlock wanted = without_bodies(block);
  if (!kept_of_ || std::memcmp(&*kept_of_, &wanted, sizeof wanted) != 0) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    find_whole_colour(block);
    kept_.bind();
    glClearColor(whole_colour_[0], whole_colour_[1], whole_colour_[2], 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    smooth_.use();
    Tiles::draw(tiles.backdrop());
    (block.ground_colour.w > 0.0F ? checkered_ : fading_).use();
    Tiles::draw(tiles.uneven());
    kept_of_ = wanted;
  }
  glBlitNamedFramebuffer(kept_.name(), target.name(), 0, 0, kept_.width(), kept_.height(), 0, 0,
                         kept_.width(), kept_.height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace shatterbox::render::pass
