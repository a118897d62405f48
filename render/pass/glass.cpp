#include "render/pass/glass.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

GlassPass::GlassPass(int samples_across) {
  const std::string side = "SIDE " + std::to_string(samples_across);
  near_ = gpu::Program("tile.vert", "glass.frag", {side, "GLASS"});
  far_ = gpu::Program("tile.vert", "glass.frag", {side, "GLASS", "FAR_LAYER"});
}

void GlassPass::run(const SurfacePass& surface, const Tiles& tiles) const {
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  surface.opaque().depth.bind(7);
  surface.glass_near().depth.bind(8);
  for (const bool is_far : {true, false}) {
    (is_far ? surface.glass_far() : surface.glass_near()).bind(4, 5);
    (is_far ? far_ : near_).use();
    tiles.draw_glass();
  }
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE,
              GL_ZERO);  // Mesa refuses passes with two targets while a second source is named, even disabled
}

}  // namespace shatterbox::render::pass
