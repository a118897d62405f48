#include "render/pass/surface.h"

#include <glad/gl.h>

namespace shatterbox::render::pass {
namespace {

// The colours need no clearing: only samples with a depth are read.
void clear_depth(double depth) {
  glClearDepth(depth);
  glClear(GL_DEPTH_BUFFER_BIT);
  glClearDepth(1.0);
}

void draw_items(const MeshStore& meshes, bool is_glass) {
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  meshes.bind_vertices();
  for (const Item& item : meshes.items()) {
    if (item.is_on_screen && item.is_glass == is_glass) meshes.draw(item, Part::all);
  }
  glDisable(GL_CULL_FACE);
  glDepthFunc(GL_LESS);
}

}  // namespace

Layer::Layer(int width, int height)
    : seen(width, height, GL_RGBA32UI, gpu::Filter::nearest),
      depth(width, height, GL_DEPTH_COMPONENT32F, gpu::Filter::nearest),
      target({&seen}, &depth) {}

void Layer::bind(unsigned seen_unit, unsigned depth_unit) const {
  seen.bind(seen_unit);
  depth.bind(depth_unit);
}

SurfacePass::SurfacePass(int width, int height)
    : opaque_(width, height),
      program_("surface.vert", "surface.frag"),
      far_program_("surface.vert", "surface.frag", {"FAR_LAYER"}) {}

void SurfacePass::run(const MeshStore& meshes) const {
  opaque_.target.bind();
  clear_depth(1.0);
  glDepthFunc(GL_LESS);
  program_.use();
  draw_items(meshes, false);
}

void SurfacePass::run_glass(const MeshStore& meshes) {
  if (glass_near_.seen.name() == 0) {
    glass_near_ = Layer(opaque_.seen.width(), opaque_.seen.height());
    glass_far_ = Layer(opaque_.seen.width(), opaque_.seen.height());
  }
  glass_near_.target.bind();
  clear_depth(1.0);
  glDepthFunc(GL_LESS);
  program_.use();
  draw_items(meshes, true);
  glass_far_.target.bind();
  clear_depth(0.0);
  glDepthFunc(GL_GREATER);
  far_program_.use();
  opaque_.depth.bind(0);
  draw_items(meshes, true);
}

}  // namespace shatterbox::render::pass
