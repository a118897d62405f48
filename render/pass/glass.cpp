#include "render/pass/glass.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

GlassPass::GlassPass(int shadow_taps)
    : program_("surface.vert", "glass.frag", {"SHADOW_TAPS " + std::to_string(shadow_taps)}) {}

void GlassPass::run(const MeshStore& meshes) const {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  glEnable(GL_CULL_FACE);
  meshes.bind_vertices();
  program_.use();
  const auto& items = meshes.items();
  for (auto item = items.rbegin(); item != items.rend(); ++item) {
    if (!item->is_on_screen || !item->is_glass) continue;
    // Of a hollow body the inner faces that look here are the far ones.
    meshes.draw(*item, Part::inner);
    meshes.draw(*item, Part::outer_and_rim);
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
}

}  // namespace shatterbox::render::pass
