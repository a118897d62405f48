#include "render/pass/surface.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

SurfacePass::SurfacePass(int shadow_taps)
    : program_("surface.vert", "surface.frag", {"SHADOW_TAPS " + std::to_string(shadow_taps)}) {}

void SurfacePass::run(const MeshStore& meshes) const {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  meshes.bind_vertices();
  program_.use();
  for (const Item& item : meshes.items()) {
    if (item.is_on_screen && !item.is_glass) meshes.draw(item, Part::all);
  }
  glDisable(GL_CULL_FACE);
}

}  // namespace shatterbox::render::pass
