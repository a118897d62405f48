#include "render/output/light_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace shatterbox::render {
namespace {

const std::array<float, 256>& lights() {
  static const std::array<float, 256> made = [] {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < table.size(); ++code) {
      const double c = static_cast<double>(code) / 255.0;
      table[code] = static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return table;
  }();
  return made;
}

// The code whose light is nearest.
std::uint8_t code_of(float light) {
  const auto above = std::lower_bound(lights().begin(), lights().end(), light);
  if (above == lights().end()) return 255;
  const auto code = static_cast<int>(above - lights().begin());
  if (code == 0 || *above - light <= light - *(above - 1)) return static_cast<std::uint8_t>(code);
  return static_cast<std::uint8_t>(code - 1);
}

}  // namespace

void LightSum::add(const Image& image) {
  if (count_++ == 0) {
    first_ = image;
    sums_.assign(image.pixels.size(), 0.0F);
  }
  if (image.width != first_.width || image.height != first_.height || image.channels != first_.channels)
    throw std::invalid_argument("LightSum::add: a picture of another size");
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += lights()[image.pixels[i]];
}

Image LightSum::mean() const {
  Image out = first_;
  if (count_ < 2) return out;
  const float share = 1.0F / static_cast<float>(count_);
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const float light = sums_[i] * share, as_first = lights()[first_.pixels[i]];
    // What is the same in all of them needs no search.
    if (std::abs(light - as_first) > 1e-6F * as_first + 1e-9F) out.pixels[i] = code_of(light);
  }
  return out;
}

}  // namespace shatterbox::render
