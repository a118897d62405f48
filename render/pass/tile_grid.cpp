#include "render/pass/tile_grid.h"

#include <cmath>
#include <utility>

namespace shatterbox::render::pass {
namespace {

// Farther than so many times its height above the floor a body hides too little of the sky to see.
constexpr float kOcclusionHeights = 2.2F;
constexpr float kFarPixels = 1e5F;  // an outline's corners beyond are not told apart well enough

// The convex hull, counter-clockwise (Andrew's monotone chain).
std::vector<glm::vec2> find_hull(std::vector<glm::vec2> points) {
  std::sort(points.begin(), points.end(),
            [](glm::vec2 a, glm::vec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<glm::vec2> hull;
  const auto add_chain = [&hull](auto first, auto last) {
    const std::size_t begin = hull.size();
    for (auto p = first; p != last; ++p) {
      while (hull.size() >= begin + 2) {
        const glm::vec2 a = hull[hull.size() - 2], b = hull.back();
        if ((b.x - a.x) * (p->y - a.y) - (b.y - a.y) * (p->x - a.x) > 0.0F) break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    if (!hull.empty()) hull.pop_back();  // the next chain begins with it
  };
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

}  // namespace

TileGrid::TileGrid(int width, int height)
    : width_(width),
      height_(height),
      across_((width + kTileSide - 1) / kTileSide),
      down_((height + kTileSide - 1) / kTileSide) {}

std::optional<Outline> TileGrid::find_box(std::span<const glm::vec3> points, const FrameBlock& block,
                                          float beyond_pixels, std::vector<glm::vec2>* seen) const {
  const glm::vec2 size(static_cast<float>(width_), static_cast<float>(height_));
  Outline outline{glm::vec2(0.0F), size, {}};
  glm::vec2 least(1e9F), most(-1e9F);
  for (const glm::vec3& point : points) {
    const glm::vec4 p = block.clip_from_world * glm::vec4(point, 1.0F);
    if (p.z < -p.w || p.w <= 0.0F) {
      if (seen != nullptr) seen->clear();
      return outline;
    }
    const glm::vec2 ndc = glm::vec2(p) / p.w;
    least = glm::min(least, ndc);
    most = glm::max(most, ndc);
    if (seen != nullptr) seen->push_back((ndc * 0.5F + 0.5F) * size);
  }
  const glm::vec2 edge = 1.0F + 2.0F * beyond_pixels / size;
  if (glm::any(glm::greaterThan(least, edge)) || glm::any(glm::lessThan(most, -edge))) return std::nullopt;
  outline.least = (glm::clamp(least, -1.5F, 1.5F) * 0.5F + 0.5F) * size;
  outline.most = (glm::clamp(most, -1.5F, 1.5F) * 0.5F + 0.5F) * size;
  return outline;
}

std::optional<Outline> TileGrid::find_outline(std::span<const glm::vec3> points, const FrameBlock& block,
                                              float beyond_pixels) const {
  std::vector<glm::vec2> seen;
  std::optional<Outline> outline = find_box(points, block, beyond_pixels, &seen);
  const bool is_near = std::all_of(seen.begin(), seen.end(), [](glm::vec2 p) {
    return std::abs(p.x) < kFarPixels && std::abs(p.y) < kFarPixels;
  });
  if (outline && is_near) outline->corners = find_hull(std::move(seen));
  return outline;
}

TileSpan TileGrid::span_of(const Outline& outline, float margin_pixels) const {
  const auto tile = [](float pixel, int count) {
    return std::clamp(static_cast<int>(std::floor(pixel / kTileSide)), 0, count - 1);
  };
  return {tile(outline.least.x - margin_pixels, across_), tile(outline.least.y - margin_pixels, down_),
          tile(outline.most.x + margin_pixels, across_), tile(outline.most.y + margin_pixels, down_)};
}

// It does not if one of the outline's sides has all of the tile before it. A margin makes the tile wider, and
// allows for rounding.
bool TileGrid::touches(const Outline& outline, int x, int y, float margin_pixels) const {
  constexpr auto kHalf = 0.5F * static_cast<float>(kTileSide);
  const glm::vec2 centre = glm::vec2(x, y) * static_cast<float>(kTileSide) + kHalf;
  const std::vector<glm::vec2>& corners = outline.corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::vec2 side = corners[(i + 1) % corners.size()] - corners[i];
    const glm::vec2 out(side.y, -side.x);
    const float reach = (kHalf + margin_pixels) * (std::abs(out.x) + std::abs(out.y));
    if (glm::dot(centre - corners[i], out) > reach) return false;
  }
  return true;
}

TileSpan TileGrid::cover(const Corners& box, const FrameBlock& block, float margin_pixels) const {
  const std::optional<Outline> outline = find_box(box.at, block, 0.0F, nullptr);
  return outline ? span_of(*outline, margin_pixels) : TileSpan{};
}

Corners find_floor_shadow(const Corners& box, const FrameBlock& block) {
  Corners shadow;
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 p = box.at[i];
    const float above = std::max(p.y - block.ground_place.x, 0.0F);
    shadow.at[i] = p - glm::vec3(block.sun) * (above / std::max(block.sun.y, 1e-3F));
  }
  return shadow;
}

std::optional<Corners> find_occluded_floor(const Corners& body, const FrameBlock& block) {
  glm::vec3 least = body.at[0], most = least;
  for (const glm::vec3& corner : body.at) {
    least = glm::min(least, corner);
    most = glm::max(most, corner);
  }
  const float height = block.ground_place.x;
  const float reach = std::min(block.occlusion_scale.w, kOcclusionHeights * (most.y - height));
  if (block.ground_place.w == 0.0F || least.y > height + reach || most.y < height) return std::nullopt;
  Corners floor;
  for (int i = 0; i < 8; ++i) {
    floor.at[i] = {(i & 1) ? most.x + reach : least.x - reach, height,
                   (i & 2) ? most.z + reach : least.z - reach};
  }
  return floor;
}

}  // namespace shatterbox::render::pass
