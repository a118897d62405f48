#include "render/pass/floor.h"

#include <glad/gl.h>

#include <algorithm>
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
      whole_program_("full_screen.vert", "floor_whole.frag") {}

// The shader is asked for the colour of most of the floor, so that squares which the light pass draws again
// show no edge.
void FloorPass::find_whole_colour(const FrameBlock& block) {
  const std::array<glm::vec4, 3> wanted = {block.floor_sun, block.floor_sky, glm::vec4(block.eye_exposure.w)};
  if (wanted == whole_of_) return;
  whole_of_ = wanted;
  whole_target_.bind();
  whole_program_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::array<std::uint8_t, 4> bytes{};
  glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  std::copy_n(bytes.begin(), 3, whole_bytes_.begin());
}

void FloorPass::run(const FrameBlock& block, const gpu::Framebuffer& target, bool is_all,
                    std::span<const glm::uvec4> rectangles) {
  static_assert(sizeof(FrameBlock) % sizeof(glm::vec4) == 0);  // no padding to compare
  const FrameBlock wanted = without_bodies(block);
  if (!kept_of_ || std::memcmp(&*kept_of_, &wanted, sizeof wanted) != 0) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    find_whole_colour(block);
    paint_floor(block, whole_bytes_, made_);
    const int width = picture_.width(), height = picture_.height();
    glTextureSubImage2D(picture_.name(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                        made_.rgba.data());
    if (!made_.shares.empty()) {
      if (shares_.name() == 0) shares_ = gpu::Texture(width, height, GL_R16, gpu::Filter::nearest);
      glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
      glTextureSubImage2D(shares_.name(), 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_SHORT,
                          made_.shares.data());
      glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    }
    kept_of_ = wanted;
  }
  if (!made_.shares.empty()) shares_.bind(13);
  const auto copy = [&](int left, int bottom, int right, int top) {
    glBlitNamedFramebuffer(kept_.name(), target.name(), left, bottom, right, top, left, bottom, right, top,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
  };
  if (is_all) return copy(0, 0, kept_.width(), kept_.height());
  for (const glm::ivec4 r : rectangles) copy(r.x, r.y, r.z, r.w);
}

}  // namespace shatterbox::render::pass
