// Geometry: what each sample sees, packed for the light pass (shaders/surface). Glass has two layers of its
// own: the nearest face and the nearest rim, which shows through faces.
#pragma once
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
  SurfacePass(int width, int height, int samples_across,
              const TileReset& reset);  // a pixel has as many samples down
  // Both draw what touches the tiles that changed, after clearing those; what is drawn beyond them meets
  // itself.
  void run(const MeshStore& meshes, const Tiles& tiles, const Changes& changes) const;
  void run_glass(const MeshStore& meshes, const Tiles& tiles,
                 const Changes& changes);  // makes its layers when first called
  bool has_glass() const { return glass_faces_.seen.name() != 0; }
  const Layer& opaque() const { return opaque_; }
  const Layer& glass_faces() const { return glass_faces_; }
  const Layer& glass_rims() const { return glass_rims_; }

 private:
  int samples_across_;
  Layer opaque_, glass_faces_, glass_rims_;
  gpu::Program program_;
  const TileReset* reset_;  // outlives the pass
};

}  // namespace shatterbox::render::pass
