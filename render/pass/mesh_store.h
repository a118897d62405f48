// The meshes on the GPU, by id, and the rows that the shaders read of this frame's draws, paints and scalars;
// and which draws are as they were in the last frame.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "render/frame/expand.h"
#include "render/frame/frame.h"
#include "render/gpu/buffer.h"
#include "render/gpu/handle.h"
#include "render/pass/paint_table.h"
#include "render/pass/tile_grid.h"

namespace shatterbox::render::pass {

void delete_vertex_array(unsigned name);

// A mesh on the GPU, as given or simplified.
struct StoredMesh {
  std::uint64_t id = 0;  // no other ever has it
  gpu::Buffer vertices, indices;
  DrawnMesh shape;  // ranges and bounds; its arrays are on the GPU only
};

// One draw of the frame, ready for the passes.
struct Item {
  const StoredMesh* stored = nullptr;  // never null; the same for as long as it is drawn
  std::uint64_t mesh_id = 0, stored_id = 0;
  int row = 0;  // of the draw rows
  std::uint32_t id = 0;
  PaintTable::Rows paints;
  std::shared_ptr<const std::vector<float>> scalars;  // null if none are shown
  glm::mat4 world_from_body{1.0F};
  Corners box_world{};
  glm::vec3 centre_world{0.0F};
  float radius = 0.0F;        // m, world
  float eye_distance = 0.0F;  // m, to the centre
  float rim_pixels = 0.0F;    // a shell's thickness where it is
  bool is_glass = false, is_cloudy = false, is_on_screen = false, casts_shadow = false;
  bool is_as_before = false;  // under the same camera it gives the samples and the shadow that it gave
};

enum class Part { all, outer, rims, rim_lines };  // rims: with their lines

class MeshStore {
 public:
  MeshStore();

  // Uploads meshes not seen before, drops those not in the frame, writes the rows and binds them.
  // Throws std::invalid_argument (see expand) and then keeps what it had.
  // pixel_slope: a pixel's height at one metre's distance, m.
  void prepare(const Frame& frame, const glm::mat4& clip_from_world, float pixel_slope);

  void forget();  // nothing is as before in the next frame

  const std::vector<Item>& items() const { return items_; }  // near to far
  // What the last frame drew and this one does not, or draws otherwise; their meshes may be gone.
  const std::vector<Item>& gone() const { return gone_; }
  void bind_vertices() const;
  void bind_paints() const { paints_.bind(); }
  void draw(const Item& item, Part part) const;
  // What draws in the shadow map: solids wholly, shells by one face.
  Part shadow_part(const Item& item) const;
  unsigned pattern_kinds() const { return paints_.pattern_kinds(); }
  int mesh_count() const { return static_cast<int>(meshes_.size()); }

 private:
  // Levels: simplified within 2^(level / 2) metres; kAsGiven is the mesh itself.
  static constexpr int kAsGiven = -1000;
  struct Levels {
    std::map<int, StoredMesh> meshes;
    glm::vec3 centre{0.0F};  // of the mesh's box; body space
    float radius = 0.0F;
    std::uint64_t last_frame = 0;
  };
  Levels& find_or_measure(const Mesh& mesh);
  // Of each draw, the levels of its mesh and which of them is drawn.
  struct Choice {
    Levels* levels = nullptr;
    int level = kAsGiven;
  };
  Choice choose(const Draw& draw, const Frame& frame, float pixel_slope);
  void make_missing(const Frame& frame, const std::vector<Choice>& choices);
  void drop_unseen();
  Item make_item(const Draw& draw, const Frame& frame, const StoredMesh& stored, float pixel_slope);
  void compare_with_earlier(std::vector<Item>& items, const Frame& frame);
  void upload_rows(const std::vector<Item>& items);

  std::map<std::uint64_t, Levels> meshes_;
  std::vector<Item> items_, earlier_, gone_;  // earlier: of the last frame, in its draws' order
  gpu::Buffer draw_rows_, rows_, scalars_;    // rows: 0, 1, 2, ..
  PaintTable paints_;
  gpu::Handle<delete_vertex_array> vertex_array_;
  std::uint64_t frame_ = 0, next_id_ = 1;
};

}  // namespace shatterbox::render::pass
