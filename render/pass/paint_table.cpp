#include "render/pass/paint_table.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace shatterbox::render::pass {
namespace {

// Four texels as common/paint.glsl reads them: colour, roughness | metalness, coat, its roughness,
// transmission | pattern colour, kind + metalness / 2 | pattern centre, size.
struct PaintRow {
  glm::vec4 paint, finish, pattern, place;
};
constexpr float kHeatMap = 8.0F, kGroups = 9.0F;  // pattern kinds of their own
constexpr float kMirrorRoughness = 0.3F, kMirrorMetalness = 0.7F;
constexpr float kScattering = -1.0F;  // in place of a coat: the broken rim of glass, as glass.frag reads it
constexpr int kRowsAbreast = 256;
constexpr std::size_t kFloats = sizeof(PaintRow) / sizeof(float);
constexpr std::array<Face, 3> kFaces = {Face::outside, Face::inside, Face::crack};
constexpr std::size_t kSpareRows = 256;  // may lie idle before all begin anew

PaintRow to_paint(const Look& look, Face face) {
  PaintRow row{};
  row.place = glm::vec4(look.pattern_centre, std::max(look.pattern_size, 1e-9F));
  switch (face) {
    case Face::outside: {
      const float metal =
          std::clamp(look.pattern_metalness, 0.0F, 1.0F) * 0.499F;  // stays below the next kind
      row.paint = glm::vec4(look.outside, look.roughness);
      row.finish = {look.metalness, look.clear_coat, look.clear_coat_roughness, look.transmission};
      row.pattern = glm::vec4(look.pattern_colour, static_cast<float>(look.pattern) + metal);
      if (look.pattern == Pattern::none) row.pattern.w = 0.0F;
      break;
    }
    case Face::inside:
      row.paint = glm::vec4(look.inside, look.inside_roughness);
      row.finish = {look.inside_metalness, 0.5F * look.clear_coat, look.clear_coat_roughness,
                    look.transmission};
      break;
    case Face::crack:  // rims of glass scatter
      row.paint = glm::vec4(look.crack, look.crack_roughness);
      row.finish = {0.0F, look.transmission > 0.0F ? kScattering : 0.0F, 0.1F, 0.25F * look.transmission};
      if (look.pattern == Pattern::clouds)
        row.pattern = glm::vec4(look.crack * look.pattern_colour / glm::max(look.outside, glm::vec3(0.01F)),
                                static_cast<float>(look.pattern));
      break;
  }
  return row;
}

// A colour of its own for each piece: hues by the golden ratio, two lightnesses.
glm::vec3 piece_colour(std::uint32_t index) {
  const double turn = static_cast<double>(index) * 0.6180339887498949;
  const auto hue = static_cast<float>(turn - std::floor(turn));
  glm::vec3 c;
  for (int k = 0; k < 3; ++k) {
    const float x = hue + static_cast<float>((3 - k) % 3) / 3.0F;
    c[k] = std::clamp(std::abs((x - std::floor(x)) * 6.0F - 3.0F) - 1.0F, 0.0F, 1.0F);
  }
  return glm::mix(glm::vec3(0.30F), c * c, 0.66F) * ((index & 1U) == 0 ? 0.85F : 0.5F);
}

void lay_over(PaintRow& row, const Draw& draw, const Overlay& overlay, Face face) {
  if (overlay.kind == OverlayKind::pieces && draw.colour_index != Draw::kNoColour) {
    const glm::vec3 own = piece_colour(draw.colour_index);
    row.paint = glm::vec4(face == Face::crack ? glm::mix(own, glm::vec3(0.85F), 0.7F) : own, 0.5F);
    row.finish = {0.0F, 0.4F * std::max(row.finish.y, 0.0F), std::max(row.finish.z, 0.1F), 0.0F};
    row.pattern.w = 0.0F;
  }
  const bool is_groups = overlay.kind == OverlayKind::groups;
  const bool has_scalars = overlay.kind == OverlayKind::heat || is_groups;
  if (has_scalars && draw.scalars != nullptr && face != Face::crack) {
    row.paint.w = 0.5F;
    row.finish = {0.0F, 0.4F * std::max(row.finish.y, 0.0F), std::max(row.finish.z, 0.1F),
                  0.5F * row.finish.w};
    row.pattern.w = is_groups ? kGroups : kHeatMap;
  }
}

}  // namespace

std::uint32_t PaintTable::count_of(const Draw& draw) {
  return static_cast<std::uint32_t>(kFaces.size() * std::max<std::size_t>(draw.looks.size(), 1));
}

bool PaintTable::begin(const Frame& frame) {
  std::size_t needed = 0;
  for (const Draw& draw : frame.draws) needed += count_of(draw);
  pattern_kinds_ = 0;
  if (row_count_ <= 2 * needed + kSpareRows) return false;
  forget();
  return true;
}

void PaintTable::forget() {
  row_count_ = 0;
  values_.clear();
  has_changed_ = true;
}

PaintTable::Rows PaintTable::write(const Draw& draw, const Overlay& overlay, std::uint32_t first) {
  Rows rows{first, count_of(draw), first != kNone};
  if (first == kNone) {
    rows.first = static_cast<std::uint32_t>(row_count_);
    row_count_ += rows.count;
    values_.resize(row_count_ * kFloats);
  }
  const Look plain;
  float* kept = values_.data() + rows.first * kFloats;
  for (std::size_t i = 0; i < rows.count; ++i, kept += kFloats) {
    const Face face = kFaces[i % kFaces.size()];
    PaintRow row = to_paint(draw.looks.empty() ? plain : draw.looks[i / kFaces.size()], face);
    lay_over(row, draw, overlay, face);
    if (row.pattern.w >= 1.0F) pattern_kinds_ |= 1U << static_cast<unsigned>(row.pattern.w);
    if (row.paint.w < kMirrorRoughness && row.finish.x > kMirrorMetalness) pattern_kinds_ |= kMirrors;
    if (row.finish.w > 0.0F && row.finish.w < kClear) pattern_kinds_ |= kCloudy;
    if (rows.is_as_before && std::memcmp(kept, &row, sizeof row) == 0) continue;
    rows.is_as_before = false;
    has_changed_ = true;
    std::memcpy(kept, &row, sizeof row);
  }
  return rows;
}

void PaintTable::upload() {
  if (!has_changed_ && texture_.name() != 0) return;
  has_changed_ = false;
  constexpr std::size_t kFloatsAbreast = kRowsAbreast * kFloats;
  const auto lines = static_cast<int>((values_.size() + kFloatsAbreast - 1) / kFloatsAbreast);
  if (texture_.height() < std::max(lines, 1)) {
    texture_ = gpu::Texture(4 * kRowsAbreast, std::max(2 * lines, 1), GL_RGBA32F, gpu::Filter::nearest);
  }
  if (lines == 0) return;
  values_.resize(static_cast<std::size_t>(lines) * kFloatsAbreast, 0.0F);  // whole lines are sent
  glTextureSubImage2D(texture_.name(), 0, 0, 0, 4 * kRowsAbreast, lines, GL_RGBA, GL_FLOAT, values_.data());
  values_.resize(row_count_ * kFloats);
}

}  // namespace shatterbox::render::pass
