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
#include "render/pass/tile_reset.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class LightPass {
 public:
  LightPass(int width, int height, int shadow_taps, int samples_across, int occlusion_scale,
            const TileReset& reset);
  // What the floor sees of sun and sky, at each second pixel; shadow and occlusion must be bound.
  void dim(const Tiles& tiles, const Changes::Marks& changed) const;
  // Into `drawn`, which shows the empty floor; with several samples a pixel its depth is used for the cover.
  // `opaque` must be bound.
  void run(const Layer& opaque, const gpu::Framebuffer& drawn, const Tiles& tiles, unsigned pattern_kinds,
           bool is_patterned);

 private:
  struct FloorPrograms {
    gpu::Program smooth, fading, patterned;  // by the ground: common/floor.glsl
  };
  const gpu::Program& bodies(unsigned pattern_kinds);  // built when first wanted
  void draw_floor(const FloorPrograms& programs, const Tiles::Floor& floor, int least_need,
                  int most_need) const;
  void draw_samples(const Tiles& tiles, const gpu::Program& light) const;

  int samples_across_;
  bool is_patterned_ = false;  // the ground
  std::vector<std::string> defines_;
  gpu::Texture dimming_, need_;  // of each second pixel; of each tile
  gpu::Framebuffer dimming_target_, need_target_;
  gpu::Framebuffer on_opaque_;  // the picture with the bodies' depth; for one sample a pixel
  gpu::Program dim_, dim_occluded_, reduce_, cover_;
  const TileReset* reset_;                   // outlives the pass
  FloorPrograms between_, at_pixels_;        // the second in full quality only
  std::map<unsigned, gpu::Program> bodies_;  // by pattern kinds
};

}  // namespace shatterbox::render::pass
