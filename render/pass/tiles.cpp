#include "render/pass/tiles.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace shatterbox::render::pass {
namespace {

constexpr int kSide = 16;                                          // pixels
constexpr char kPlain = 0, kOccluded = 1, kShaded = 2, kBody = 3;  // each needs what the ones before do
constexpr char kFlat = 0, kFading = 1, kBackdrop = 2;              // ground: whole, partly faded, gone

// Farther than so many times its height above the floor a body hides too little of the sky to see.
constexpr float kOcclusionHeights = 2.2F;
constexpr float kOcclusionPixels = 8.0F;  // and, however low, samples and blur reach so far

// Along the sun onto the floor; what lies below it stays.
glm::vec3 shadow_of(glm::vec3 p, const FrameBlock& block) {
  const float above = std::max(p.y - block.ground_place.x, 0.0F);
  return p - glm::vec3(block.sun) * (above / std::max(block.sun.y, 1e-3F));
}

}  // namespace

Tiles::Tiles(int width, int height)
    : width_(width),
      height_(height),
      across_((width + kSide - 1) / kSide),
      down_((height + kSide - 1) / kSide) {}

void Tiles::mark(const Corners& corners, const FrameBlock& block, float margin_pixels, char kind,
                 Marks& marks) const {
  glm::vec2 least(1e9F), most(-1e9F);
  for (const glm::vec3& corner : corners.at) {
    const glm::vec4 p = block.clip_from_world * glm::vec4(corner, 1.0F);
    if (p.z < -p.w || p.w <= 0.0F) {  // reaches behind the eye: may be anywhere
      least = glm::vec2(-1.0F);
      most = glm::vec2(1.0F);
      break;
    }
    const glm::vec2 at = glm::vec2(p) / p.w;
    least = glm::min(least, at);
    most = glm::max(most, at);
  }
  if (least.x > 1.0F || most.x < -1.0F || least.y > 1.0F || most.y < -1.0F) return;
  const auto tile = [](float ndc, int pixels, float shift, int count) {
    const float pixel = (std::clamp(ndc, -1.5F, 1.5F) * 0.5F + 0.5F) * static_cast<float>(pixels);
    return std::clamp(static_cast<int>(std::floor((pixel + shift) / kSide)), 0, count - 1);
  };
  const int left = tile(least.x, width_, -margin_pixels, across_);
  const int right = tile(most.x, width_, margin_pixels, across_);
  const int bottom = tile(least.y, height_, -margin_pixels, down_);
  const int top = tile(most.y, height_, margin_pixels, down_);
  for (int y = bottom; y <= top; ++y) {
    for (int x = left; x <= right; ++x) {
      char& here = marks[static_cast<std::size_t>(y * across_ + x)];
      here = std::max(here, kind);
    }
  }
}

template <typename IsWanted>
Tiles::Range Tiles::append_runs(IsWanted is_wanted, int longest) {
  Range range{static_cast<int>(rectangles_.size()), 0};
  for (int y = 0; y < down_; ++y) {
    const auto wanted = [&](int x) { return is_wanted(static_cast<std::size_t>(y * across_ + x)); };
    for (int x = 0; x < across_;) {
      if (!wanted(x)) {
        ++x;
        continue;
      }
      const int first = x;
      while (x < across_ && x - first < longest && wanted(x)) ++x;
      rectangles_.emplace_back(first * kSide, y * kSide, std::min(x * kSide, width_),
                               std::min((y + 1) * kSide, height_));
      ++range.count;
    }
  }
  return range;
}

// The floor that a body's box hides enough sky from; none if it floats too high.
std::optional<Tiles::Corners> Tiles::find_occluded_floor(const Corners& body, const FrameBlock& block) {
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

void Tiles::mark_bodies(const MeshStore& meshes, const FrameBlock& block) {
  marks_.assign(static_cast<std::size_t>(across_ * down_), kPlain);
  near_marks_.assign(marks_.size(), kPlain);
  glass_marks_.assign(marks_.size(), kPlain);
  for (const Item& item : meshes.items()) {
    const DrawnMesh& shape = item.stored->shape;
    Corners body, shadow;
    for (int i = 0; i < 8; ++i) {
      const glm::vec3 corner((i & 1) ? shape.box_most.x : shape.box_least.x,
                             (i & 2) ? shape.box_most.y : shape.box_least.y,
                             (i & 4) ? shape.box_most.z : shape.box_least.z);
      body.at[i] = glm::vec3(item.world_from_body * glm::vec4(corner, 1.0F));
      shadow.at[i] = shadow_of(body.at[i], block);
    }
    if (item.casts_shadow && block.ground_place.w > 0.0F) mark(shadow, block, kSide, kShaded, marks_);
    if (!item.is_on_screen) continue;
    if (item.is_glass) {
      mark(body, block, 1.0F, kBody, glass_marks_);
    } else {
      if (const std::optional<Corners> floor = find_occluded_floor(body, block)) {
        mark(*floor, block, kOcclusionPixels, kOccluded, marks_);
        mark(*floor, block, kOcclusionPixels, kOccluded, near_marks_);
      }
      mark(body, block, 1.0F, kBody, marks_);
      mark(body, block, 1.0F, kBody, near_marks_);
    }
  }
}

// By the corners: the ground within a tile lies no farther into the picture than the farthest of them, and no
// nearer than the nearest.
void Tiles::mark_ground(const FrameBlock& block) {
  const auto stride = static_cast<std::size_t>(across_) + 1;
  corner_marks_.assign(stride * (static_cast<std::size_t>(down_) + 1), kBackdrop);
  ground_marks_.assign(marks_.size(), kBackdrop);
  if (block.ground_place.w == 0.0F) return;
  const glm::vec2 way(block.ground_way);
  const float drop = block.ground_place.x - block.eye_exposure.y;
  for (std::size_t i = 0; i < corner_marks_.size(); ++i) {
    const float x = static_cast<float>(i % stride * kSide) * block.viewport.z * 2.0F - 1.0F;
    const float y = static_cast<float>(i / stride * kSide) * block.viewport.w * 2.0F - 1.0F;
    const glm::vec3 ray =
        glm::vec3(block.view_forward) + x * glm::vec3(block.view_right) + y * glm::vec3(block.view_up);
    if (ray.y * drop <= 0.0F) continue;
    const float into = glm::dot(glm::vec2(ray.x, ray.z), way) * (drop / ray.y);
    corner_marks_[i] = into <= block.ground_place.y           ? kFlat
                       : into <= 1.02F * block.ground_place.z ? kFading
                                                              : kBackdrop;
  }
  for (std::size_t i = 0; i < ground_marks_.size(); ++i) {
    const auto across = static_cast<std::size_t>(across_);
    const char* corner = &corner_marks_[i / across * stride + i % across];
    const auto [least, most] = std::minmax({corner[0], corner[1], corner[stride], corner[stride + 1]});
    ground_marks_[i] = least == most ? least : kFading;
    if (ground_marks_[i] == kFlat && block.ground_colour.w > 0.0F) ground_marks_[i] = kFading;  // checkered
  }
}

void Tiles::find(const MeshStore& meshes, const FrameBlock& block) {
  mark_bodies(meshes, block);
  mark_ground(block);
  rectangles_.clear();
  bodies_ = append_runs([&](std::size_t i) { return marks_[i] == kBody; }, across_);
  glass_ = append_runs([&](std::size_t i) { return glass_marks_[i] == kBody; }, across_);
  near_bodies_ = append_runs([&](std::size_t i) { return near_marks_[i] != kPlain; }, across_);
  const auto is_floor = [&](std::size_t i) { return ground_marks_[i] != kBackdrop; };
  shaded_ = append_runs([&](std::size_t i) { return marks_[i] >= kShaded && is_floor(i); }, across_);
  occluded_ = append_runs([&](std::size_t i) { return marks_[i] == kOccluded && is_floor(i); }, 1);
  const auto append_squares = [&](bool is_behind, char ground) {
    return append_runs(
        [&](std::size_t i) {
          return ground_marks_[i] == ground &&
                 (is_behind ? marks_[i] == kBody : marks_[i] == kShaded || marks_[i] == kOccluded);
        },
        1);
  };
  behind_bodies_ = {append_squares(true, kFlat), append_squares(true, kFading)};
  open_floor_ = {append_squares(false, kFlat), append_squares(false, kFading)};
  buffer_.assign(std::span<const glm::uvec4>(rectangles_));
  buffer_.bind_storage(2);
}

void Tiles::draw(Range range) {
  if (range.count == 0) return;
  glDrawArrays(GL_TRIANGLES, 6 * range.first, 6 * range.count);
}

}  // namespace shatterbox::render::pass
