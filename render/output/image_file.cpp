#include "render/output/image_file.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
// The library's static functions that nobody calls are no fault of ours.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <cstdlib>
#include <mutex>
#include <string>

#include "render/output/deflate.h"
#include "render/output/whole_file.h"

namespace shatterbox::render {
namespace {

void append_bytes(void* out, void* bytes, int count) {
  static_cast<std::string*>(out)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(count));
}

// Level 4 with the Up filter: faster and smaller on rendered pictures than stb's own choice. Its settings are
// globals.
std::string encode_png(const Image& image) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  stbi_write_png_compression_level = 4;
  stbi_write_force_png_filter = 2;
  std::string bytes;
  stbi_write_png_to_func(append_bytes, &bytes, image.width, image.height, image.channels, image.pixels.data(),
                         image.width * image.channels);
  return bytes;
}

}  // namespace

std::string deflate(const std::string& bytes) {
  constexpr int kQuality = 5;  // the least that stb knows
  int size = 0;
  std::string in = bytes;  // it is only read, but not said to be const
  unsigned char* packed = stbi_zlib_compress(reinterpret_cast<unsigned char*>(in.data()),
                                             static_cast<int>(in.size()), &size, kQuality);
  // Between zlib's two bytes of head and its four of sum.
  std::string out(reinterpret_cast<const char*>(packed) + 2, static_cast<std::size_t>(size) - 6);
  std::free(packed);
  return out;
}

Status write_png(const std::filesystem::path& path, const Image& image) {
  if (image.width <= 0 || image.height <= 0 || image.pixels.empty()) {
    return {path.string() + ": the picture is empty"};
  }
  const std::string bytes = encode_png(image);
  if (bytes.empty()) return {path.string() + ": the picture cannot be encoded"};
  return write_whole_file(path, bytes);
}

std::optional<Image> read_image(const std::filesystem::path& path, std::string* error) {
  int width = 0, height = 0, channels = 0;
  if (stbi_info(path.c_str(), &width, &height, &channels) == 0) {
    if (error != nullptr) *error = path.string() + ": " + stbi_failure_reason();
    return std::nullopt;
  }
  const int wanted = channels == 4 || channels == 2 ? 4 : 3;
  stbi_uc* bytes = stbi_load(path.c_str(), &width, &height, &channels, wanted);
  if (bytes == nullptr) {
    if (error != nullptr) *error = path.string() + ": " + stbi_failure_reason();
    return std::nullopt;
  }
  Image image(width, height, wanted);
  image.pixels.assign(bytes, bytes + image.pixels.size());
  stbi_image_free(bytes);
  return image;
}

}  // namespace shatterbox::render
