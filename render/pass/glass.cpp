#include "render/pass/glass.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

GlassPass::GlassPass(int samples_across)
    : plain_("tile.vert", "glass.frag", {"SIDE " + std::to_string(samples_across)}),
      patterned_("tile.vert", "glass.frag", {"SIDE " + std::to_string(samples_across), "PATTERNS"}) {}

void GlassPass::run(const SurfacePass& surface, const Tiles& tiles, bool has_patterns) const {
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  surface.glass_faces().bind(4, 5);
  surface.opaque().depth.bind(7);
  surface.glass_rims().bind(8, 9);
  (has_patterns ? patterned_ : plain_).use();
  tiles.draw_glass();
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE,
              GL_ZERO);  // Mesa refuses passes with two targets while a second source is named, even disabled
}

}  // namespace shatterbox::render::pass
