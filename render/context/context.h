// The GL context: OSMesa, 4.5 core, on a dummy one-pixel buffer; everything is drawn to framebuffer objects
// of our own.
#pragma once
#include <string>

struct osmesa_context;  // OSMesaContext, without its header

namespace shatterbox::render {

class Context {
 public:
  Context();  // throws std::runtime_error with the reason; current afterwards
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  void make_current() const;
  const std::string& gl_renderer() const { return gl_renderer_; }

 private:
  ::osmesa_context* handle_ = nullptr;
  mutable unsigned char dummy_[4] = {};  // must outlive the context
  std::string gl_renderer_;
};

}  // namespace shatterbox::render
