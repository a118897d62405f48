// Which parts of the picture show bodies or darkened floor: squares that a body's box, its shadow
// or its occlusion may touch, found on the CPU so that the costly shaders run only there.
#pragma once
#include <vector>

#include "render/gpu/buffer.h"
#include "render/pass/frame_block.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

class Tiles {
 public:
  Tiles(int width, int height);
  void find(const MeshStore& meshes, const FrameBlock& block);  // uploads and binds them

  // Draws each rectangle once with the program in use (tile.vert).
  void draw_bodies() const { draw(bodies_); }
  void draw_shaded_floor() const { draw(shaded_); }
  void draw_dimmed_floor() const { draw(dimmed_); }  // occlusion, no shadow; squares one by one
  void draw_glass() const { draw(glass_); }
  bool has_glass() const { return glass_.count > 0; }

 private:
  struct Range {
    int first = 0, count = 0;
  };
  using Marks = std::vector<char>;  // one a tile
  struct Corners {
    glm::vec3 at[8];  // world
  };
  void mark(const Corners& corners, const FrameBlock& block, float margin_pixels, char kind,
            Marks& marks) const;
  Range append_runs(const Marks& marks, char wanted, int longest);
  static void draw(Range range);

  int width_, height_, across_, down_;
  Marks marks_, glass_marks_;
  std::vector<glm::uvec4> rectangles_;
  gpu::Buffer buffer_;
  Range bodies_, shaded_, dimmed_, glass_;
};

}  // namespace shatterbox::render::pass
