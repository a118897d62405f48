// Geometry: what each sample sees, packed for the light pass (shaders/surface). Glass has two layers of its
// own, the nearest and the farthest: cheap, and enough for panes, shards and vessels.
#pragma once
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

// One sample's worth of what is seen, and its depth.
struct Layer {
  Layer() = default;
  Layer(int width, int height);
  void bind(unsigned seen_unit, unsigned depth_unit) const;
  gpu::Texture seen, depth;
  gpu::Framebuffer target;
};

class SurfacePass {
 public:
  SurfacePass(int width, int height);  // in samples
  void run(const MeshStore& meshes) const;
  void run_glass(const MeshStore& meshes);  // after run; its layers are made at the first call
  const Layer& opaque() const { return opaque_; }
  const Layer& glass_near() const { return glass_near_; }
  const Layer& glass_far() const { return glass_far_; }

 private:
  Layer opaque_, glass_near_, glass_far_;
  gpu::Program program_, far_program_;
};

}  // namespace shatterbox::render::pass
