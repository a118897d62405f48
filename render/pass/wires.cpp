#include "render/pass/wires.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {
namespace {

constexpr int kLight = 0;  // uniform of wires.frag

}  // namespace

void WiresPass::run(const MeshStore& meshes, const Layer& opaque, const gpu::Framebuffer& drawn) {
  if (program_.name() == 0)
    program_ = gpu::Program("surface.vert", "wires.frag", {"SIDE " + std::to_string(samples_across_)});
  drawn.bind();
  opaque.depth.bind(5);
  program_.use();
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  meshes.bind_vertices();
  for (const Item& item : meshes.items()) {
    if (!item.is_on_screen) continue;
    gpu::Program::set(kLight, item.is_glass ? 0.9F : 0.01F);
    meshes.draw(item, meshes.shadow_part(item));
  }
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO);
}

}  // namespace shatterbox::render::pass
