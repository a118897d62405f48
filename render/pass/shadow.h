// The sun's depth map, fitted about what casts shadows into the picture, and its tiles (shaders/shadow*).
#pragma once
#include "render/frame/frame.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/frame_block.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

class ShadowPass {
 public:
  explicit ShadowPass(int map_size);  // texels a side, a multiple of 16

  // Chooses the map's place: in steps, so that shadow edges hold still while bodies move. Fills the block's
  // shadow members; sun_radiance.w stays 0 when nothing casts.
  void fit(const Frame& frame, const MeshStore& meshes, FrameBlock& block) const;

  void run(const MeshStore& meshes) const;  // the block must be bound
  void bind() const;                        // texture units 0, 1, 2

 private:
  gpu::Texture depth_compared_, tile_bounds_, tile_casters_, near_bounds_, near_casters_;
  gpu::Framebuffer map_, tiles_, near_;
  gpu::Program opaque_, glass_, reduce_, spread_;
  int map_size_;
};

}  // namespace shatterbox::render::pass
