#include "render/pass/glass.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

GlassPass::GlassPass(int samples_across) : side_("SIDE " + std::to_string(samples_across)) {}

void GlassPass::run(const SurfacePass& surface, const Tiles& tiles, unsigned pattern_kinds) {
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  surface.glass_faces().bind(4, 5);
  surface.opaque().depth.bind(7);
  surface.glass_rims().bind(8, 9);
  gpu::Program& program = programs_[pattern_kinds];
  if (program.name() == 0) {
    program = gpu::Program("tile.vert", "glass.frag", {side_, "PATTERNS " + std::to_string(pattern_kinds)});
  }
  program.use();
  Tiles::draw(tiles.glass());
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE,
              GL_ZERO);  // Mesa refuses passes with two targets while a second source is named, even disabled
}

}  // namespace shatterbox::render::pass
