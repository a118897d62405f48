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
  explicit ShadowPass(int map_size);  // texels a side, a multiple of 16; made when something first casts

  // Chooses the map's place: in steps, so that shadow edges hold still while bodies move. Fills the block's
  // shadow members; sun_radiance.w stays 0 when nothing casts.
  void fit(const Frame& frame, const MeshStore& meshes, FrameBlock& block) const;

  // The block must be bound. Draws each map only where one of its casters, or its place, is not as it was.
  void run(const MeshStore& meshes, const FrameBlock& block);
  void forget() { drawn_solids_ = drawn_glass_ = Drawn{}; }  // draws both when next asked
  void bind() const;                                         // texture units 0, 1, 2, 11
  bool has_maps() const { return depth_.name() != 0; }
  double bytes() const;  // of the maps; 0 until there are any

 private:
  struct Caster {
    std::uint64_t mesh;  // StoredMesh::id
    glm::mat4 world_from_body;
    glm::vec2 least, most;  // on the map, 0..1
  };
  // What a map shows; kept while its place is the same.
  struct Drawn {
    std::vector<Caster> casters;  // by mesh and place
    glm::mat4 place{0.0F};        // shadow_from_world; no map has this one
  };
  // Of a map, in texels of it: what is not as it was drawn. Empty: nothing.
  struct Part {
    int left = 0, bottom = 0, right = 0, top = 0;
    bool is_empty() const { return left >= right || bottom >= top; }
  };
  static Part find_changed(const Drawn& drawn, const Drawn& wanted, int map_size);
  // Draws the map's casters where they are not those drawn; tells where.
  Part draw_casters(const MeshStore& meshes, const FrameBlock& block, bool is_glass, Drawn& drawn) const;
  void reduce(const Part& changed);
  void make_maps(int size);

  gpu::Texture depth_compared_, glass_compared_, tile_bounds_, tile_casters_, near_bounds_, near_casters_;
  gpu::Framebuffer map_, glass_map_, tiles_, near_;
  gpu::Program depth_, reduce_, spread_;
  int map_size_;
  Drawn drawn_solids_, drawn_glass_;
};

}  // namespace shatterbox::render::pass
