#include "render/pass/backdrop.h"

#include <glad/gl.h>

namespace shatterbox::render::pass {

BackdropPass::BackdropPass() : program_("full_screen.vert", "backdrop.frag") {}

void BackdropPass::run() const {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);  // it lies at the far end, where the depth buffer was cleared
  glDepthMask(GL_FALSE);
  program_.use();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

}  // namespace shatterbox::render::pass
