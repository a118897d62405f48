#include "render/pass/glass.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

constexpr int kTileDepth = 1;  // the uniform's place in tile.vert

GlassPass::GlassPass(int samples_across)
    : side_("SIDE " + std::to_string(samples_across)), cover_("tile.vert", "glass_cover.frag", {side_}) {}

const GlassPass::Programs& GlassPass::programs(unsigned pattern_kinds) {
  Programs& found = programs_[pattern_kinds];
  if (found.faces.name() == 0) {
    const std::string patterns = "PATTERNS " + std::to_string(pattern_kinds);
    found.faces = gpu::Program("tile.vert", "glass.frag", {side_, patterns});
    found.rims = gpu::Program("tile.vert", "glass.frag", {side_, patterns, "RIMS"});
  }
  return found;
}

void GlassPass::run(const SurfacePass& surface, const Tiles& tiles, unsigned pattern_kinds) {
  surface.glass_faces().bind(4, 5);
  surface.opaque().depth.bind(7);
  surface.glass_rims().bind(8, 9);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  cover_.use();
  Tiles::draw(tiles.glass());
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  const Programs& glass = programs(pattern_kinds);
  const auto draw = [&](const gpu::Program& program, GLenum comparison, float depth) {
    program.use();
    glDepthFunc(comparison);
    gpu::Program::set(kTileDepth, depth);
    Tiles::draw(tiles.glass());
  };
  draw(glass.faces, GL_EQUAL, 0.5F);
  draw(glass.rims, GL_LESS, 0.75F);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  // Mesa refuses passes with two targets while a second source is named, even disabled.
  glBlendFunc(GL_ONE, GL_ZERO);
}

}  // namespace shatterbox::render::pass
