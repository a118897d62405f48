#include "render/pass/surface.h"

#include <glad/gl.h>

namespace shatterbox::render::pass {
namespace {

// The colours need no clearing: only samples with a depth are read.
void clear_depth() {
  glDepthMask(GL_TRUE);
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void draw_items(const MeshStore& meshes, bool is_glass, Part part) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  meshes.bind_vertices();
  for (const Item& item : meshes.items()) {
    if (item.is_on_screen && item.is_glass == is_glass) meshes.draw(item, part);
  }
  glDisable(GL_CULL_FACE);
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

SurfacePass::SurfacePass(int width, int height, int samples_across)
    : opaque_(width * samples_across, height * samples_across), program_("surface.vert", "surface.frag") {}

void SurfacePass::run(const MeshStore& meshes) const {
  opaque_.target.bind();
  clear_depth();
  program_.use();
  draw_items(meshes, false, Part::all);
}

void SurfacePass::run_glass(const MeshStore& meshes) {
  if (glass_faces_.seen.name() == 0) {
    glass_faces_ = Layer(opaque_.seen.width(), opaque_.seen.height());
    glass_rims_ = Layer(opaque_.seen.width(), opaque_.seen.height());
  }
  program_.use();
  glass_faces_.target.bind();
  clear_depth();
  draw_items(meshes, true, Part::faces);
  glass_rims_.target.bind();
  clear_depth();
  draw_items(meshes, true, Part::rims);
}

}  // namespace shatterbox::render::pass
