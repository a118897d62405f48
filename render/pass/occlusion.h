// Ambient occlusion at half size: depth, spiral samples, blur (shaders/occlusion*).
#pragma once
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/pass/mesh_store.h"

namespace shatterbox::render::pass {

class OcclusionPass {
 public:
  OcclusionPass(int width, int height, int taps);  // of the full-size picture
  void run(const MeshStore& meshes, bool has_ground) const;
  void bind() const;  // texture unit 3

 private:
  gpu::Texture depth_, raw_, blurred_;
  gpu::Framebuffer depth_target_, raw_target_, blurred_target_;
  gpu::Program depth_program_, ground_program_, sample_, blur_;
};

}  // namespace shatterbox::render::pass
