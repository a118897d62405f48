// A GL buffer: written once (meshes) or rewritten every frame (uniforms, rows of draws).
#pragma once
#include <cstddef>
#include <span>

#include "render/gpu/handle.h"

namespace shatterbox::render::gpu {

void delete_buffer(unsigned name);

class Buffer {
 public:
  Buffer() = default;  // empty until assigned

  // Never changes afterwards.
  template <typename T>
  static Buffer of(std::span<const T> rows) {
    return Buffer(rows.data(), rows.size_bytes());
  }

  // Replaces the contents; grows as needed, never shrinks. An empty span leaves a buffer of at least 16
  // bytes.
  template <typename T>
  void assign(std::span<const T> rows) {
    assign_bytes(rows.data(), rows.size_bytes());
  }

  void bind_uniform(unsigned binding) const;
  void bind_storage(unsigned binding) const;
  unsigned name() const { return handle_.get(); }

 private:
  Buffer(const void* bytes, std::size_t size);
  void assign_bytes(const void* bytes, std::size_t size);

  Handle<delete_buffer> handle_;
  std::size_t capacity_ = 0;
};

}  // namespace shatterbox::render::gpu
