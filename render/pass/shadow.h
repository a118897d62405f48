// The sun's depth map, fitted about what casts shadows into the picture, and its tiles (shaders/shadow*).
#pragma once
#include <cstdint>
#include <vector>

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

  // The block must be bound. Draws nothing when every caster, and the map's place, is as it was.
  void run(const MeshStore& meshes, const FrameBlock& block);
  void bind() const;  // texture units 0, 1, 2, 11

 private:
  void draw_casters(const MeshStore& meshes, const gpu::Framebuffer& map, bool is_glass) const;

  gpu::Texture depth_compared_, glass_compared_, tile_bounds_, tile_casters_, near_bounds_, near_casters_;
  gpu::Framebuffer map_, glass_map_, tiles_, near_;
  gpu::Program depth_, reduce_, spread_;
  int map_size_;

  struct Caster {
    std::uint64_t mesh;  // StoredMesh::id
    glm::mat4 world_from_body;
    bool is_glass;
    bool operator==(const Caster&) const = default;
  };
  std::vector<Caster> drawn_casters_;
  glm::mat4 drawn_place_{0.0F};  // shadow_from_world; no map has this one
};

}  // namespace shatterbox::render::pass
