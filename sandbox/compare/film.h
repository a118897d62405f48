// Pictures one after the other, wherever they are kept: a PNG, a folder of PNGs, or a video.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/output/image.h"
#include "render/output/video_reader.h"

namespace shatterbox::sandbox::compare {

class Film {
 public:
  /// The PNGs of a folder and of those in it come in the order of their names. error() says what cannot be
  /// read.
  explicit Film(std::filesystem::path path);

  struct Shot {
    std::string name;  // the file's, seen from the folder ("sub/1.png"), or "frame 12" of a video
    render::Image image;
  };
  /// The next picture; nothing after the last one, or once error() is not empty.
  std::optional<Shot> next();
  const std::string& error() const { return error_; }
  /// Whether pictures are told apart by their names (a folder) or by their place (a video, a single one).
  bool has_names() const { return has_names_; }

 private:
  std::string name_of(const std::filesystem::path& file) const;

  std::filesystem::path path_;
  std::vector<std::filesystem::path> files_;  // PNGs
  std::unique_ptr<render::VideoReader> video_;
  std::size_t count_ = 0;
  bool has_names_ = false;
  std::string error_;
};

}  // namespace shatterbox::sandbox::compare
