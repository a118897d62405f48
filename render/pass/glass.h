// Thin glass, far to near, over what is behind it (shaders/surface.vert, glass.frag).
#pragma once
#include "render/gpu/program.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

class GlassPass {
 public:
  explicit GlassPass(int shadow_taps);
  void run(const MeshStore& meshes) const;

 private:
  gpu::Program program_;
};

}  // namespace shatterbox::render::pass
