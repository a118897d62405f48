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

  // The block must be bound. Draws each map only if one of its casters, or its place, is not as it was.
  void run(const MeshStore& meshes, const FrameBlock& block);
  void forget() { drawn_solids_ = drawn_glass_ = Drawn{}; }  // draws both when next asked
  void bind() const;                                         // texture units 0, 1, 2, 11

 private:
  struct Caster {
    std::uint64_t mesh;  // StoredMesh::id
    glm::mat4 world_from_body;
    bool operator==(const Caster&) const = default;
  };
  struct Drawn {
    std::vector<Caster> casters;
    glm::mat4 place{0.0F};  // shadow_from_world; no map has this one
    bool operator==(const Drawn&) const = default;
  };
  // Draws the map's casters unless they are those drawn; tells whether it did.
  bool draw_casters(const MeshStore& meshes, const FrameBlock& block, bool is_glass, Drawn& drawn) const;
  void reduce();

  gpu::Texture depth_compared_, glass_compared_, tile_bounds_, tile_casters_, near_bounds_, near_casters_;
  gpu::Framebuffer map_, glass_map_, tiles_, near_;
  gpu::Program depth_, reduce_, spread_;
  int map_size_;
  Drawn drawn_solids_, drawn_glass_;
};

}  // namespace shatterbox::render::pass
