// The door of render: Frame in, Image out. Off-screen, on the CPU (llvmpipe, by OSMesa or EGL).
// One renderer belongs to the thread that made it; the same frame gives the same bytes. What has not changed
// since the last frame is not drawn again: that picture is kept.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "render/context/back_end.h"
#include "render/frame/frame.h"
#include "render/frame/truth.h"
#include "render/output/image.h"

namespace shatterbox::render {

enum class Quality {
  preview,  // one sample a pixel, small shadow map
  full,     // four samples a pixel, soft shadows that harden at contact, finer occlusion
};

struct Size {
  int width = 640, height = 360;
};

// What each pass that the last frame had cost; only filled while timing is on (it waits after every pass).
struct PassTimes {
  struct Pass {
    std::string name;
    double cpu_ms = 0;  // all threads of the process
    double wall_ms = 0;
  };
  std::vector<Pass> passes;
};

class Renderer {
 public:
  // Throws std::runtime_error in words when no GL 4.5 context can be had or the size is not in 1..8192.
  // All renderers of a process have one back-end.
  Renderer(Size size, Quality quality, BackEnd back_end = BackEnd::usual);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  // RGB8, row 0 on top. Throws std::invalid_argument for a null mesh or an index out of range.
  Image render(const Frame& frame);

  // The numbers of the picture that was rendered last.
  Truth find_truth();

  void forget();               // the next frame is drawn wholly, as by a renderer that has drawn none
  double drawn_share() const;  // of the last picture: 0 if all of it was kept, 1 if none

  Size size() const;
  Quality quality() const;
  const std::string& gl_renderer() const;  // for the report: "llvmpipe (LLVM 15.0.6, 256 bits), OSMesa"
  bool is_llvmpipe() const;                // pictures are only comparable if so
  int mesh_count() const;                  // meshes on the GPU now
  bool has_shadow_maps() const;            // they are made when something first casts a shadow
  double shadow_bytes() const;             // of those maps; 0 without

  void set_timing(bool on);
  const PassTimes& pass_times() const;

 private:
  struct Rooms;
  std::unique_ptr<Rooms> rooms_;
};

}  // namespace shatterbox::render
