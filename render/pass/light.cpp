#include "render/pass/light.h"

#include <glad/gl.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "render/pass/paint_table.h"

namespace shatterbox::render::pass {
namespace {

std::vector<std::string> with(std::vector<std::string> defines, std::initializer_list<const char*> more) {
  defines.insert(defines.end(), more.begin(), more.end());
  return defines;
}

// As dimming_tiles.frag tells tiles apart.
constexpr int kChangesSlowly = 1, kHasEdge = 2;

}  // namespace

LightPass::LightPass(int width, int height, int shadow_taps, int samples_across, int occlusion_scale,
                     const TileReset& reset)
    : samples_across_(samples_across),
      defines_({"SHADOW_TAPS " + std::to_string(shadow_taps), "SIDE " + std::to_string(samples_across),
                "OCCLUSION_SCALE " + std::to_string(occlusion_scale)}),
      dimming_((width + 1) / 2, (height + 1) / 2, GL_R16UI, gpu::Filter::nearest),
      need_((width + 15) / 16, (height + 15) / 16, GL_R8UI, gpu::Filter::nearest),
      dimming_target_({&dimming_}, nullptr),
      need_target_({&need_}, nullptr),
      dim_("tile.vert", "dimming.frag", defines_),
      dim_occluded_("tile.vert", "dimming.frag", with(defines_, {"NO_SHADOW", "IF_OCCLUDED"})),
      reduce_("full_screen.vert", "dimming_tiles.frag"),
      reset_(&reset) {
  const auto floor = [&](std::initializer_list<const char*> more) {
    return gpu::Program("tile.vert", "floor.frag", with(with(defines_, {"IF_NEEDED"}), more));
  };
  between_ = {floor({"FLOOR SMOOTH"}), floor({"FLOOR FADING"}), floor({"FLOOR PATTERNED"})};
  if (samples_across_ == 1) return;
  at_pixels_ = {floor({"EXACT", "FLOOR SMOOTH"}), floor({"EXACT", "FLOOR FADING"}),
                floor({"EXACT", "FLOOR PATTERNED"})};
  cover_ = gpu::Program("tile.vert", "cover.frag", defines_);
}

const gpu::Program& LightPass::bodies(unsigned pattern_kinds) {
  pattern_kinds &= ~kCloudy;
  gpu::Program& program = bodies_[pattern_kinds];
  if (program.name() == 0) {
    const std::string patterns = "PATTERNS " + std::to_string(pattern_kinds);
    program = gpu::Program("tile.vert", "light.frag", with(defines_, {patterns.c_str()}));
  }
  return program;
}

void LightPass::dim(const Tiles& tiles, const Changes::Marks& changed) const {
  constexpr unsigned kUndimmed = 0xffffU;  // as dimming.glsl packs it
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  dimming_target_.bind();
  reset_->reset_value(changed, tiles.changed_light(), kUndimmed);
  dim_.use();
  Tiles::draw(tiles.shaded());
  dim_occluded_.use();
  Tiles::draw(tiles.occluded());
  dimming_.bind(10);
  need_target_.bind();
  reduce_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  need_.bind(12);
}

void LightPass::draw_floor(const FloorPrograms& programs, const Tiles::Floor& floor, int least_need,
                           int most_need) const {
  const auto draw = [=](const gpu::Program& program, Tiles::Range range) {
    program.use();
    gpu::Program::set(kTileDepth, 0.5F);
    gpu::Program::set(kLeastNeed, least_need);
    gpu::Program::set(kMostNeed, most_need);
    Tiles::draw(range);
  };
  draw(programs.smooth, floor.smooth);
  draw(is_patterned_ ? programs.patterned : programs.fading, floor.uneven);
}

// One sample a pixel: the depth that the geometry left says where bodies are.
// More: pixels of which bodies fill a part are blended over the floor.
void LightPass::draw_samples(const Tiles& tiles, const gpu::Program& light) const {
  glDepthMask(GL_FALSE);
  light.use();
  if (samples_across_ == 1) {
    glDepthFunc(GL_GREATER);
    gpu::Program::set(kTileDepth, 1.0F);
    return Tiles::draw(tiles.bodies());
  }
  glDepthFunc(GL_EQUAL);
  gpu::Program::set(kTileDepth, 0.5F);
  Tiles::draw(tiles.bodies());
  glDepthFunc(GL_LESS);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gpu::Program::set(kTileDepth, 0.75F);
  Tiles::draw(tiles.bodies());
  glDisable(GL_BLEND);
}

void LightPass::run(const Layer& opaque, const gpu::Framebuffer& drawn, const Tiles& tiles,
                    unsigned pattern_kinds, bool is_patterned) {
  is_patterned_ = is_patterned;
  if (samples_across_ == 1 && on_opaque_.name() == 0) on_opaque_ = gpu::Framebuffer(drawn, opaque.depth);
  (samples_across_ == 1 ? on_opaque_ : drawn).bind();
  if (samples_across_ == 1) {
    draw_floor(between_, tiles.open_floor(), kChangesSlowly, kHasEdge);
    draw_floor(between_, tiles.floor_behind_bodies(), kChangesSlowly, kHasEdge);
    glEnable(GL_DEPTH_TEST);
  } else {
    draw_floor(between_, tiles.open_floor(), kChangesSlowly, kChangesSlowly);
    draw_floor(at_pixels_, tiles.open_floor(), kHasEdge, kHasEdge);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    cover_.use();
    Tiles::draw(tiles.bodies());
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_NOTEQUAL);  // bodies that fill a pixel wrote a half
    draw_floor(at_pixels_, tiles.floor_behind_bodies(), kChangesSlowly, kHasEdge);
  }
  draw_samples(tiles, bodies(pattern_kinds));
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
}

}  // namespace shatterbox::render::pass
