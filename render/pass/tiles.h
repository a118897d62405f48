// Which parts of the picture show bodies or darkened floor: squares that a body's box, its shadow
// or its occlusion may touch, found on the CPU so that the costly shaders run only there; and where the empty
// floor is even.
#pragma once
#include <optional>
#include <vector>

#include "render/gpu/buffer.h"
#include "render/pass/frame_block.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

// The uniforms' places in tile.vert.
inline constexpr int kTileDepth = 1, kLeastNeed = 2, kMostNeed = 3;

class Tiles {
 public:
  Tiles(int width, int height);
  void find(const MeshStore& meshes, const FrameBlock& block);  // uploads and binds them

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

 private:
  using Marks = std::vector<char>;  // one a tile
  struct Corners {
    glm::vec3 at[8];  // world
  };
  void mark(const Corners& corners, const FrameBlock& block, float margin_pixels, char kind,
            Marks& marks) const;
  static std::optional<Corners> find_occluded_floor(const Corners& body, const FrameBlock& block);
  void mark_bodies(const MeshStore& meshes, const FrameBlock& block);
  void mark_ground(const FrameBlock& block);
  template <typename IsWanted>
  Range append_runs(IsWanted is_wanted, int longest);

  int width_, height_, across_, down_;
  Marks marks_, near_marks_, glass_marks_, ground_marks_, corner_marks_;  // the last: one a corner of tiles
  std::vector<glm::uvec4> rectangles_;
  gpu::Buffer buffer_;
  Range bodies_, glass_, shaded_, occluded_, near_bodies_;
  Floor behind_bodies_, open_floor_;
};

}  // namespace shatterbox::render::pass
