#include "render/context/context.h"

#include <glad/gl.h>

#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string_view>

namespace shatterbox::render {
namespace {

#ifdef SHATTERBOX_HAS_OSMESA
constexpr bool kHasOsmesa = true;
#else
constexpr bool kHasOsmesa = false;
#endif
#ifdef SHATTERBOX_HAS_EGL
constexpr bool kHasEgl = true;
#else
constexpr bool kHasEgl = false;
#endif

// What was not built is not called.
std::unique_ptr<NativeContext> make_native(BackEnd back_end) {
  if constexpr (kHasOsmesa)
    if (back_end == BackEnd::osmesa) return make_osmesa_context();
  if constexpr (kHasEgl)
    if (back_end == BackEnd::egl) return make_egl_context();
  throw std::runtime_error(back_end_fault(back_end));
}

// Mesa dies in context creation with a driver it does not have, and 4.5 needs llvmpipe.
void check_driver_wish() {
  const char* wish = std::getenv("GALLIUM_DRIVER");
  if (wish != nullptr && std::string_view(wish) != "" && std::string_view(wish) != "llvmpipe") {
    throw std::runtime_error(std::string("GALLIUM_DRIVER is set to '") + wish +
                             "'; pictures need llvmpipe: unset it");
  }
}

// The loader's pointers are those of one back-end, the same for all its contexts in the process.
void load_gl_once(NativeContext& native, BackEnd back_end) {
  static std::once_flag once;
  static int version = 0;
  static BackEnd loaded = BackEnd::usual;
  std::call_once(once, [&native, back_end] {
    const auto find = [](void* from, const char* name) {
      return static_cast<NativeContext*>(from)->find_function(name);
    };
    version = gladLoadGLUserPtr(find, &native);
    loaded = back_end;
  });
  if (loaded != back_end)
    throw std::runtime_error("this process draws with its other OpenGL back-end already");
  if (version < GLAD_MAKE_VERSION(4, 5)) throw std::runtime_error("there is no OpenGL 4.5");
}

}  // namespace

std::string back_end_fault(BackEnd back_end) {
  if (back_end == BackEnd::osmesa && !kHasOsmesa)
    return "this program was built without OSMesa: install libosmesa6-dev and build it again";
  if (back_end == BackEnd::egl && !kHasEgl)
    return "this program was built without EGL: install libegl-dev and libgl1-mesa-dri, and build it again";
  return {};
}

Context::Context(BackEnd back_end) {
  check_driver_wish();
  if (back_end == BackEnd::usual) back_end = kHasOsmesa ? BackEnd::osmesa : BackEnd::egl;
  native_ = make_native(back_end);
  make_current();
  load_gl_once(*native_, back_end);
  gl_renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  gl_renderer_ += back_end == BackEnd::osmesa ? ", OSMesa" : ", EGL";
}

void Context::make_current() const {
  if (!native_->make_current()) throw std::runtime_error("the OpenGL context cannot be made current");
}

}  // namespace shatterbox::render
