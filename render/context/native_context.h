// A context as its library makes it: what differs between the back-ends, and nothing else.
#pragma once
#include <memory>

namespace shatterbox::render {

class NativeContext {
 public:
  using Function = void (*)();

  NativeContext() = default;
  virtual ~NativeContext() = default;
  NativeContext(const NativeContext&) = delete;
  NativeContext& operator=(const NativeContext&) = delete;

  virtual bool make_current() = 0;                       // in this thread; false if it cannot be
  virtual Function find_function(const char* name) = 0;  // while it is current; null if there is none
};

// 4.5 core, current afterwards; throw std::runtime_error with the reason. Each is there if it was built.
std::unique_ptr<NativeContext> make_osmesa_context();
std::unique_ptr<NativeContext> make_egl_context();

}  // namespace shatterbox::render
