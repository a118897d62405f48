// Light on what the geometry pass saw, pixel by pixel: bodies, and the floor where they darken it
// (shaders/cover.frag, light.frag, floor.frag). Lit after the fact because small triangles would run the
// costly shader for whole blocks of pixels, many times over.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/surface.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class LightPass {
 public:
  // is_preview: shadow and occlusion are looked up at each second pixel only.
  LightPass(int width, int height, int shadow_taps, int samples_across, int occlusion_scale, bool is_preview);
  void dim(const Layer& opaque, const Tiles& tiles) const;  // before run; nothing unless in preview
  // Into the framebuffer that is bound, which shows the empty floor; its depth is used for the cover.
  void run(const Layer& opaque, const Tiles& tiles, unsigned pattern_kinds);

 private:
  gpu::Texture dimming_;  // preview only
  gpu::Framebuffer dimming_target_;
  gpu::Program dim_, dim_if_dimmed_;
  const gpu::Program& bodies(unsigned pattern_kinds);  // built when first wanted

  std::vector<std::string> defines_;
  std::map<unsigned, gpu::Program> bodies_;  // by pattern kinds
  gpu::Program cover_, floor_, dimmed_;
};

}  // namespace shatterbox::render::pass
