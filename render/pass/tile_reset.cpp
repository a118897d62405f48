#include "render/pass/tile_reset.h"

#include <glad/gl.h>

#include <array>

namespace shatterbox::render::pass {
namespace {

constexpr int kValue = 4;  // the uniform's place

}  // namespace

TileReset::TileReset() : depth_("tile.vert", ""), value_("tile.vert", "tile_reset.frag") {}

void TileReset::reset_depth(const Changes::Marks& marks, Tiles::Range changed) const {
  glDepthMask(GL_TRUE);
  if (marks.is_all) {
    glClearDepth(1.0);
    glClear(GL_DEPTH_BUFFER_BIT);
    return;
  }
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  depth_.use();
  gpu::Program::set(kTileDepth, 1.0F);
  Tiles::draw(changed);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void TileReset::reset_value(const Changes::Marks& marks, Tiles::Range changed, unsigned value) const {
  if (marks.is_all) {
    const std::array<unsigned, 4> values = {value, 0U, 0U, 0U};
    glClearBufferuiv(GL_COLOR, 0, values.data());
    return;
  }
  glDisable(GL_BLEND);
  glDisable(GL_DEPTH_TEST);
  value_.use();
  gpu::Program::set(kValue, static_cast<int>(value));
  Tiles::draw(changed);
}

}  // namespace shatterbox::render::pass
