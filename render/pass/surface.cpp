#include "render/pass/surface.h"

#include <glad/gl.h>

namespace shatterbox::render::pass {
namespace {

constexpr float kLineSamples = 1.3F;  // a rim no wider is drawn as a line

// part: of each item.
template <typename PartOf>
void draw_items(const MeshStore& meshes, const Changes& changes, bool is_glass, PartOf part) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  meshes.bind_vertices();
  for (const Item& item : meshes.items()) {
    if (item.is_on_screen && item.is_glass == is_glass && changes.touches(item))
      meshes.draw(item, part(item));
  }
}

}  // namespace

Layer::Layer(int width, int height)
    : seen(width, height, GL_RGBA32UI, gpu::Filter::nearest),
      depth(width, height, GL_DEPTH_COMPONENT32F, gpu::Filter::nearest),
      target({&seen}, &depth) {
  // Made in the midst of a film it is nowhere drawn but in the tiles that change.
  const float farthest = 1.0F;
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(target.name(), GL_DEPTH, 0, &farthest);
}

void Layer::bind(unsigned seen_unit, unsigned depth_unit) const {
  seen.bind(seen_unit);
  depth.bind(depth_unit);
}

SurfacePass::SurfacePass(int width, int height, int samples_across, int glass_faces, const TileReset& reset)
    : samples_across_(samples_across),
      opaque_(width * samples_across, height * samples_across),
      glass_faces_(static_cast<std::size_t>(glass_faces)),
      program_("surface.vert", "surface.frag"),
      reset_(&reset) {}

// The colours need no clearing: only samples with a depth are read.
void SurfacePass::run(const MeshStore& meshes, const Tiles& tiles, const Changes& changes) const {
  opaque_.target.bind();
  reset_->reset_depth(changes.bodies(), tiles.changed_bodies());
  program_.use();
  glEnable(GL_CULL_FACE);
  draw_items(meshes, changes, false, [](const Item&) { return Part::all; });
  glDisable(GL_CULL_FACE);
}

void SurfacePass::run_glass(const MeshStore& meshes, const Tiles& tiles, const Changes& changes) {
  if (!has_glass()) {
    for (Layer& layer : glass_faces_) layer = Layer(opaque_.seen.width(), opaque_.seen.height());
    glass_rims_ = Layer(opaque_.seen.width(), opaque_.seen.height());
    behind_ = gpu::Program("surface.vert", "surface.frag", {"BEHIND"});
  }
  glDisable(GL_CULL_FACE);  // one face of a thin pane stands for both
  for (std::size_t i = 0; i < glass_faces_.size(); ++i) {
    glass_faces_[i].target.bind();
    reset_->reset_depth(changes.glass(), tiles.changed_glass());
    if (i > 0) glass_faces_[i - 1].depth.bind(5);
    (i > 0 ? behind_ : program_).use();
    draw_items(meshes, changes, true, [](const Item&) { return Part::outer; });
  }
  glass_rims_.target.bind();
  reset_->reset_depth(changes.glass(), tiles.changed_glass());
  program_.use();
  glEnable(GL_CULL_FACE);
  const auto samples = static_cast<float>(samples_across_);
  draw_items(meshes, changes, true, [samples](const Item& item) {
    return samples * item.rim_pixels > kLineSamples ? Part::rims : Part::rim_lines;
  });
  glDisable(GL_CULL_FACE);
}

}  // namespace shatterbox::render::pass
