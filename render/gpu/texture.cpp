#include "render/gpu/texture.h"

#include <glad/gl.h>

namespace shatterbox::render::gpu {

void delete_texture(unsigned name) {
  glDeleteTextures(1, &name);
}

namespace {
unsigned create_texture() {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  return name;
}
}  // namespace

Texture::Texture(int width, int height, unsigned internal_format, Filter filter)
    : handle_(create_texture()), width_(width), height_(height) {
  glTextureStorage2D(name(), 1, internal_format, width, height);
  const GLint sampling = filter == Filter::nearest ? GL_NEAREST : GL_LINEAR;
  glTextureParameteri(name(), GL_TEXTURE_MIN_FILTER, sampling);
  glTextureParameteri(name(), GL_TEXTURE_MAG_FILTER, sampling);
  glTextureParameteri(name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (filter == Filter::compare) {
    glTextureParameteri(name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  }
}

void Texture::bind(unsigned unit) const {
  glBindTextureUnit(unit, name());
}

}  // namespace shatterbox::render::gpu
