// Thin glass over the lit picture: faces and rims at once (shaders/glass.frag).
#pragma once
#include "render/gpu/program.h"
#include "render/pass/surface.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class GlassPass {
 public:
  explicit GlassPass(int samples_across);
  void run(const SurfacePass& surface, const Tiles& tiles, bool has_patterns) const;

 private:
  gpu::Program plain_, patterned_;
};

}  // namespace shatterbox::render::pass
