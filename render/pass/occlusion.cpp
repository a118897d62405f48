#include "render/pass/occlusion.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

OcclusionPass::OcclusionPass(int width, int height, int taps, int samples_across, int scale,
                             const TileReset& reset)
    : raw_((width + scale - 1) / scale, (height + scale - 1) / scale, GL_R32UI, gpu::Filter::nearest),
      blurred_(raw_.width(), raw_.height(), GL_R32UI, gpu::Filter::nearest),
      tiles_((width + 15) / 16, (height + 15) / 16, GL_R32F, gpu::Filter::nearest),
      raw_target_({&raw_}, nullptr),
      blurred_target_({&blurred_}, nullptr),
      tiles_target_({&tiles_}, nullptr),
      sample_("tile.vert", "occlusion.frag",
              {"SIDE " + std::to_string(samples_across), "OCCLUSION_TAPS " + std::to_string(taps),
               "OCCLUSION_SCALE " + std::to_string(scale)}),
      blur_("tile.vert", "occlusion_blur.frag"),
      reduce_("full_screen.vert", "occlusion_tiles.frag", {"OCCLUSION_SCALE " + std::to_string(scale)}),
      reset_(&reset) {}

void OcclusionPass::run(const Layer& opaque, const Tiles& tiles, const Changes::Marks& changed) const {
  constexpr unsigned kUnoccluded = 0x00003c00U;  // half floats: sees all, infinitely far
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  raw_target_.bind();
  reset_->reset_value(changed, tiles.changed_occlusion(), kUnoccluded);
  sample_.use();
  opaque.bind(4, 5);
  Tiles::draw(tiles.near_bodies());
  blurred_target_.bind();
  reset_->reset_value(changed, tiles.changed_occlusion(), kUnoccluded);
  blur_.use();
  raw_.bind(0);
  Tiles::draw(tiles.near_bodies());
  tiles_target_.bind();
  reduce_.use();
  blurred_.bind(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void OcclusionPass::bind() const {
  blurred_.bind(3);
  tiles_.bind(9);
}

}  // namespace shatterbox::render::pass
