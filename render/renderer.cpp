#include "render/renderer.h"

#include <glad/gl.h>

#include <chrono>
#include <cstring>
#include <ctime>
#include <span>
#include <stdexcept>

#include "render/context/context.h"
#include "render/gpu/buffer.h"
#include "render/gpu/framebuffer.h"
#include "render/pass/changes.h"
#include "render/pass/floor.h"
#include "render/pass/frame_block.h"
#include "render/pass/glass.h"
#include "render/pass/light.h"
#include "render/pass/mesh_store.h"
#include "render/pass/occlusion.h"
#include "render/pass/overlay.h"
#include "render/pass/shadow.h"
#include "render/pass/surface.h"
#include "render/pass/tile_reset.h"
#include "render/pass/tiles.h"
#include "render/pass/truth.h"
#include "render/pass/wires.h"

namespace shatterbox::render {
namespace {

// Times what happened since the last mark, after waiting for it; nothing at all while off.
class PassClock {
 public:
  PassClock(bool is_on, PassTimes& times) : is_on_(is_on), times_(times) {
    if (is_on_) {
      times_.passes.clear();
      start();
    }
  }
  void mark(const char* name) {
    if (!is_on_) return;
    glFinish();
    const double cpu = cpu_ms() - cpu_;
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - wall_;
    times_.passes.push_back({name, cpu, wall.count()});
    start();
  }

 private:
  static double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
  }
  void start() {
    cpu_ = cpu_ms();
    wall_ = std::chrono::steady_clock::now();
  }
  bool is_on_;
  PassTimes& times_;
  double cpu_ = 0;
  std::chrono::steady_clock::time_point wall_;
};

void check_size(Size size) {
  if (size.width < 1 || size.height < 1 || size.width > 8192 || size.height > 8192) {
    throw std::runtime_error("a picture of " + std::to_string(size.width) + " x " +
                             std::to_string(size.height) + " pixels is not possible");
  }
}

}  // namespace

// Members are made in this order and gone in the reverse: the context outlives all that lives in it.
struct Renderer::Rooms {
  struct Level {
    int samples_across;  // a pixel has as many down
    int shadow_map, shadow_taps;
    int occlusion_taps, occlusion_scale;
    int glass_faces;  // seen through each other
  };
  static Level level_of(Quality quality) {
    return quality == Quality::full ? Level{2, 1536, 14, 6, 2, 3} : Level{1, 1024, 5, 6, 3, 2};
  }

  Size size;
  Quality quality;
  Level level;
  Context context;
  gpu::Framebuffer drawn;  // sRGB, read back
  pass::FrameBlock values{};
  gpu::Buffer block;  // of the values
  pass::MeshStore meshes;
  pass::Tiles tiles;
  pass::Changes changes;
  pass::TileReset reset;
  pass::FloorPass floor;
  pass::ShadowPass shadow;
  pass::SurfacePass surface;
  pass::OcclusionPass occlusion;
  pass::LightPass light;
  pass::GlassPass glass;
  pass::WiresPass wires;
  pass::TruthPass truth;
  std::uint32_t ground_id = 0;     // of the last frame
  std::vector<std::uint8_t> rgba;  // as read back; kept, since new pages cost more than the reading
  Image kept;                      // the last picture, without what is written on it
  bool is_kept = false;            // that, and all that the passes keep, is whole
  PassTimes times;
  bool is_timed = false;

  Rooms(Size size_, Quality quality_, BackEnd back_end)
      : size(size_),
        quality(quality_),
        level(level_of(quality_)),
        context(back_end),
        drawn(size.width, size.height, 1, GL_SRGB8_ALPHA8, GL_DEPTH_COMPONENT32F),
        tiles(size.width, size.height),
        changes(size.width, size.height, level.occlusion_scale),
        floor(size.width, size.height),
        shadow(level.shadow_map),
        surface(size.width, size.height, level.samples_across, level.glass_faces, reset),
        occlusion(size.width, size.height, level.occlusion_taps, level.samples_across, level.occlusion_scale,
                  reset),
        light(size.width, size.height, level.shadow_taps, level.samples_across, level.occlusion_scale, reset),
        glass(level.samples_across, level.shadow_taps),
        wires(level.samples_across) {
    glDisable(GL_DITHER);
    glDepthRange(0.0, 1.0);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
  }
  ~Rooms() { context.make_current(); }

  // What the frame is, and what of the last picture still holds.
  void prepare(const Frame& frame) {
    if (!is_kept) {
      meshes.forget();
      shadow.forget();
      changes.forget();
    }
    is_kept = false;
    values = pass::make_frame_block(frame, size.width, size.height);
    meshes.prepare(frame, values.clip_from_world, 2.0F * values.view_ray.y / static_cast<float>(size.height));
    shadow.fit(frame, meshes, values);
    tiles.find(meshes, values);
    changes.find(meshes, values, tiles.near_marks(), tiles.changed_marks());
  }

  void lay_floor() {
    tiles.select(changes);
    block.assign(std::span<const pass::FrameBlock>(&values, 1));
    block.bind_uniform(0);
    meshes.bind_vertices();  // core GL draws nothing without an array, even where none is read
    floor.run(values, drawn, changes.lit().is_all, tiles.rectangles(tiles.changed_light()));
  }

  void draw(PassClock& clock, bool has_wires) {
    if (values.sun_radiance.w > 0.0F) {
      shadow.run(meshes, values);
      clock.mark("shadow");
    }
    if (!changes.bodies().is_none()) surface.run(meshes, tiles, changes);
    const bool has_glass = tiles.glass().count > 0;
    // Its layers are right all over once there are any.
    if ((has_glass || surface.has_glass()) && !changes.glass().is_none())
      surface.run_glass(meshes, tiles, changes);
    clock.mark("surface");
    if (!changes.occluded().is_none()) occlusion.run(surface.opaque(), tiles, changes.occluded());
    clock.mark("occlusion");
    shadow.bind();
    occlusion.bind();
    light.dim(tiles, changes.lit());
    clock.mark("dimming");
    surface.opaque().bind(4, 5);
    meshes.bind_paints();
    light.run(surface.opaque(), drawn, tiles, meshes.pattern_kinds(), values.ground_colour.w > 0.0F);
    clock.mark("light");
    if (has_glass) {
      glass.run(surface, drawn, tiles, meshes.pattern_kinds());
      clock.mark("glass");
    }
    if (has_wires) {
      wires.run(meshes, surface.opaque(), drawn);
      clock.mark("wires");
    }
  }

  void read_back() {
    const auto width = static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
    rgba.resize(width * height * 4);
    if (kept.pixels.empty()) kept = Image(size.width, size.height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn.name());
    glReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    for (std::size_t y = 0; y < height; ++y) {  // GL's rows run from below
      const std::uint8_t* from = rgba.data() + (height - 1 - y) * width * 4;
      std::uint8_t* to = kept.pixels.data() + y * width * 3;
      for (std::size_t x = 0; x + 1 < width; ++x)
        std::memcpy(to + 3 * x, from + 4 * x, 4);  // the next overwrites the fourth
      std::memcpy(to + 3 * (width - 1), from + 4 * (width - 1), 3);
    }
  }
};

Renderer::Renderer(Size size, Quality quality, BackEnd back_end) {
  check_size(size);
  rooms_ = std::make_unique<Rooms>(size, quality, back_end);
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::render(const Frame& frame) {
  Rooms& r = *rooms_;
  r.context.make_current();
  PassClock clock(r.is_timed, r.times);
  r.prepare(frame);
  r.ground_id = frame.ground ? frame.ground->id : 0;
  if (!r.changes.is_nothing()) r.lay_floor();
  clock.mark("upload");
  if (!r.changes.is_nothing()) {
    r.draw(clock, frame.overlay.has_wires);
    r.read_back();
  }
  Image image = r.kept;
  clock.mark("read back");
  pass::draw_overlay(image, frame);
  clock.mark("overlay");
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw std::runtime_error("OpenGL error " + std::to_string(error) + " while drawing a frame");
  }
  r.is_kept = !frame.overlay.has_wires;  // lines over a picture that is kept in part would be drawn twice
  return image;
}

Truth Renderer::find_truth() {
  Rooms& r = *rooms_;
  r.context.make_current();
  r.block.assign(std::span<const pass::FrameBlock>(&r.values, 1));
  r.block.bind_uniform(0);
  return r.truth.run(r.meshes, r.values, r.ground_id);
}

void Renderer::forget() {
  rooms_->is_kept = false;
}
double Renderer::drawn_share() const {
  return rooms_->changes.lit_share();
}
Size Renderer::size() const {
  return rooms_->size;
}
Quality Renderer::quality() const {
  return rooms_->quality;
}
const std::string& Renderer::gl_renderer() const {
  return rooms_->context.gl_renderer();
}
bool Renderer::is_llvmpipe() const {
  return gl_renderer().find("llvmpipe") != std::string::npos;
}
int Renderer::mesh_count() const {
  return rooms_->meshes.mesh_count();
}
bool Renderer::has_shadow_maps() const {
  return rooms_->shadow.has_maps();
}
double Renderer::shadow_bytes() const {
  return rooms_->shadow.bytes();
}
void Renderer::set_timing(bool on) {
  rooms_->is_timed = on;
  rooms_->times.passes.clear();
}
const PassTimes& Renderer::pass_times() const {
  return rooms_->times;
}

}  // namespace shatterbox::render
