// The picture in squares of 16 x 16 pixels, and which of them a box in the world may touch.
#pragma once
#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "render/pass/frame_block.h"

namespace shatterbox::render::pass {

inline constexpr int kTileSide = 16;  // pixels

struct Corners {
  glm::vec3 at[8];  // world
};

// The convex outline of what is seen of points in the world, pixels from below.
struct Outline {
  glm::vec2 least{0.0F}, most{0.0F};  // its box
  std::vector<glm::vec2> corners;     // counter-clockwise; none: the box itself
};

// Tiles of a rectangle, both ends included.
struct TileSpan {
  int left = 0, bottom = 0, right = -1, top = -1;
};

class TileGrid {
 public:
  TileGrid(int width, int height);
  int across() const { return across_; }
  int down() const { return down_; }
  std::size_t count() const { return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_); }
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * across_ + x); }

  // None if all of it is outside the picture, by more than beyond_pixels. The whole picture if a point is
  // behind the eye.
  std::optional<Outline> find_outline(std::span<const glm::vec3> points, const FrameBlock& block,
                                      float beyond_pixels = 0.0F) const;
  // Of its box.
  TileSpan span_of(const Outline& outline, float margin_pixels) const;
  bool touches(const Outline& outline, int x, int y, float margin_pixels) const;  // a tile
  // The tiles about a box's projection: those of a rectangle.
  TileSpan cover(const Corners& box, const FrameBlock& block, float margin_pixels) const;

  template <typename Do>  // index of each tile
  void each(const TileSpan& span, Do&& act) const {
    for (int y = span.bottom; y <= span.top; ++y) {
      for (int x = span.left; x <= span.right; ++x) act(index(x, y));
    }
  }

  template <typename Do>  // index of the tile, and of each that touches it
  void each_about(std::size_t tile, Do&& act) const {
    const int x = static_cast<int>(tile) % across_, y = static_cast<int>(tile) / across_;
    each({std::max(x - 1, 0), std::max(y - 1, 0), std::min(x + 1, across_ - 1), std::min(y + 1, down_ - 1)},
         act);
  }

  template <typename Do>  // index of each tile that the outline itself touches
  void each(const Outline& outline, float margin_pixels, Do&& act) const {
    const TileSpan span = span_of(outline, margin_pixels);
    for (int y = span.bottom; y <= span.top; ++y) {
      for (int x = span.left; x <= span.right; ++x) {
        if (touches(outline, x, y, margin_pixels)) act(index(x, y));
      }
    }
  }

 private:
  // The box; the points seen go to `seen`, if it is not null and all lie before the eye.
  std::optional<Outline> find_box(std::span<const glm::vec3> points, const FrameBlock& block,
                                  float beyond_pixels, std::vector<glm::vec2>* seen) const;

  int width_, height_, across_, down_;
};

// What may be darkened by a box in the sun: its shadow on the ground. What lies below stays.
Corners find_floor_shadow(const Corners& box, const FrameBlock& block);

// The floor that a body's box hides enough sky from; none if it floats too high.
std::optional<Corners> find_occluded_floor(const Corners& body, const FrameBlock& block);
inline constexpr float kOcclusionPixels = 8.0F;  // however low it is, samples and blur reach so far

}  // namespace shatterbox::render::pass
