// Thin glass over the lit picture: faces and rims at once (shaders/glass_cover.frag, glass.frag).
#pragma once
#include <map>
#include <string>

#include "render/gpu/program.h"
#include "render/pass/surface.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class GlassPass {
 public:
  explicit GlassPass(int samples_across);
  // Into the framebuffer that is bound; its depth is used for the cover.
  void run(const SurfacePass& surface, const Tiles& tiles, unsigned pattern_kinds);

 private:
  struct Programs {
    gpu::Program faces, rims;  // rims: with the faces before and behind them
  };
  const Programs& programs(unsigned pattern_kinds);  // built when first wanted

  std::string side_;
  gpu::Program cover_;
  std::map<unsigned, Programs> programs_;
};

}  // namespace shatterbox::render::pass
