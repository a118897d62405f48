#include "render/pass/light.h"

#include <glad/gl.h>

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

namespace shatterbox::render::pass {
namespace {

std::vector<std::string> defines_of(int shadow_taps, int samples_across, int occlusion_scale,
                                    bool is_preview) {
  std::vector<std::string> defines = {"SHADOW_TAPS " + std::to_string(shadow_taps),
                                      "SIDE " + std::to_string(samples_across),
                                      "OCCLUSION_SCALE " + std::to_string(occlusion_scale)};
  if (is_preview) defines.emplace_back("PREVIEW");
  return defines;
}

std::vector<std::string> with(std::vector<std::string> defines, std::initializer_list<const char*> more) {
  defines.insert(defines.end(), more.begin(), more.end());
  return defines;
}

constexpr int kTileDepth = 1;  // the uniform's place in tile.vert

}  // namespace

LightPass::LightPass(int width, int height, int shadow_taps, int samples_across, int occlusion_scale,
                     bool is_preview)
    : defines_(defines_of(shadow_taps, samples_across, occlusion_scale, is_preview)),
      cover_("tile.vert", "cover.frag", {"SIDE " + std::to_string(samples_across)}),
      floor_("tile.vert", "floor.frag", defines_),
      dimmed_("tile.vert", "floor.frag", with(defines_, {"NO_SHADOW", "IF_DIMMED"})) {
  if (!is_preview) return;
  dimming_ = gpu::Texture((width + 1) / 2, (height + 1) / 2, GL_R32UI, gpu::Filter::nearest);
  dimming_target_ = gpu::Framebuffer({&dimming_}, nullptr);
  const auto defines = defines_of(shadow_taps, samples_across, occlusion_scale, false);
  dim_ = gpu::Program("tile.vert", "dimming.frag", defines);
  dim_if_dimmed_ = gpu::Program("tile.vert", "dimming.frag", with(defines, {"IF_DIMMED"}));
}

const gpu::Program& LightPass::bodies(unsigned pattern_kinds) {
  gpu::Program& program = bodies_[pattern_kinds];
  if (program.name() == 0) {
    const std::string patterns = "PATTERNS " + std::to_string(pattern_kinds);
    program = gpu::Program("tile.vert", "light.frag", with(defines_, {patterns.c_str()}));
  }
  return program;
}

void LightPass::dim(const Layer& opaque, const Tiles& tiles) const {
  if (dimming_.name() == 0) return;
  dimming_target_.bind();
  const std::array<unsigned, 4> undimmed = {0x3c007fffU, 0U, 0U, 0U};  // as dimming.glsl packs it
  glClearBufferuiv(GL_COLOR, 0, undimmed.data());
  opaque.bind(4, 5);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  dim_.use();
  tiles.draw_bodies();
  tiles.draw_shaded_floor();
  dim_if_dimmed_.use();
  tiles.draw_dimmed_floor();
  dimming_.bind(10);
}

void LightPass::run(const Layer& opaque, const Tiles& tiles, unsigned pattern_kinds) {
  opaque.bind(4, 5);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glDepthMask(GL_TRUE);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  cover_.use();
  tiles.draw_bodies();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_FALSE);

  glDepthFunc(GL_GREATER);  // where a body leaves something to see
  floor_.use();
  gpu::Program::set(kTileDepth, 0.99F);
  tiles.draw_bodies();
  glDepthFunc(GL_LESS);  // where there is one
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  bodies(pattern_kinds).use();
  gpu::Program::set(kTileDepth, 0.01F);
  tiles.draw_bodies();
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);

  floor_.use();
  tiles.draw_shaded_floor();
  dimmed_.use();
  tiles.draw_dimmed_floor();
}

}  // namespace shatterbox::render::pass
