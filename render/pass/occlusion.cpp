#include "render/pass/occlusion.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

OcclusionPass::OcclusionPass(int width, int height, int taps)
    : depth_((width + 1) / 2, (height + 1) / 2, GL_DEPTH_COMPONENT32F, gpu::Filter::nearest),
      raw_(depth_.width(), depth_.height(), GL_RG32F, gpu::Filter::nearest),
      blurred_(depth_.width(), depth_.height(), GL_RG32F, gpu::Filter::nearest),
      depth_target_({}, &depth_),
      raw_target_({&raw_}, nullptr),
      blurred_target_({&blurred_}, nullptr),
      depth_program_("occlusion_depth.vert", ""),
      ground_program_("ground.vert", ""),
      sample_("full_screen.vert", "occlusion.frag", {"OCCLUSION_TAPS " + std::to_string(taps)}),
      blur_("full_screen.vert", "occlusion_blur.frag") {}

void OcclusionPass::run(const MeshStore& meshes, bool has_ground) const {
  depth_target_.bind();
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glClear(GL_DEPTH_BUFFER_BIT);
  glEnable(GL_CULL_FACE);
  meshes.bind_vertices();
  depth_program_.use();
  for (const Item& item : meshes.items()) {
    if (item.is_on_screen && !item.is_glass) meshes.draw(item, Part::all);
  }
  glDisable(GL_CULL_FACE);
  if (has_ground) {
    ground_program_.use();
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDisable(GL_DEPTH_TEST);
  raw_target_.bind();
  sample_.use();
  depth_.bind(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  blurred_target_.bind();
  blur_.use();
  raw_.bind(0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void OcclusionPass::bind() const {
  blurred_.bind(3);
}

}  // namespace shatterbox::render::pass
