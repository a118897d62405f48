// Opaque bodies, near to far (shaders/surface).
#pragma once
#include "render/gpu/program.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

class SurfacePass {
 public:
  explicit SurfacePass(int shadow_taps);
  void run(const MeshStore& meshes) const;

 private:
  gpu::Program program_;
};

}  // namespace shatterbox::render::pass
