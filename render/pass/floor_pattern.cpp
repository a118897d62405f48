#include "render/pass/floor_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace shatterbox::render::pass {
namespace {

constexpr int kBits = 10;  // 2^10 texels of one period
constexpr float kTurn = 6.2831853F;

// 0..1 for a cell of a lattice.
float random_of(int x, int y, unsigned seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U +
                    static_cast<std::uint32_t>(y) * 0x85EBCA77U + seed * 0xC2B2AE3DU;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  return static_cast<float>((h ^ (h >> 15)) >> 8) * (1.0F / 16777216.0F);
}

// Smooth noise, 0..1, of `cells` a period.
float noise(glm::vec2 place, glm::ivec2 cells, unsigned seed) {
  const glm::vec2 p = place * glm::vec2(cells);
  const glm::vec2 whole = glm::floor(p), part = p - whole;
  const glm::vec2 s = part * part * (3.0F - 2.0F * part);
  const int x = static_cast<int>(whole.x), y = static_cast<int>(whole.y);
  const auto cell = [&](int i, int j) {
    return random_of((i % cells.x + cells.x) % cells.x, (j % cells.y + cells.y) % cells.y, seed);
  };
  return glm::mix(glm::mix(cell(x, y), cell(x + 1, y), s.x),
                  glm::mix(cell(x, y + 1), cell(x + 1, y + 1), s.x), s.y);
}

// Eight planks side by side along x, each a period long and with its end where no neighbour's is.
constexpr int kPlanks = 8;

float plank_at(glm::vec2 place) {
  const float across = place.y * kPlanks;
  const int plank = static_cast<int>(across);
  const float joint = 0.37F * static_cast<float>(plank) + 0.2F * random_of(plank, 0, 1U);
  const float from_end = place.x - joint - std::floor(place.x - joint),
              from_side = across - std::floor(across);
  // Metres of a plank of .12 m to its nearest edge.
  const float edge =
      0.12F * std::min({from_side, 1.0F - from_side, kPlanks * from_end, kPlanks * (1.0F - from_end)});
  const float seam = glm::mix(0.45F, 1.0F, glm::smoothstep(0.0004F, 0.0022F, edge));
  const float tint = 0.86F + 0.28F * random_of(plank, 1, 2U);
  // A board is cut at an angle through rings that wander.
  const glm::vec2 own{place.x - joint, place.y};
  const float wander = noise(own, {3, 24}, 3U) + 0.4F * noise(own, {9, 72}, 4U);
  const float rings = std::sin(kTurn * ((2.0F + 3.0F * random_of(plank, 2, 5U)) * from_side + 1.7F * wander));
  const float fibres = noise(own, {24, 256}, 6U), pores = noise(own, {48, 512}, 7U);
  const float grain =
      1.0F + 0.055F * rings * std::abs(rings) + 0.13F * (fibres - 0.5F) + 0.10F * (pores - 0.5F);
  return tint * seam * grain;
}

float concrete_at(glm::vec2 place) {
  float share = 1.0F, weight = 0.09F;
  for (int cells = 4; cells <= 256; cells *= 2, weight *= 0.78F)
    share += weight * (noise(place, {cells, cells}, static_cast<unsigned>(cells)) - 0.5F);
  // Here and there a pore, some millimetres wide.
  constexpr int kPores = 160;
  const glm::vec2 p = place * static_cast<float>(kPores);
  const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
  if (random_of(x, y, 8U) < 0.03F) {
    const glm::vec2 centre{0.3F + 0.4F * random_of(x, y, 9U), 0.3F + 0.4F * random_of(x, y, 10U)};
    const float size = 0.1F + 0.2F * random_of(x, y, 11U);
    const float distance = glm::length(p - glm::vec2(x, y) - centre) / size;
    share *= glm::mix(0.62F, 1.0F, glm::smoothstep(0.6F, 1.0F, distance));
  }
  return share;
}

}  // namespace

FloorPattern::FloorPattern(float units, std::vector<float> finest) : units_(units) {
  const double sum = std::accumulate(finest.begin(), finest.end(), 0.0);
  const auto scale = static_cast<float>(kOne * static_cast<double>(finest.size()) / sum);
  for (float& share : finest) share *= scale;
  for (int bits = kBits; bits >= 0; --bits) {
    Level level{bits, {}};
    for (const float share : finest)
      level.shares.push_back(static_cast<std::uint16_t>(std::clamp(share + 0.5F, 0.0F, 65535.0F)));
    levels_.push_back(std::move(level));
    if (bits == 0) break;
    const std::size_t side = std::size_t{1} << bits;
    std::vector<float> coarse;
    for (std::size_t y = 0; y < side; y += 2) {
      for (std::size_t x = 0; x < side; x += 2) {
        const float* from = finest.data() + y * side + x;
        coarse.push_back(0.25F * (from[0] + from[1] + from[side] + from[side + 1]));
      }
    }
    finest = std::move(coarse);
  }
}

const FloorPattern& FloorPattern::of(GroundPattern pattern) {
  const auto make = [](float units, float (*share_at)(glm::vec2)) {
    constexpr int kSide = 1 << kBits;
    std::vector<float> finest;
    finest.reserve(static_cast<std::size_t>(kSide) * kSide);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        finest.push_back(share_at((glm::vec2(x, y) + 0.5F) / static_cast<float>(kSide)));
    return FloorPattern(units, std::move(finest));
  };
  if (pattern == GroundPattern::planks) {
    static const FloorPattern planks = make(kPlanks, plank_at);
    return planks;
  }
  static const FloorPattern concrete = make(1.0F, concrete_at);
  return concrete;
}

float FloorPattern::depth_of(float footprint) {
  const float texels = footprint * static_cast<float>(1 << kBits);
  return texels > 1.0F ? std::min(std::log2(texels), static_cast<float>(kBits)) : 0.0F;
}

// Between the four nearest texels; a period is 2^32.
unsigned FloorPattern::smooth(const Level& level, std::uint32_t x, std::uint32_t y) {
  if (level.bits == 0) return level.shares.front();
  const int bits = level.bits, rest = 32 - bits;
  const std::uint32_t half = 1U << (rest - 1), mask = (1U << bits) - 1U;
  x -= half;
  y -= half;
  const std::uint32_t left = x >> rest, right = (left + 1U) & mask, part_x = (x << bits) >> 24;
  const std::uint32_t low = y >> rest, high = (low + 1U) & mask, part_y = (y << bits) >> 24;
  const std::uint16_t *below = level.shares.data() + (low << bits),
                      *above = level.shares.data() + (high << bits);
  const std::uint32_t a = below[left] * (256U - part_x) + below[right] * part_x;
  const std::uint32_t b = above[left] * (256U - part_x) + above[right] * part_x;
  return ((a >> 8) * (256U - part_y) + (b >> 8) * part_y) >> 8;
}

void FloorPattern::find_row(glm::dvec2 from, glm::dvec2 step, float depth, float depth_step, int count,
                            std::uint16_t* shares) const {
  constexpr double kPeriod = 4294967296.0;
  const auto turned = [](double periods) {  // whole periods fall off
    return static_cast<std::uint32_t>(static_cast<std::int64_t>((periods - std::floor(periods)) * kPeriod));
  };
  std::uint32_t x = turned(from.x), y = turned(from.y);
  const std::uint32_t step_x = turned(step.x), step_y = turned(step.y);
  for (int k = 0; k < count; ++k, x += step_x, y += step_y, depth += depth_step) {
    const int blend = static_cast<int>(256.0F * std::clamp(depth, 0.0F, static_cast<float>(kBits)));
    const auto number = static_cast<std::size_t>(blend >> 8);
    const auto beyond = static_cast<unsigned>(blend & 255);
    unsigned share = smooth(levels_[number], x, y);
    if (beyond > 0U) share = (share * (256U - beyond) + smooth(levels_[number + 1], x, y) * beyond) >> 8;
    shares[k] = static_cast<std::uint16_t>(share);
  }
}

float checker_at(glm::vec2 place, float footprint) {
  const float width = std::max(footprint, 1e-5F);
  const auto side = [width](float q) {
    const float s = (std::abs(q * 0.5F - std::floor(q * 0.5F) - 0.5F) - 0.25F) * 2.0F;
    return std::clamp(s / width + 0.5F, 0.0F, 1.0F) * 2.0F - 1.0F;
  };
  return 0.86F + 0.14F * side(place.x) * side(place.y) * std::clamp(1.5F - width, 0.0F, 1.0F);
}

}  // namespace shatterbox::render::pass
