// OSMesa: a library that draws into memory. Its own buffer is one pixel that nobody looks at.
#include <glad/gl.h>
// After glad: OSMesa's header would otherwise bring in its own gl.h.
#include <GL/osmesa.h>

#include <stdexcept>

#include "render/context/native_context.h"

namespace shatterbox::render {
namespace {

class OsmesaContext : public NativeContext {
 public:
  OsmesaContext() {
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
  }
  ~OsmesaContext() override { OSMesaDestroyContext(handle_); }

  bool make_current() override {
    return OSMesaGetCurrentContext() == handle_ ||
           OSMesaMakeCurrent(handle_, dummy_, GL_UNSIGNED_BYTE, 1, 1) == GL_TRUE;
  }

  Function find_function(const char* name) override { return OSMesaGetProcAddress(name); }

 private:
  ::OSMesaContext handle_ = nullptr;
  unsigned char dummy_[4] = {};  // must outlive the context
};

}  // namespace

std::unique_ptr<NativeContext> make_osmesa_context() {
  return std::make_unique<OsmesaContext>();
}

}  // namespace shatterbox::render
