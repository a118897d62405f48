// A two-dimensional texture of one level, drawn to by a pass and read by a later one.
#pragma once
#include "render/gpu/handle.h"

namespace shatterbox::render::gpu {

void delete_texture(unsigned name);

enum class Filter {
  nearest,  // texelFetch: the same on every CPU
  linear,
  compare,  // depth compared in the sampler, four neighbours blended: sampler2DShadow
};

class Texture {
 public:
  Texture() = default;
  Texture(int width, int height, unsigned internal_format, Filter filter);
  void bind(unsigned unit) const;
  unsigned name() const { return handle_.get(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Handle<delete_texture> handle_;
  int width_ = 0, height_ = 0;
};

}  // namespace shatterbox::render::gpu
