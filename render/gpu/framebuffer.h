// A set of textures, or of multisampled render buffers, that a pass draws to.
#pragma once
#include <vector>

#include "render/gpu/handle.h"
#include "render/gpu/texture.h"

namespace shatterbox::render::gpu {

void delete_framebuffer(unsigned name);
void delete_renderbuffer(unsigned name);

class Framebuffer {
 public:
  Framebuffer() = default;
  // Draws to textures owned by the caller; `depth` may be null. All of one size.
  Framebuffer(const std::vector<const Texture*>& colours, const Texture* depth);
  // Draws to the colours that another owns, and to a depth texture of the caller's.
  Framebuffer(const Framebuffer& picture, const Texture& depth);
  // Owns a colour and a depth buffer; samples 1 or 4 (llvmpipe knows no other count).
  Framebuffer(int width, int height, int samples, unsigned colour_format, unsigned depth_format);

  void bind() const;  // and sets the viewport
  unsigned name() const { return handle_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void check() const;  // throws std::runtime_error when GL calls it incomplete

  Handle<delete_framebuffer> handle_;
  Handle<delete_renderbuffer> colour_, depth_;
  int width_ = 0, height_ = 0;
};

}  // namespace shatterbox::render::gpu
