// The pictures of a video, one after the other, as any player shows them.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>

#include "render/output/image.h"
#include "render/output/status.h"

namespace shatterbox::render {

class VideoReader {
 public:
  // Any file that FFmpeg reads. Never throws: status() says what is wrong, and next() then gives nothing.
  explicit VideoReader(const std::filesystem::path& path);
  ~VideoReader();
  VideoReader(const VideoReader&) = delete;
  VideoReader& operator=(const VideoReader&) = delete;

  // The next picture, RGB; nothing after the last one, or once status() is not fine.
  std::optional<Image> next();
  Status status() const;

 private:
  struct Decoder;
  std::unique_ptr<Decoder> decoder_;
};

}  // namespace shatterbox::render
