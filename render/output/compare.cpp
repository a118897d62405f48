#include "render/output/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace shatterbox::render {

Difference compare(const Image& a, const Image& b, int tolerance) {
  Difference out;
  out.same_size = a.width == b.width && a.height == b.height && a.channels == b.channels;
  if (!out.same_size || a.pixels.empty()) return out;
  double sum = 0, squares = 0;
  const auto channels = static_cast<std::size_t>(a.channels);
  for (std::size_t i = 0; i < a.pixels.size(); i += channels) {
    int most = 0;
    for (std::size_t c = 0; c < channels; ++c) {
      const int d = std::abs(int{a.pixels[i + c]} - int{b.pixels[i + c]});
      sum += d;
      squares += static_cast<double>(d) * d;
      most = std::max(most, d);
    }
    out.most = std::max(out.most, most);
    if (most > tolerance) ++out.pixels_beyond;
  }
  const auto values = static_cast<double>(a.pixels.size());
  out.mean = sum / values;
  out.share_beyond = static_cast<double>(out.pixels_beyond) * static_cast<double>(channels) / values;
  out.psnr = squares == 0 ? std::numeric_limits<double>::infinity()
                          : 10.0 * std::log10(255.0 * 255.0 * values / squares);
  return out;
}

}  // namespace shatterbox::render
