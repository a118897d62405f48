// A picture in memory: 8 bits a channel, sRGB-encoded, row 0 on top, no padding.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace shatterbox::render {

struct Image {
  int width = 0, height = 0;
  int channels = 3;  // 3: RGB, 4: RGBA
  std::vector<std::uint8_t> pixels;

  Image() = default;
  Image(int width_, int height_, int channels_ = 3)
      : width(width_),
        height(height_),
        channels(channels_),
        pixels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
               static_cast<std::size_t>(channels_)) {}

  std::uint8_t* at(int x, int y) { return pixels.data() + offset(x, y); }
  const std::uint8_t* at(int x, int y) const { return pixels.data() + offset(x, y); }
  bool operator==(const Image&) const = default;

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

}  // namespace shatterbox::render
