#include "render/pass/ground.h"

#include <glad/gl.h>

#include <string>

namespace shatterbox::render::pass {

GroundPass::GroundPass(int shadow_taps)
    : program_("ground.vert", "ground.frag", {"SHADOW_TAPS " + std::to_string(shadow_taps)}) {}

void GroundPass::run() const {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_CULL_FACE);
  program_.use();
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace shatterbox::render::pass
