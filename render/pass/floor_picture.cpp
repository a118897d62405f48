#include "render/pass/floor_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "render/pass/floor_pattern.h"

namespace shatterbox::render::pass {
namespace {

constexpr int kSquare = 16;         // pixels; the backdrop runs straight between the corners of such squares
constexpr int kSteps = 16384;       // of the table: a fifth of a level where it is steepest
constexpr float kShoulder = 0.72F;  // as common/tone.glsl

// From linear light, 0..1 in kSteps, to sRGB codes.
const std::vector<std::uint8_t>& srgb_codes() {
  static const std::vector<std::uint8_t> codes = [] {
    std::vector<std::uint8_t> made(kSteps + 1);
    for (int i = 0; i <= kSteps; ++i) {
      const double x = static_cast<double>(i) / kSteps;
      const double code = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
      made[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(255.0 * code + 0.5);
    }
    return made;
  }();
  return codes;
}

// Where linear light stands in that table.
unsigned step_of(float light) {
  return static_cast<unsigned>(
      static_cast<int>(std::min(std::max(light, 0.0F), 1.0F) * static_cast<float>(kSteps) + 0.5F));
}

float smoothstep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

// As backdrop_at() in common/tone.glsl.
glm::vec3 backdrop_at(const FrameBlock& block, glm::vec2 pixel) {
  const glm::vec2 s = pixel * glm::vec2(block.viewport.z, block.viewport.w);
  glm::vec3 c =
      glm::mix(glm::vec3(block.backdrop_bottom), glm::vec3(block.backdrop_top), smoothstep(0.25F, 1.0F, s.y));
  const glm::vec2 g = (pixel - glm::vec2(block.glow_centre)) * block.glow_centre.z;
  c *= 1.0F + block.backdrop_top.w * std::exp2(-2.0F * glm::dot(g, g));
  const glm::vec2 v = (s - 0.5F) * 2.0F;
  return c * (1.0F - block.backdrop_bottom.w * 0.5F * smoothstep(0.3F, 2.0F, glm::dot(v, v)));
}

// As tone_map() there, after exposure.
glm::vec3 press(glm::vec3 c) {
  const float peak = std::max({c.r, c.g, c.b});
  if (peak <= kShoulder) return c;
  const float room = 1.0F - kShoulder, over = peak - kShoulder;
  const float pressed = kShoulder + room * over / (over + room);
  return glm::mix(c * (pressed / peak), glm::vec3(pressed), over / (over + 2.5F));
}

// A row's rays.
struct Row {
  glm::vec3 ray, step;  // at the picture's left edge, and for each pixel more
};

class Painter {
 public:
  explicit Painter(const FrameBlock& block)
      : block_(block),
        is_patterned_(block.ground_colour.w > 0.0F),
        width_(static_cast<int>(block.viewport.x)),
        height_(static_cast<int>(block.viewport.y)),
        across_((width_ + kSquare - 1) / kSquare),
        drop_(block.ground_place.x - block.eye_exposure.y),
        floor_(glm::vec3(block.floor_sun + block.floor_sky)) {
    const auto kind = static_cast<GroundPattern>(static_cast<int>(block.glow_centre.w));
    if (is_patterned_ && kind != GroundPattern::checker) pattern_ = &FloorPattern::of(kind);
    for (int y = 0; y <= (height_ + kSquare - 1) / kSquare; ++y) {
      for (int x = 0; x <= across_; ++x) {
        corners_.push_back(
            backdrop_at(block, {std::min(x * kSquare, width_), std::min(y * kSquare, height_)}));
      }
    }
  }

  void paint(const std::array<std::uint8_t, 3>& whole, FloorPicture& picture) {
    const auto pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    picture.rgba.resize(4 * pixels);
    picture.shares.resize(is_patterned_ ? pixels : 0);
    std::uint8_t* to = picture.rgba.data();
    std::uint16_t* shares = picture.shares.data();
    for (int y = 0; y < height_; ++y) {
      const float up = (static_cast<float>(y) + 0.5F) * block_.viewport.w * 2.0F - 1.0F;
      const glm::vec3 side = glm::vec3(block_.view_right) * (2.0F * block_.viewport.z);
      const Row row{
          glm::vec3(block_.view_forward) + up * glm::vec3(block_.view_up) - glm::vec3(block_.view_right),
          side};
      for (int x = 0; x < width_; x += kSquare) {
        const int count = std::min(kSquare, width_ - x);
        if (is_patterned_) find_shares(row, x, count, shares);
        paint_run(row, x, y, count, whole, shares, to);
        to += 4 * static_cast<std::ptrdiff_t>(count);
        if (is_patterned_) shares += count;
      }
    }
  }

 private:
  // How far the floor has faded, 0..1, as floor_faded() in common/floor.glsl.
  void find_fades(const Row& row, int first, float* fades) const {
    const glm::vec2 way(block_.ground_way);
    const float least = block_.ground_way.z, scale = block_.ground_way.w,
                with_ground = block_.ground_place.w * drop_;
    const float rise = row.ray.y, rise_step = row.step.y;
    const float into = row.ray.x * way.x + row.ray.z * way.y,
                into_step = row.step.x * way.x + row.step.z * way.y;
    for (int k = 0; k < kSquare; ++k) {
      const float x = static_cast<float>(first + k) + 0.5F;
      const float y_here = rise + x * rise_step, into_here = into + x * into_step;
      const float nearness = into_here > 0.0F ? y_here / (drop_ * into_here) : least;
      const float t =
          with_ground * y_here > 0.0F ? std::min(std::max((least - nearness) * scale, 0.0F), 1.0F) : 1.0F;
      fades[k] = t * t * (3.0F - 2.0F * t);
    }
  }

  // Where a pixel sees a patterned floor, in units of its pattern, and how wide a pixel is there.
  struct Seen {
    glm::dvec2 place{0.0};
    float across = 0.0F, along = 0.0F;
  };

  // Nothing above the horizon.
  std::optional<Seen> look(const Row& row, float x) const {
    const glm::vec3 ray = row.ray + row.step * x;
    if (block_.ground_place.w * ray.y * drop_ <= 0.0F) return std::nullopt;
    const float z = std::min(drop_ / ray.y, 1e6F), size = block_.ground_colour.w;
    Seen seen;
    seen.place = {(block_.eye_exposure.x + ray.x * z) / size, (block_.eye_exposure.z + ray.z * z) / size};
    seen.across = z * block_.view_ray.y * 2.0F * block_.viewport.w / size;
    seen.along = seen.across * z * glm::length(ray) / std::max(std::abs(drop_), 1e-6F);
    return seen;
  }

  // The share of its colour that a patterned floor has at the pixels of a run, in FloorPattern::kOne; 1
  // beyond the horizon.
  void find_shares(const Row& row, int first, int count, std::uint16_t* shares) const {
    std::fill_n(shares, count, static_cast<std::uint16_t>(FloorPattern::kOne));
    const float left = static_cast<float>(first) + 0.5F;
    if (pattern_ == nullptr) {
      for (int k = 0; k < count; ++k)
        if (const auto seen = look(row, left + static_cast<float>(k)))
          shares[k] = static_cast<std::uint16_t>(
              checker_at(seen->place, seen->along) * static_cast<float>(FloorPattern::kOne) + 0.5F);
      return;
    }
    // A run is short: its places lie on a line, as they do exactly where the camera is level.
    const auto from = look(row, left), to = look(row, left + static_cast<float>(count));
    if (!from || !to) return;
    const double units = pattern_->units();
    const auto depth_of = [units](const Seen& seen) {
      const float drawn_out = std::sqrt(std::clamp(seen.along / seen.across, 1.0F, 16.0F));
      return FloorPattern::depth_of(seen.across * drawn_out / static_cast<float>(units));
    };
    const float depth = depth_of(*from), more = (depth_of(*to) - depth) / static_cast<float>(count);
    pattern_->find_row(from->place / units, (to->place - from->place) / (units * count), depth, more, count,
                       shares);
  }

  // `count` pixels of one square's row.
  void paint_run(const Row& row, int x, int y, int count, const std::array<std::uint8_t, 3>& whole,
                 const std::uint16_t* shares, std::uint8_t* to) const {
    float fades[kSquare];
    find_fades(row, x, fades);
    if (!is_patterned_ && std::max(fades[0], fades[count - 1]) == 0.0F) {  // it is monotonous along a row
      for (int k = 0; k < count; ++k, to += 4) {
        to[0] = whole[0], to[1] = whole[1], to[2] = whole[2], to[3] = 255;
      }
      return;
    }
    const std::vector<std::uint8_t>& codes = srgb_codes();
    const int low = y / kSquare * kSquare, high = std::min(low + kSquare, height_);
    const float height = (static_cast<float>(y - low) + 0.5F) / static_cast<float>(high - low);
    const auto at = static_cast<std::size_t>(y / kSquare * (across_ + 1) + x / kSquare);
    const std::size_t above = at + static_cast<std::size_t>(across_) + 1;
    const float exposure = block_.eye_exposure.w;
    const glm::vec3 from = exposure * glm::mix(corners_[at], corners_[above], height);
    const glm::vec3 step = (exposure * glm::mix(corners_[at + 1], corners_[above + 1], height) - from) /
                           static_cast<float>(count);
    const glm::vec3 floor = exposure * floor_, to_end = from + step * static_cast<float>(count);
    const glm::vec3 most = glm::max(floor, glm::max(from, to_end));
    float share[kSquare];
    for (int k = 0; k < kSquare; ++k)
      share[k] = is_patterned_ && k < count ? static_cast<float>(shares[k]) / FloorPattern::kOne : 1.0F;
    if (std::max({most.r, most.g, most.b}) > (is_patterned_ ? 0.5F * kShoulder : kShoulder)) {
      for (int k = 0; k < count; ++k) {
        const glm::vec3 behind = from + step * (static_cast<float>(k) + 0.5F);
        const glm::vec3 ground = floor * share[k];
        const glm::vec3 c = press(ground + (behind - ground) * fades[k]);
        for (int i = 0; i < 3; ++i) to[4 * k + i] = codes[step_of(c[i])];
        to[4 * k + 3] = 255;
      }
      return;
    }
    unsigned steps[3][kSquare];  // nothing to press: channel by channel, several pixels at once
    for (int i = 0; i < 3; ++i) {
      const float start = from[i], more = step[i];
      for (int k = 0; k < kSquare; ++k) {
        const float ground = floor[i] * share[k];
        steps[i][k] = step_of(ground + (start - ground + more * (static_cast<float>(k) + 0.5F)) * fades[k]);
      }
    }
    for (int k = 0; k < count; ++k) {
      for (int i = 0; i < 3; ++i) to[4 * k + i] = codes[steps[i][k]];
      to[4 * k + 3] = 255;
    }
  }

  const FrameBlock& block_;
  bool is_patterned_;
  const FloorPattern* pattern_ = nullptr;  // none: a checker, or plain
  int width_, height_, across_;
  float drop_;
  glm::vec3 floor_;
  std::vector<glm::vec3> corners_;  // the backdrop at the squares' corners
};

}  // namespace

void paint_floor(const FrameBlock& block, const std::array<std::uint8_t, 3>& whole, FloorPicture& picture) {
  Painter(block).paint(whole, picture);
}

}  // namespace shatterbox::render::pass
