// What is behind everything (shaders/backdrop.frag).
#pragma once
#include "render/gpu/program.h"

namespace shatterbox::render::pass {

class BackdropPass {
 public:
  BackdropPass();
  void run() const;

 private:
  gpu::Program program_;
};

}  // namespace shatterbox::render::pass
