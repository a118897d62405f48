// Ambient occlusion at a half or a quarter of the size: depth of bodies and floor, spiral samples, blur
// (shaders/occlusion*).
#pragma once
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"

namespace shatterbox::render::pass {

class OcclusionPass {
 public:
  OcclusionPass(int width, int height, int taps, int samples_across, int scale);  // of the whole picture
  void run(const gpu::Texture& opaque_depth) const;
  void bind() const;  // texture units 3 and 9

 private:
  gpu::Texture depth_, raw_, blurred_, tiles_;
  gpu::Framebuffer depth_target_, raw_target_, blurred_target_, tiles_target_;
  gpu::Program gather_, sample_, blur_, reduce_;
};

}  // namespace shatterbox::render::pass
