// The floor that fades into the backdrop (shaders/ground).
#pragma once
#include "render/gpu/program.h"

namespace shatterbox::render::pass {

class GroundPass {
 public:
  explicit GroundPass(int shadow_taps);
  void run() const;

 private:
  gpu::Program program_;
};

}  // namespace shatterbox::render::pass
