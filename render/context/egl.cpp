// EGL without a surface, on Mesa's software device: asked for by what the device says of itself, so that no
// graphics card is taken where there is one, and no variable of the environment need be set.
#define EGL_NO_X11  // its headers define None, Bool and Status
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "render/context/native_context.h"

namespace shatterbox::render {
namespace {

constexpr const char* kInstall = "; on Debian, libegl1, libegl-mesa0 and libgl1-mesa-dri bring one";

/// The first device that draws on the processor.
EGLDeviceEXT find_software_device() {
  const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto describe =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
  std::array<EGLDeviceEXT, 64> devices{};
  EGLint count = 0;
  if (query != nullptr && describe != nullptr)
    (void)query(static_cast<EGLint>(devices.size()), devices.data(), &count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const char* extensions = describe(devices[i], EGL_EXTENSIONS);
    if (extensions != nullptr &&
        std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos)
      return devices[i];
  }
  throw std::runtime_error(std::string("EGL has no device that draws on the processor") + kInstall);
}

/// One for the whole process. It is never ended: that would end the contexts of other threads too.
EGLDisplay open_display() {
  const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, find_software_device(), nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE)
    throw std::runtime_error(std::string("EGL cannot start its software device") + kInstall);
  return display;
}

class EglContext : public NativeContext {
 public:
  EglContext() : display_(open_display()) {
    eglBindAPI(EGL_OPENGL_API);
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    handle_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (handle_ == EGL_NO_CONTEXT) throw std::runtime_error("EGL gives no OpenGL 4.5 core context");
  }
  ~EglContext() override {
    eglBindAPI(EGL_OPENGL_API);
    if (eglGetCurrentContext() == handle_)
      eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, handle_);
  }

  bool make_current() override {
    eglBindAPI(EGL_OPENGL_API);  // of this thread, and what eglGetCurrentContext tells of
    return eglGetCurrentContext() == handle_ ||
           eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, handle_) == EGL_TRUE;
  }

  Function find_function(const char* name) override { return eglGetProcAddress(name); }

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext handle_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<NativeContext> make_egl_context() {
  return std::make_unique<EglContext>();
}

}  // namespace shatterbox::render
