#include "render/pass/overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

#include "render/pass/stroke_font.h"

namespace shatterbox::render::pass {
namespace {

constexpr std::array<std::uint8_t, 3> kWhite = {250, 250, 248};

float smooth_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

std::uint8_t to_srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  const float encoded = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(encoded * 255.0F));
}

float unit_for(const Image& image) {
  return std::max(static_cast<float>(image.height) / 200.0F, 1.5F);
}

void draw_caption(Image& image, std::string_view caption) {
  const float unit = unit_for(image), margin = 7.0F * unit, line = 11.0F * unit;
  const auto lines = static_cast<float>(std::count(caption.begin(), caption.end(), '\n'));
  float y = static_cast<float>(image.height) - margin - lines * line;
  while (!caption.empty()) {
    const std::size_t end = std::min(caption.find('\n'), caption.size());
    draw_text(image, margin, y, unit, kWhite, caption.substr(0, end));
    caption.remove_prefix(std::min(end + 1, caption.size()));
    y += line;
  }
}

// The text in lines no wider than `width` (pixels), broken at blanks.
std::vector<std::string> wrap(std::string_view text, float unit, float width) {
  std::vector<std::string> lines{""};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    const std::string word(text.substr(0, end));
    const bool has_break = end < text.size() && text[end] == '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (text_width(longer, unit) <= width || lines.back().empty())
      lines.back() = longer;
    else
      lines.push_back(word);
    if (has_break) lines.emplace_back();
  }
  return lines;
}

// In as few lines, and as evenly filled as that allows: no word by itself in the last one.
std::vector<std::string> wrap_evenly(std::string_view text, float unit, float width) {
  std::vector<std::string> lines = wrap(text, unit, width);
  for (float narrower = 0.95F * width; narrower > 0.3F * width; narrower -= 0.05F * width) {
    std::vector<std::string> narrow = wrap(text, unit, narrower);
    if (narrow.size() > lines.size()) break;
    lines = std::move(narrow);
  }
  return lines;
}

void draw_title(Image& image, const Title& title, bool has_caption) {
  const float unit = 1.7F * unit_for(image), line = 10.5F * unit;
  const std::vector<std::string> lines =
      wrap_evenly(title.text, unit, 0.9F * static_cast<float>(image.width));
  const float below = (has_caption ? 15.0F : 8.0F) * unit;
  float y = static_cast<float>(image.height) - below - static_cast<float>(lines.size() - 1) * line;
  for (const std::string& text : lines) {
    const float x = 0.5F * (static_cast<float>(image.width) - text_width(text, unit));
    draw_text(image, x, y, unit, kWhite, text, std::clamp(title.opacity, 0.0F, 1.0F));
    y += line;
  }
}

void draw_scale(Image& image, const Overlay& overlay) {
  const float unit = 0.85F * unit_for(image);
  const int height = static_cast<int>(0.42F * static_cast<float>(image.height));
  const int width = std::max(static_cast<int>(6.0F * unit), 4);
  const int left = image.width - static_cast<int>(36.0F * unit);
  const int top = static_cast<int>(0.12F * static_cast<float>(image.height)) + static_cast<int>(6.0F * unit);
  if (left < 0 || top + height >= image.height) return;
  for (int y = -1; y <= height; ++y) {
    const float t = 1.0F - (static_cast<float>(y) + 0.5F) / static_cast<float>(height);
    const glm::vec3 colour = heat_colour(t);
    for (int x = -1; x <= width; ++x) {
      std::uint8_t* pixel = image.at(left + x, top + y);
      const bool is_frame = y < 0 || y == height || x < 0 || x == width;
      for (int k = 0; k < 3; ++k) pixel[k] = is_frame ? std::uint8_t{245} : to_srgb(colour[k]);
    }
  }
  constexpr int kTicks = 4;
  for (int i = 0; i <= kTicks; ++i) {
    const float t = static_cast<float>(i) / kTicks;
    char number[32];
    std::snprintf(number, sizeof number, "%.3g",
                  static_cast<double>(overlay.least + t * (overlay.most - overlay.least)));
    const float y = static_cast<float>(top) + (1.0F - t) * static_cast<float>(height);
    draw_text(image, static_cast<float>(left + width) + 4.0F * unit, y + 3.0F * unit, unit, kWhite, number);
  }
  std::string title = overlay.title;
  if (!overlay.unit.empty()) title += " (" + overlay.unit + ")";
  const float right = static_cast<float>(image.width) - 6.0F * unit;
  const float x = std::min(static_cast<float>(left), right - text_width(title, unit));
  draw_text(image, std::max(x, 2.0F), static_cast<float>(top) - 7.0F * unit, unit, kWhite, title);
}

}  // namespace

glm::vec3 heat_colour(float t) {
  const glm::vec3 low =
      glm::mix(glm::vec3(0.02F, 0.05F, 0.25F), glm::vec3(0.03F, 0.36F, 0.48F), smooth_step(0.0F, 0.35F, t));
  const glm::vec3 mid = glm::mix(low, glm::vec3(0.88F, 0.72F, 0.12F), smooth_step(0.3F, 0.7F, t));
  return glm::mix(mid, glm::vec3(0.75F, 0.04F, 0.02F), smooth_step(0.68F, 1.0F, t));
}

void draw_overlay(Image& image, const Frame& frame) {
  if (frame.overlay.kind == OverlayKind::heat) draw_scale(image, frame.overlay);
  if (!frame.caption.empty()) draw_caption(image, frame.caption);
  if (frame.title.opacity > 0.0F && !frame.title.text.empty())
    draw_title(image, frame.title, !frame.caption.empty());
}

}  // namespace shatterbox::render::pass
