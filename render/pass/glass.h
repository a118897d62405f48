// Thin glass over the lit picture, the far layer first (shaders/glass.frag).
#pragma once
#include "render/gpu/program.h"
#include "render/pass/surface.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class GlassPass {
 public:
  explicit GlassPass(int samples_across);
  void run(const SurfacePass& surface, const Tiles& tiles) const;

 private:
  gpu::Program near_, far_;
};

}  // namespace shatterbox::render::pass
