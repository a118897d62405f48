#include "render/context/context.h"

#include <glad/gl.h>
// After glad: OSMesa's header would otherwise bring in its own gl.h.
#include <GL/osmesa.h>

#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string_view>

namespace shatterbox::render {
namespace {

// Mesa dies in context creation with a driver it does not have, and 4.5 needs llvmpipe.
void check_driver_wish() {
  const char* wish = std::getenv("GALLIUM_DRIVER");
  if (wish != nullptr && std::string_view(wish) != "" && std::string_view(wish) != "llvmpipe") {
    throw std::runtime_error(std::string("GALLIUM_DRIVER is set to '") + wish +
                             "'; pictures need llvmpipe: unset it");
  }
}

GLADapiproc load_function(const char* name) {
  return reinterpret_cast<GLADapiproc>(OSMesaGetProcAddress(name));
}

// The loader's pointers are the same for every OSMesa context of the process.
void load_gl_once() {
  static std::once_flag once;
  static int version = 0;
  std::call_once(once, [] { version = gladLoadGL(load_function); });
  if (version < GLAD_MAKE_VERSION(4, 5)) throw std::runtime_error("OSMesa offers no OpenGL 4.5");
}

}  // namespace

Context::Context() {
  check_driver_wish();
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_STENCIL_BITS,
                            0,
                            OSMESA_ACCUM_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  handle_ = OSMesaCreateContextAttribs(attributes, nullptr);
  if (handle_ == nullptr) throw std::runtime_error("OSMesa gives no OpenGL 4.5 core context");
  try {
    make_current();
    load_gl_once();
  } catch (...) {
    OSMesaDestroyContext(handle_);
    throw;
  }
  gl_renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

Context::~Context() {
  OSMesaDestroyContext(handle_);
}

void Context::make_current() const {
  if (OSMesaGetCurrentContext() == handle_) return;
  if (!OSMesaMakeCurrent(handle_, dummy_, GL_UNSIGNED_BYTE, 1, 1)) {
    throw std::runtime_error("the OpenGL context cannot be made current");
  }
}

}  // namespace shatterbox::render
