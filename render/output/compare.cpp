#include "render/output/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace shatterbox::render {
namespace {

constexpr int kWhiteAt = 64;  // levels
// Wang, Bovik, Sheikh and Simoncelli 2004: a Gaussian window of eleven pixels, sigma 1.5, and the constants
// for 255 levels.
constexpr int kWindowReach = 5;
constexpr double kWindowSigma = 1.5;
constexpr double kLumaConstant = (0.01 * 255.0) * (0.01 * 255.0);
constexpr double kContrastConstant = (0.03 * 255.0) * (0.03 * 255.0);

/// Greatest distance of any channel, levels, pixel by pixel.
std::vector<int> distances(const Image& a, const Image& b) {
  const auto channels = static_cast<std::size_t>(a.channels);
  std::vector<int> most(a.pixels.size() / channels, 0);
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    most[i / channels] = std::max(most[i / channels], std::abs(int{a.pixels[i]} - int{b.pixels[i]}));
  return most;
}

std::vector<double> luma(const Image& image) {
  const auto channels = static_cast<std::size_t>(image.channels);
  std::vector<double> values(image.pixels.size() / channels);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint8_t* const pixel = image.pixels.data() + channels * i;
    values[i] = 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2];
  }
  return values;
}

/// Gaussian mean about each pixel; at the border of the picture, of the part of the window that lies in it.
std::vector<double> smooth(const std::vector<double>& values, int width, int height) {
  std::array<double, 2 * kWindowReach + 1> weights{};
  for (int k = -kWindowReach; k <= kWindowReach; ++k)
    weights[static_cast<std::size_t>(k + kWindowReach)] =
        std::exp(-0.5 * k * k / (kWindowSigma * kWindowSigma));
  const auto along = [&](const std::vector<double>& from, int length, int lines, std::size_t step,
                         std::size_t line_step) {
    std::vector<double> to(from.size());
    for (int line = 0; line < lines; ++line)
      for (int i = 0; i < length; ++i) {
        double sum = 0.0, weight = 0.0;
        for (int k = std::max(0, i - kWindowReach); k <= std::min(length - 1, i + kWindowReach); ++k) {
          const double w = weights[static_cast<std::size_t>(k - i + kWindowReach)];
          sum += w * from[static_cast<std::size_t>(line) * line_step + static_cast<std::size_t>(k) * step];
          weight += w;
        }
        to[static_cast<std::size_t>(line) * line_step + static_cast<std::size_t>(i) * step] = sum / weight;
      }
    return to;
  };
  const auto row = static_cast<std::size_t>(width);
  return along(along(values, width, height, 1, row), height, width, row, 1);
}

std::vector<double> products(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  std::transform(a.begin(), a.end(), b.begin(), out.begin(), [](double x, double y) { return x * y; });
  return out;
}

double structural_similarity(const Image& a, const Image& b) {
  const std::vector<double> x = luma(a), y = luma(b);
  const auto mean_of = [&](const std::vector<double>& values) { return smooth(values, a.width, a.height); };
  const std::vector<double> mx = mean_of(x), my = mean_of(y);
  const std::vector<double> xx = mean_of(products(x, x)), yy = mean_of(products(y, y)),
                            xy = mean_of(products(x, y));
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double variance_x = xx[i] - mx[i] * mx[i], variance_y = yy[i] - my[i] * my[i];
    const double covariance = xy[i] - mx[i] * my[i];
    sum += (2.0 * mx[i] * my[i] + kLumaConstant) * (2.0 * covariance + kContrastConstant) /
           ((mx[i] * mx[i] + my[i] * my[i] + kLumaConstant) * (variance_x + variance_y + kContrastConstant));
  }
  return sum / static_cast<double>(x.size());
}

/// The most pixels beyond the tolerance that touch each other, corners included.
long largest_cluster(const std::vector<int>& distance, int width, int height, int tolerance) {
  std::vector<char> is_open(distance.size());
  std::transform(distance.begin(), distance.end(), is_open.begin(),
                 [&](int d) { return static_cast<char>(d > tolerance); });
  long largest = 0;
  std::vector<std::size_t> waiting;
  for (std::size_t first = 0; first < is_open.size(); ++first) {
    if (is_open[first] == 0) continue;
    long size = 0;
    is_open[first] = 0;
    waiting.push_back(first);
    while (!waiting.empty()) {
      const int x = static_cast<int>(waiting.back()) % width, y = static_cast<int>(waiting.back()) / width;
      waiting.pop_back();
      ++size;
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
          const std::size_t next =
              static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
          if (is_open[next] == 0) continue;
          is_open[next] = 0;
          waiting.push_back(next);
        }
    }
    largest = std::max(largest, size);
  }
  return largest;
}

std::uint8_t level(double value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5);
}

}  // namespace

Difference compare(const Image& a, const Image& b, int tolerance) {
  Difference out;
  out.same_size = a.width == b.width && a.height == b.height && a.channels == b.channels;
  if (!out.same_size || a.pixels.empty()) return out;
  if (a.pixels == b.pixels) {
    out.psnr = std::numeric_limits<double>::infinity();
    out.ssim = 1.0;
    return out;
  }
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const int d = std::abs(int{a.pixels[i]} - int{b.pixels[i]});
    sum += d;
    squares += static_cast<double>(d) * d;
  }
  const auto values = static_cast<double>(a.pixels.size());
  out.mean = sum / values;
  out.psnr = 10.0 * std::log10(255.0 * 255.0 * values / squares);
  out.ssim = structural_similarity(a, b);
  const std::vector<int> distance = distances(a, b);
  out.most = *std::max_element(distance.begin(), distance.end());
  out.pixels_beyond = std::count_if(distance.begin(), distance.end(), [&](int d) { return d > tolerance; });
  out.share_beyond = static_cast<double>(out.pixels_beyond) / static_cast<double>(distance.size());
  out.largest_cluster = largest_cluster(distance, a.width, a.height, tolerance);
  return out;
}

Image difference_picture(const Image& a, const Image& b, int tolerance) {
  Image picture(a.width, a.height);
  const std::vector<int> distance = distances(a, b);
  const std::vector<double> grey = luma(a);
  for (std::size_t i = 0; i < distance.size(); ++i) {
    std::uint8_t* const pixel = picture.pixels.data() + 3 * i;
    const double dim = 0.3 * grey[i];
    if (distance[i] > tolerance) {
      // Red, then yellow, then white, like something that glows.
      const double heat = std::min(1.0, static_cast<double>(distance[i]) / kWhiteAt);
      pixel[0] = 255;
      pixel[1] = level(510.0 * heat);
      pixel[2] = level(510.0 * heat - 255.0);
    } else {
      pixel[0] = pixel[1] = level(dim);
      pixel[2] = level(distance[i] > 0 ? dim + 120.0 : dim);
    }
  }
  return picture;
}

}  // namespace shatterbox::render
