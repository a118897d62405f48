// Ambient occlusion of bodies and floor on a smaller picture, where bodies are near
// (shaders/occlusion.frag).
#pragma once
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/surface.h"
#include "render/pass/tile_reset.h"
#include "render/pass/tiles.h"

namespace shatterbox::render::pass {

class OcclusionPass {
 public:
  // scale: pixels of the picture to one of its own, across and down.
  OcclusionPass(int width, int height, int taps, int samples_across, int scale, const TileReset& reset);
  // Block and tiles must be bound.
  void run(const Layer& opaque, const Tiles& tiles, const Changes::Marks& changed) const;
  void bind() const;  // binds the shares for the light pass, and their least by tile

 private:
  gpu::Texture raw_, blurred_, tiles_;
  gpu::Framebuffer raw_target_, blurred_target_, tiles_target_;
  gpu::Program sample_, blur_, reduce_;
  const TileReset* reset_;  // outlives the pass
};

}  // namespace shatterbox::render::pass
