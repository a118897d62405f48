#include "render/gpu/buffer.h"

#include <glad/gl.h>

#include <algorithm>

namespace shatterbox::render::gpu {

void delete_buffer(unsigned name) {
  glDeleteBuffers(1, &name);
}

namespace {
unsigned create_buffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return name;
}
}  // namespace

Buffer::Buffer(const void* bytes, std::size_t size) : handle_(create_buffer()), capacity_(size) {
  glNamedBufferStorage(name(), static_cast<GLsizeiptr>(std::max<std::size_t>(size, 16)),
                       size == 0 ? nullptr : bytes, 0);
}

void Buffer::assign_bytes(const void* bytes, std::size_t size) {
  if (size > capacity_ || name() == 0) {
    capacity_ = std::max<std::size_t>({size, 16, capacity_ * 2});
    handle_ = Handle<delete_buffer>(create_buffer());
    glNamedBufferStorage(name(), static_cast<GLsizeiptr>(capacity_), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  if (size > 0) glNamedBufferSubData(name(), 0, static_cast<GLsizeiptr>(size), bytes);
}

void Buffer::bind_uniform(unsigned binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, name());
}

void Buffer::bind_storage(unsigned binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name());
}

}  // namespace shatterbox::render::gpu
