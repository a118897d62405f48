// Depth, normal and id of what each pixel's middle sees, of the draws of the last frame. Glass is as solid as
// anything else.
#pragma once
#include "render/frame/truth.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/frame_block.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

class TruthPass {
 public:
  // Its textures and program are made when first called. `ground_id`: of the floor, if there is one.
  Truth run(const MeshStore& meshes, const FrameBlock& values, std::uint32_t ground_id);

 private:
  void make(int width, int height);
  void read(Truth& truth) const;

  gpu::Texture normal_depth_, id_, depth_;
  gpu::Framebuffer target_;
  gpu::Program program_;
};

}  // namespace shatterbox::render::pass
