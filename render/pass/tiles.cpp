#include "render/pass/tiles.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace shatterbox::render::pass {
namespace {

constexpr int kSide = kTileSide;
constexpr char kPlain = 0, kOccluded = 1, kShaded = 2, kBody = 3;  // each needs what the ones before do
constexpr char kFlat = 0, kFading = 1, kBackdrop = 2;              // ground: whole, partly faded, gone

}  // namespace

Tiles::Tiles(int width, int height) : width_(width), height_(height), grid_(width, height) {}

void Tiles::mark(const Corners& corners, const FrameBlock& block, float margin_pixels, char kind,
                 Marks& marks) const {
  grid_.each(grid_.cover(corners, block, margin_pixels),
             [&](std::size_t tile) { marks[tile] = std::max(marks[tile], kind); });
}

template <typename IsWanted>
Tiles::Range Tiles::append_runs(IsWanted is_wanted, int longest) {
  Range range{static_cast<int>(rectangles_.size()), 0};
  for (int y = 0; y < grid_.down(); ++y) {
    const auto wanted = [&](int x) { return is_wanted(static_cast<std::size_t>(y * grid_.across() + x)); };
    for (int x = 0; x < grid_.across();) {
      if (!wanted(x)) {
        ++x;
        continue;
      }
      const int first = x;
      while (x < grid_.across() && x - first < longest && wanted(x)) ++x;
      rectangles_.emplace_back(first * kSide, y * kSide, std::min(x * kSide, width_),
                               std::min((y + 1) * kSide, height_));
      ++range.count;
    }
  }
  return range;
}

void Tiles::mark_bodies(const MeshStore& meshes, const FrameBlock& block) {
  marks_.assign(grid_.count(), kPlain);
  near_marks_.assign(marks_.size(), kPlain);
  glass_marks_.assign(marks_.size(), kPlain);
  for (const Item& item : meshes.items()) {
    const Corners& body = item.box_world;
    if (item.casts_shadow && block.ground_place.w > 0.0F) {
      mark(find_floor_shadow(body, block), block, kSide, kShaded, marks_);
    }
    if (!item.is_on_screen) continue;
    if (item.is_glass) {
      mark(body, block, 1.0F, kBody, glass_marks_);
      continue;
    }
    if (const std::optional<Corners> floor = find_occluded_floor(body, block)) {
      mark(*floor, block, kOcclusionPixels, kOccluded, marks_);
      mark(*floor, block, kOcclusionPixels, kOccluded, near_marks_);
    }
    mark(body, block, 1.0F, kBody, marks_);
    mark(body, block, 1.0F, kBody, near_marks_);
  }
}

// By the corners: the ground within a tile lies no farther into the picture than the farthest of them, and no
// nearer than the nearest.
void Tiles::mark_ground(const FrameBlock& block) {
  const auto stride = static_cast<std::size_t>(grid_.across()) + 1;
  corner_marks_.assign(stride * (static_cast<std::size_t>(grid_.down()) + 1), kBackdrop);
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
    const auto across = static_cast<std::size_t>(grid_.across());
    const char* corner = &corner_marks_[i / across * stride + i % across];
    const auto [least, most] = std::minmax({corner[0], corner[1], corner[stride], corner[stride + 1]});
    ground_marks_[i] = least == most ? least : kFading;
    if (ground_marks_[i] == kFlat && block.ground_colour.w > 0.0F) ground_marks_[i] = kFading;  // patterned
  }
}

// A tile that shows no body and no darkened floor looks nothing up.
void Tiles::mark_changes() {
  changed_marks_.assign(marks_.size(), 0);
  if (earlier_marks_.size() != marks_.size()) return;
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    if (marks_[i] == earlier_marks_[i]) continue;
    grid_.each_about(i, [&](std::size_t other) {
      if (other == i || marks_[other] != kPlain) changed_marks_[other] = 1;
    });
  }
}

void Tiles::find(const MeshStore& meshes, const FrameBlock& block) {
  marks_.swap(earlier_marks_);
  mark_bodies(meshes, block);
  mark_ground(block);
  mark_changes();
}

void Tiles::select(const Changes& changes) {
  rectangles_.clear();
  const int row = grid_.across();
  const auto append_changed = [&](const Changes::Marks& marks) {
    return marks.is_all ? Range{} : append_runs([&](std::size_t i) { return marks.has(i); }, row);
  };
  changed_bodies_ = append_changed(changes.bodies());
  changed_glass_ = append_changed(changes.glass());
  changed_occlusion_ = append_changed(changes.occluded());
  changed_light_ = append_changed(changes.lit());
  near_bodies_ =
      append_runs([&](std::size_t i) { return near_marks_[i] != kPlain && changes.occluded().has(i); }, row);
  const auto append = [&](auto is_wanted, int longest) {
    return append_runs([&](std::size_t i) { return changes.lit().has(i) && is_wanted(i); }, longest);
  };
  bodies_ = append([&](std::size_t i) { return marks_[i] == kBody; }, row);
  glass_ = append([&](std::size_t i) { return glass_marks_[i] == kBody; }, row);
  const auto is_floor = [&](std::size_t i) { return ground_marks_[i] != kBackdrop; };
  shaded_ = append([&](std::size_t i) { return marks_[i] >= kShaded && is_floor(i); }, row);
  occluded_ = append([&](std::size_t i) { return marks_[i] == kOccluded && is_floor(i); }, 1);
  const auto append_squares = [&](bool is_behind, char ground) {
    return append(
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

std::span<const glm::uvec4> Tiles::rectangles(Range range) const {
  return std::span<const glm::uvec4>(rectangles_)
      .subspan(static_cast<std::size_t>(range.first), static_cast<std::size_t>(range.count));
}

void Tiles::draw(Range range) {
  if (range.count == 0) return;
  glDrawArrays(GL_TRIANGLES, 6 * range.first, 6 * range.count);
}

}  // namespace shatterbox::render::pass
