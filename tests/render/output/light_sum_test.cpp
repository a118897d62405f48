#include "render/output/light_sum.h"

#include <catch2/catch.hpp>

using namespace shatterbox::render;

namespace {

Image grey(int width, std::uint8_t code) {
  Image image(width, 4);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<std::uint8_t>(code + i % 7);
  return image;
}

}  // namespace

TEST_CASE("the mean of equal pictures is that picture to the byte") {
  for (const int count : {1, 2, 3, 16, 100}) {
    LightSum sum;
    for (int i = 0; i < count; ++i) sum.add(grey(64, 30));
    CHECK(sum.mean() == grey(64, 30));
  }
}

TEST_CASE("light is averaged and not its codes") {
  LightSum sum;
  sum.add(Image(2, 2));
  Image white(2, 2);
  for (auto& code : white.pixels) code = 255;
  sum.add(white);
  CHECK(int(sum.mean().pixels[0]) == 188);  // half of the light, by the sRGB curve
  sum.add(white);
  sum.add(white);
  CHECK(int(sum.mean().pixels[5]) == 225);  // three quarters
}

TEST_CASE("a picture of another size is refused") {
  LightSum sum;
  sum.add(grey(8, 1));
  CHECK_THROWS_AS(sum.add(grey(9, 1)), std::invalid_argument);
}
