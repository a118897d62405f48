// Distances between pictures are what they say: clusters, similarity, and the picture of a difference.
#include "render/output/compare.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace shatterbox::render;

namespace {

Image grey(int width, int height, std::uint8_t level) {
  Image image(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), level);
  return image;
}

void mark(Image& image, int x, int y, std::uint8_t level) {
  for (int c = 0; c < 3; ++c) image.at(x, y)[c] = level;
}

}  // namespace

TEST_CASE("the largest cluster counts pixels that touch, corners included, beyond the tolerance only") {
  const Image a = grey(20, 10, 100);
  Image b = a;
  mark(b, 2, 2, 110);
  mark(b, 3, 3, 110);
  mark(b, 4, 2, 110);
  mark(b, 5, 3, 102);  // within the tolerance: no bridge
  mark(b, 6, 2, 110);
  mark(b, 0, 9, 110);  // the picture's edge does not go round
  mark(b, 19, 9, 110);
  const Difference d = compare(a, b, 2);
  CHECK(d.pixels_beyond == 6);
  CHECK(d.largest_cluster == 3);
  CHECK(compare(a, b, 1).largest_cluster == 5);
  CHECK(compare(a, b, 10).largest_cluster == 0);
}

TEST_CASE("structural similarity has its closed forms") {
  // Two plain pictures: variances vanish, what is left is (2 x y + c) / (x^2 + y^2 + c).
  const double c = (0.01 * 255.0) * (0.01 * 255.0);
  const Difference plain = compare(grey(24, 16, 100), grey(24, 16, 120));
  CHECK(plain.ssim == Approx((2.0 * 100.0 * 120.0 + c) / (100.0 * 100.0 + 120.0 * 120.0 + c)).epsilon(1e-9));
  // A picture and its negative about the mean: the covariance is minus the variance.
  Image a = grey(32, 32, 0), b = a;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool is_light = (x + y) % 2 == 0;
      mark(a, x, y, is_light ? 178 : 78);
      mark(b, x, y, is_light ? 78 : 178);
    }
  CHECK(compare(a, b).ssim < -0.9);
  CHECK(compare(a, a).ssim == 1.0);
}

TEST_CASE("the picture of a difference: dim where equal, bluish within the tolerance, glowing beyond") {
  const Image a = grey(8, 8, 100);
  Image b = a;
  mark(b, 1, 1, 102);
  mark(b, 2, 2, 110);
  mark(b, 3, 3, 255);
  const Image picture = difference_picture(a, b, 2);
  const auto pixel = [&](int at) { return picture.at(at, at); };
  CHECK(pixel(0)[0] == pixel(0)[2]);
  CHECK(pixel(0)[0] < 50);
  CHECK(pixel(1)[2] > pixel(1)[0] + 100);
  CHECK(pixel(2)[0] == 255);
  CHECK(pixel(2)[2] == 0);
  CHECK(pixel(3)[2] == 255);
}
