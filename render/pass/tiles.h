// Which parts of the picture show bodies or darkened floor: squares that a body's box, its shadow
// or its occlusion may touch, found on the CPU so that the costly shaders run only there; and where the empty
// floor is even.
#pragma once
#include <span>
#include <vector>

#include "render/gpu/buffer.h"
#include "render/pass/changes.h"
#include "render/pass/frame_block.h"
#include "render/pass/mesh_store.h"
#include "render/pass/tile_grid.h"

namespace shatterbox::render::pass {

// The uniforms' places in tile.vert.
inline constexpr int kTileDepth = 1, kLeastNeed = 2, kMostNeed = 3;

class Tiles {
 public:
  Tiles(int width, int height);
  void find(const MeshStore& meshes, const FrameBlock& block);
  // Uploads and binds those that are to be drawn anew.
  void select(const Changes& changes);

  // One a tile: not 0 where occlusion is looked for; where floor is drawn otherwise than before the last
  // find, or between pixels that are.
  const std::vector<char>& near_marks() const { return near_marks_; }
  const std::vector<char>& changed_marks() const { return changed_marks_; }

  struct Range {
    int first = 0, count = 0;
  };
  // Draws each rectangle once with the program in use (tile.vert).
  static void draw(Range range);

  Range bodies() const { return bodies_; }
  Range glass() const { return glass_; }
  // Floor, where it is not faded away, by what may darken it: shadows and occlusion, or occlusion alone.
  Range shaded() const { return shaded_; }
  Range occluded() const { return occluded_; }  // squares
  // Where bodies are, and what floor is so near that they occlude it.
  Range near_bodies() const { return near_bodies_; }
  // Shaded and occluded floor together in squares, behind bodies or not, even or not.
  struct Floor {
    Range smooth, uneven;
  };
  const Floor& floor_behind_bodies() const { return behind_bodies_; }
  const Floor& open_floor() const { return open_floor_; }
  // What is to be drawn anew, by what: empty where that is all (Changes::Marks).
  Range changed_bodies() const { return changed_bodies_; }
  Range changed_glass() const { return changed_glass_; }
  Range changed_occlusion() const { return changed_occlusion_; }
  Range changed_light() const { return changed_light_; }
  // Left, bottom, right, top in pixels, of each rectangle of a range.
  std::span<const glm::uvec4> rectangles(Range range) const;

 private:
  using Marks = std::vector<char>;  // one a tile
  void mark(const Corners& corners, const FrameBlock& block, float margin_pixels, char kind,
            Marks& marks) const;
  void mark_bodies(const MeshStore& meshes, const FrameBlock& block);
  void mark_ground(const FrameBlock& block);
  void mark_changes();
  template <typename IsWanted>
  Range append_runs(IsWanted is_wanted, int longest);

  int width_, height_;
  TileGrid grid_;
  Marks marks_, earlier_marks_, changed_marks_, near_marks_, glass_marks_, ground_marks_,
      corner_marks_;  // the last: one a corner of tiles
  std::vector<glm::uvec4> rectangles_;
  gpu::Buffer buffer_;
  Range bodies_, glass_, shaded_, occluded_, near_bodies_;
  Range changed_bodies_, changed_glass_, changed_occlusion_, changed_light_;
  Floor behind_bodies_, open_floor_;
};

}  // namespace shatterbox::render::pass
