// How each draw's faces look, as rows of a texture that the light pass reads. A draw keeps its rows from
// frame to frame: what the geometry pass has written, names them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/frame/expand.h"
#include "render/frame/frame.h"
#include "render/gpu/texture.h"

namespace shatterbox::render::pass {

// As the shaders name what a frame shows, beside the kinds of its patterns: what is a mirror, and glass or
// ice that is not clear.
constexpr unsigned kMirrors = 1024U, kCloudy = 2048U;
constexpr float kClear = 0.9F;  // transmission, from which on glass takes no shadow

class PaintTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  struct Rows {
    std::uint32_t first = kNone;
    std::uint32_t count = 0;
    bool is_as_before = false;  // rows of an earlier frame, with the same contents
  };

  static std::uint32_t count_of(const Draw& draw);  // rows that it needs
  // Begins a frame. True: all rows are free, because more were kept than is worth it.
  bool begin(const Frame& frame);
  void forget();  // all rows are free
  // Writes a draw's rows: to those that it had (`first`), or to new ones (kNone).
  Rows write(const Draw& draw, const Overlay& overlay, std::uint32_t first);
  void upload();
  void bind() const { texture_.bind(6); }
  // On any draw of this frame: bits by kind.
  unsigned pattern_kinds() const { return pattern_kinds_; }

 private:
  gpu::Texture texture_;  // grows
  std::vector<float> values_;
  std::size_t row_count_ = 0;
  unsigned pattern_kinds_ = 0;
  bool has_changed_ = true;
};

}  // namespace shatterbox::render::pass
