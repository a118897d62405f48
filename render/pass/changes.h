// Which tiles of the picture this frame may change, pass by pass: the renderer keeps what it drew last, and
// draws only these anew. The law: never too few, so that the picture equals that of a renderer which draws it
// all.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "render/pass/frame_block.h"
#include "render/pass/mesh_store.h"
#include "render/pass/tile_grid.h"

namespace shatterbox::render::pass {

class Changes {
 public:
  struct Marks {
    bool is_all = true;
    std::vector<char> tiles;  // one a tile, as TileGrid orders them; not up to date if all are marked
    int count = 0;            // of marked tiles

    bool has(std::size_t tile) const { return is_all || tiles[tile] != 0; }
    bool is_none() const { return !is_all && count == 0; }
  };

  // occlusion_scale: as OcclusionPass takes it.
  Changes(int width, int height, int occlusion_scale);

  // Against the frame of the last call. After the store's prepare and the shadow's fit. The marks: as Tiles
  // tells.
  void find(const MeshStore& meshes, const FrameBlock& block, const std::vector<char>& near_marks,
            const std::vector<char>& changed_marks);
  void forget();  // in the next frame all is new

  const Marks& bodies() const { return bodies_; }      // geometry that is not glass
  const Marks& glass() const { return glass_; }        // geometry of glass
  const Marks& occluded() const { return occluded_; }  // occlusion
  const Marks& lit() const { return lit_; }            // all that follows; holds the others
  bool is_nothing() const { return lit_.is_none(); }
  double lit_share() const {
    return lit_.is_all ? 1.0 : static_cast<double>(lit_.count) / static_cast<double>(grid_.count());
  }

  // Whether a part of it may be in the geometry to be drawn anew.
  bool touches(const Item& item) const;

 private:
  void mark_all(bool is_all);
  void mark(std::span<const glm::vec3> points, float margin_pixels, Marks& marks) const;
  static void add(const std::vector<char>& tiles, Marks& marks);
  void mark_item(const Item& item, const MeshStore& meshes);
  void mark_shadow(const Item& caster, const MeshStore& meshes);
  void mark_occlusion(const Item& item);
  void spread_occlusion(const std::vector<char>& near_marks);
  void find_reach(const MeshStore& meshes);
  std::array<glm::vec3, 2> find_margins(bool is_glass) const;
  void settle(Marks& marks) const;

  TileGrid grid_;
  float occlusion_scale_;
  Marks bodies_, glass_, occluded_, lit_;
  Marks ceased_;                     // where a body that is gone from there may have occluded
  std::vector<float> reach_;         // pixels, by tile: how far what is near there looks for what occludes it
  std::optional<FrameBlock> block_;  // of the last frame
  unsigned pattern_kinds_ = 0;       // of the last frame
};

}  // namespace shatterbox::render::pass
