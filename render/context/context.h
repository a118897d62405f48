// The GL context: 4.5 core, on the processor; everything is drawn to framebuffer objects of our own.
#pragma once
#include <memory>
#include <string>

#include "render/context/back_end.h"
#include "render/context/native_context.h"

namespace shatterbox::render {

class Context {
 public:
  // Current afterwards. Throws std::runtime_error with the reason; one is that a process draws with one
  // back-end from its first context on.
  explicit Context(BackEnd back_end);

  void make_current() const;
  const std::string& gl_renderer() const { return gl_renderer_; }  // and by which back-end

 private:
  std::unique_ptr<NativeContext> native_;
  std::string gl_renderer_;
};

}  // namespace shatterbox::render
