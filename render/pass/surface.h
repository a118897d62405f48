// Geometry: what each sample sees, packed for the light pass (shaders/surface). Glass has layers of its
// own: the nearest faces, those behind them, and the nearest rims, which show through faces.
#pragma once
#include <vector>

#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/mesh_store.h"
#include "render/pass/tile_reset.h"

namespace shatterbox::render::pass {

// One sample's worth of what is seen, and its depth.
struct Layer {
  Layer() = default;
  Layer(int width, int height);
  void bind(unsigned seen_unit, unsigned depth_unit) const;
  gpu::Texture seen, depth;
  gpu::Framebuffer target;
};

class SurfacePass {
 public:
  // A pixel has as many samples down; of glass, so many faces are seen through each other.
  SurfacePass(int width, int height, int samples_across, int glass_faces, const TileReset& reset);
  // Both draw what touches the tiles that changed, after clearing those; what is drawn beyond them meets
  // itself.
  void run(const MeshStore& meshes, const Tiles& tiles, const Changes& changes) const;
  void run_glass(const MeshStore& meshes, const Tiles& tiles,
                 const Changes& changes);  // makes its layers when first called
  bool has_glass() const { return glass_rims_.seen.name() != 0; }
  const Layer& opaque() const { return opaque_; }
  const std::vector<Layer>& glass_faces() const { return glass_faces_; }  // the nearest first
  const Layer& glass_rims() const { return glass_rims_; }

 private:
  int samples_across_;
  Layer opaque_, glass_rims_;
  std::vector<Layer> glass_faces_;
  gpu::Program program_, behind_;  // behind_ is built when glass first comes
  const TileReset* reset_;         // outlives the pass
};

}  // namespace shatterbox::render::pass
