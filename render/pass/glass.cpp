#include "render/pass/glass.h"

#include <glad/gl.h>

#include <string>

#include "render/pass/paint_table.h"

namespace shatterbox::render::pass {
namespace {

constexpr unsigned kPatterns = ~kMirrors;  // of what a frame shows

}  // namespace

GlassPass::GlassPass(int samples_across, int shadow_taps)
    : samples_across_(samples_across),
      side_("SIDE " + std::to_string(samples_across)),
      defines_({side_, "SHADOW_TAPS " + std::to_string(shadow_taps), "CLEAR " + std::to_string(kClear)}),
      rims_("tile.vert", "glass.frag", {side_, "RIMS"}) {
  if (samples_across_ > 1) cover_ = gpu::Program("tile.vert", "glass_cover.frag", {side_});
}

const gpu::Program& GlassPass::faces(unsigned pattern_kinds) {
  pattern_kinds &= kPatterns;
  gpu::Program& program = faces_[pattern_kinds];
  if (program.name() == 0) {
    std::vector<std::string> defines = defines_;
    defines.push_back("PATTERNS " + std::to_string(pattern_kinds));
    program = gpu::Program("tile.vert", "glass.frag", defines);
  }
  return program;
}

// Where there is glass, as depth: so that the costly programs skip blocks of pixels without. With one sample
// a pixel the layers' own depths tell that.
void GlassPass::find_cover(const SurfacePass& surface, const gpu::Framebuffer& drawn, const Tiles& tiles) {
  if (samples_across_ == 1) {
    if (on_rims_.name() == 0) {
      for (const Layer& layer : surface.glass_faces()) on_faces_.emplace_back(drawn, layer.depth);
      on_rims_ = gpu::Framebuffer(drawn, surface.glass_rims().depth);
    }
    return;
  }
  drawn.bind();
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  surface.glass_faces()[0].bind(4, 5);
  surface.glass_rims().depth.bind(9);
  surface.glass_faces()[1].depth.bind(10);
  cover_.use();
  Tiles::draw(tiles.glass());
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void GlassPass::run(const SurfacePass& surface, const gpu::Framebuffer& drawn, const Tiles& tiles,
                    unsigned pattern_kinds) {
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  surface.opaque().depth.bind(7);
  find_cover(surface, drawn, tiles);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  const bool is_direct = samples_across_ == 1;
  glDepthFunc(is_direct ? GL_GREATER : GL_LESS);
  const auto draw = [&](const gpu::Program& program, const Layer& layer, const gpu::Framebuffer& direct,
                        float depth) {
    if (is_direct) direct.bind();
    layer.bind(4, 5);
    program.use();
    gpu::Program::set(kTileDepth, is_direct ? 1.0F : depth);
    Tiles::draw(tiles.glass());
  };
  const auto draw_faces = [&](std::size_t number, float depth) {
    draw(faces(pattern_kinds), surface.glass_faces()[number], is_direct ? on_faces_[number] : drawn, depth);
  };
  for (std::size_t number = surface.glass_faces().size() - 1; number > 0; --number) draw_faces(number, 0.8F);
  draw(rims_, surface.glass_rims(), on_rims_, 0.45F);
  draw_faces(0, 0.15F);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  // Mesa refuses passes with two targets while a second source is named, even disabled.
  glBlendFunc(GL_ONE, GL_ZERO);
}

}  // namespace shatterbox::render::pass
