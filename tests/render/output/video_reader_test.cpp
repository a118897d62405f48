// What was written comes back, frame by frame; what is no video says so.
#include "render/output/video_reader.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "render/output/compare.h"
#include "render/output/video_file.h"

using namespace shatterbox::render;

namespace {

namespace fs = std::filesystem;

constexpr int kSquareFrames = 9;

/// A square that moves over a gradient.
Image picture(int number) {
  Image image(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool is_in = x > 4 * number && x < 4 * number + 16 && y > 16 && y < 32;
      image.at(x, y)[0] = static_cast<std::uint8_t>(is_in ? 220 : 2 * x);
      image.at(x, y)[1] = static_cast<std::uint8_t>(is_in ? 60 : 3 * y);
      image.at(x, y)[2] = static_cast<std::uint8_t>(is_in ? 40 : 120);
    }
  return image;
}

}  // namespace

TEST_CASE("every frame of a video comes back, in order, with its colours") {
  for (const char* ending : {".mp4", ".mkv", ".webm", ".gif"}) {
    INFO(ending);
    const fs::path path =
        fs::temp_directory_path() / ("shatterbox_reader_" + std::to_string(getpid()) + ending);
    VideoFile file(path, {64, 48, 25, 12.0});
    for (int i = 0; i < kSquareFrames; ++i) REQUIRE(file.add(picture(i)));
    REQUIRE(file.close());
    VideoReader reader(path);
    REQUIRE(reader.status());
    int count = 0;
    while (const auto image = reader.next()) {
      INFO("frame " << count);
      REQUIRE(image->width == 64);
      CHECK(compare(picture(count), *image).psnr > 25.0);
      if (count > 0) CHECK(compare(picture(count - 1), *image).psnr < 25.0);
      ++count;
    }
    CHECK(reader.status());
    CHECK(count == kSquareFrames);
    fs::remove(path);
  }
}

TEST_CASE("what is no video is refused with a sentence") {
  const fs::path path = fs::temp_directory_path() / ("shatterbox_no_video_" + std::to_string(getpid()));
  std::ofstream(path) << "this is not a video\n";
  VideoReader reader(path);
  CHECK_FALSE(reader.status());
  CHECK(reader.status().error.find(path.string()) != std::string::npos);
  CHECK_FALSE(reader.next());
  CHECK_FALSE(VideoReader("/nowhere/at/all.mp4").status());
  fs::remove(path);
}
