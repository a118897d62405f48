// Thin glass over the lit picture: faces and rims at once (shaders/glass.frag).
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
  void run(const SurfacePass& surface, const Tiles& tiles, unsigned pattern_kinds);

 private:
  std::string side_;
  std::map<unsigned, gpu::Program> programs_;  // by pattern kinds, built when first wanted
};

}  // namespace shatterbox::render::pass
