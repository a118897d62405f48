// Thin glass over the lit picture: the faces behind others, rims, then the nearest faces, through which all
// that shows (shaders/glass_cover.frag, glass.frag).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/pass/surface.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class GlassPass {
 public:
  GlassPass(int samples_across, int shadow_taps);
  // What is cloudy takes shadows: they must be bound. drawn: the lit picture; with several samples a pixel
  // its depth is used for the cover.
  void run(const SurfacePass& surface, const gpu::Framebuffer& drawn, const Tiles& tiles,
           unsigned pattern_kinds);

 private:
  void find_cover(const SurfacePass& surface, const gpu::Framebuffer& drawn, const Tiles& tiles);
  const gpu::Program& faces(unsigned pattern_kinds);  // built when first wanted

  int samples_across_;
  std::string side_;
  std::vector<std::string> defines_;  // of faces
  gpu::Program cover_, rims_;
  std::map<unsigned, gpu::Program> faces_;
  std::vector<gpu::Framebuffer> on_faces_;  // the picture with a layer's depth; for one sample a pixel
  gpu::Framebuffer on_rims_;                // the same
};

}  // namespace shatterbox::render::pass
