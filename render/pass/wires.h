// The edges of all triangles, over the finished bodies: what the simulation sees of them.
#pragma once
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/pass/mesh_store.h"
#include "render/pass/surface.h"

namespace shatterbox::render::pass {

class WiresPass {
 public:
  explicit WiresPass(int samples_across) : samples_across_(samples_across) {}

  // Onto `drawn`; `opaque` tells what hides.
  void run(const MeshStore& meshes, const Layer& opaque, const gpu::Framebuffer& drawn);

 private:
  int samples_across_;
  gpu::Program program_;  // made when it is first wanted
};

}  // namespace shatterbox::render::pass
