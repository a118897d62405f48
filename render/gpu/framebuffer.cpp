#include "render/gpu/framebuffer.h"

#include <glad/gl.h>

#include <stdexcept>
#include <string>

namespace shatterbox::render::gpu {

void delete_framebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}
void delete_renderbuffer(unsigned name) {
  glDeleteRenderbuffers(1, &name);
}

namespace {

unsigned create_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return name;
}

unsigned create_renderbuffer(int width, int height, int samples, unsigned format) {
  GLuint name = 0;
  glCreateRenderbuffers(1, &name);
  glNamedRenderbufferStorageMultisample(name, samples > 1 ? samples : 0, format, width, height);
  return name;
}

}  // namespace

Framebuffer::Framebuffer(const std::vector<const Texture*>& colours, const Texture* depth)
    : handle_(create_framebuffer()) {
  std::vector<GLenum> targets;
  for (const Texture* colour : colours) {
    targets.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size()));
    glNamedFramebufferTexture(name(), targets.back(), colour->name(), 0);
  }
  if (depth != nullptr) glNamedFramebufferTexture(name(), GL_DEPTH_ATTACHMENT, depth->name(), 0);
  glNamedFramebufferDrawBuffers(name(), static_cast<GLsizei>(targets.size()), targets.data());
  const Texture& any = colours.empty() ? *depth : *colours.front();
  width_ = any.width();
  height_ = any.height();
  check();
}

Framebuffer::Framebuffer(const Framebuffer& picture, const Texture& depth)
    : handle_(create_framebuffer()), width_(picture.width_), height_(picture.height_) {
  glNamedFramebufferRenderbuffer(name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, picture.colour_.get());
  glNamedFramebufferTexture(name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
  check();
}

Framebuffer::Framebuffer(int width, int height, int samples, unsigned colour_format, unsigned depth_format)
    : handle_(create_framebuffer()),
      colour_(create_renderbuffer(width, height, samples, colour_format)),
      width_(width),
      height_(height) {
  glNamedFramebufferRenderbuffer(name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.get());
  if (depth_format != 0) {
    depth_ = Handle<delete_renderbuffer>(create_renderbuffer(width, height, samples, depth_format));
    glNamedFramebufferRenderbuffer(name(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.get());
  }
  check();
}

void Framebuffer::check() const {
  const GLenum answer = glCheckNamedFramebufferStatus(name(), GL_FRAMEBUFFER);
  if (answer != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("incomplete framebuffer of " + std::to_string(width_) + " x " +
                             std::to_string(height_) + ": " + std::to_string(answer));
  }
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, name());
  glViewport(0, 0, width_, height_);
}

}  // namespace shatterbox::render::gpu
