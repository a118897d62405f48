// PNG keeps every bit; failures are sentences; distances between pictures are what they say.
#include "render/output/image_file.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "render/output/compare.h"

using namespace shatterbox::render;

namespace {
Image noise(int width, int height, int channels) {
  Image image(width, height, channels);
  unsigned state = 12345;
  for (auto& value : image.pixels)
    value = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24U);
  return image;
}
}  // namespace

TEST_CASE("a PNG comes back bit for bit") {
  const auto path = std::filesystem::temp_directory_path() / "shatterbox_round_trip.png";
  for (const int channels : {3, 4}) {
    const Image image = noise(37, 23, channels);
    REQUIRE(write_png(path, image).ok());
    const auto back = read_image(path);
    REQUIRE(back);
    CHECK(*back == image);
  }
  std::filesystem::remove(path);
}

TEST_CASE("a picture that cannot be written or read says so") {
  const Status status = write_png("/nowhere/at/all/x.png", noise(4, 4, 3));
  CHECK_FALSE(status.ok());
  CHECK(status.error.find("/nowhere/at/all/x.png") != std::string::npos);
  CHECK_FALSE(write_png("/tmp/x.png", Image()).ok());
  std::string error;
  CHECK_FALSE(read_image("/nowhere.png", &error));
  CHECK_FALSE(error.empty());
}

TEST_CASE("compare measures what it names") {
  const Image a = noise(10, 10, 3);
  Image b = a;
  CHECK(std::isinf(compare(a, b).psnr));
  b.at(3, 4)[1] = static_cast<std::uint8_t>(a.at(3, 4)[1] ^ 128U);
  const Difference d = compare(a, b);
  CHECK(d.most == 128);
  CHECK(d.pixels_beyond == 1);
  CHECK(d.share_beyond == Approx(0.01));
  CHECK(d.mean == Approx(128.0 / 300.0));
  CHECK(d.psnr == Approx(10.0 * std::log10(255.0 * 255.0 * 300.0 / (128.0 * 128.0))));
  CHECK_FALSE(compare(a, noise(9, 10, 3)).same_size);
}
