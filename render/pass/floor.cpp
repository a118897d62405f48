#include "render/pass/floor.h"

#include <glad/gl.h>

#include <cstring>

namespace shatterbox::render::pass {
namespace {

// The block without what the empty floor does not depend on.
FrameBlock without_bodies(const FrameBlock& block) {
  FrameBlock out = block;
  out.shadow_from_world = glm::mat4(0.0F);
  out.shadow_texel = out.scalar_range = glm::vec4(0.0F);
  out.sun_radiance.w = 0.0F;
  return out;
}

}  // namespace

FloorPass::FloorPass(int width, int height)
    : picture_(width, height, GL_SRGB8_ALPHA8, gpu::Filter::nearest),
      parts_(width, height, GL_RGBA32F, gpu::Filter::nearest),
      kept_({&picture_, &parts_}, nullptr),
      program_("full_screen.vert", "floor_base.frag") {}

void FloorPass::run(const FrameBlock& block, const gpu::Framebuffer& target) {
  static_assert(sizeof(FrameBlock) % sizeof(glm::vec4) == 0);  // no padding to compare
  const FrameBlock wanted = without_bodies(block);
  if (!kept_of_ || std::memcmp(&*kept_of_, &wanted, sizeof wanted) != 0) {
    kept_.bind();
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    program_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    kept_of_ = wanted;
  }
  glBlitNamedFramebuffer(kept_.name(), target.name(), 0, 0, kept_.width(), kept_.height(), 0, 0,
                         kept_.width(), kept_.height(), GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void FloorPass::bind() const {
  parts_.bind(8);
}

}  // namespace shatterbox::render::pass
