#include "render/pass/occlusion.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

OcclusionPass::OcclusionPass(int width, int height, int taps, int samples_across, int scale)
    : depth_((width + scale - 1) / scale, (height + scale - 1) / scale, GL_R32F, gpu::Filter::nearest),
      raw_(depth_.width(), depth_.height(), GL_R32UI, gpu::Filter::nearest),
      blurred_(depth_.width(), depth_.height(), GL_R32UI, gpu::Filter::nearest),
      tiles_((width + 15) / 16, (height + 15) / 16, GL_R32F, gpu::Filter::nearest),
      depth_target_({&depth_}, nullptr),
      raw_target_({&raw_}, nullptr),
      blurred_target_({&blurred_}, nullptr),
      tiles_target_({&tiles_}, nullptr),
      // Bodies and floor share text with the light pass; no shadow is looked up here.
      gather_("full_screen.vert", "occlusion_depth.frag",
              {"SIDE " + std::to_string(samples_across), "SHADOW_TAPS 1",
               "OCCLUSION_SCALE " + std::to_string(scale)}),
      sample_("full_screen.vert", "occlusion.frag",
              {"OCCLUSION_TAPS " + std::to_string(taps), "OCCLUSION_SCALE " + std::to_string(scale)}),
      blur_("full_screen.vert", "occlusion_blur.frag"),
      reduce_("full_screen.vert", "occlusion_tiles.frag", {"OCCLUSION_SCALE " + std::to_string(scale)}) {}

void OcclusionPass::run(const gpu::Texture& opaque_depth) const {
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  depth_target_.bind();
  gather_.use();
  opaque_depth.bind(5);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  raw_target_.bind();
  sample_.use();
  depth_.bind(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  blurred_target_.bind();
  blur_.use();
  raw_.bind(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
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
