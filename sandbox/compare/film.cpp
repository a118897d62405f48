#include "sandbox/compare/film.h"

#include <algorithm>

#include <fmt/format.h>

#include "render/output/ending.h"
#include "render/output/image_file.h"

namespace shatterbox::sandbox::compare {

namespace {

namespace fs = std::filesystem;

}  // namespace

Film::Film(fs::path path) : path_(std::move(path)) {
  std::error_code code;
  if (!fs::exists(path_, code)) {
    error_ = fmt::format("{}: there is no such file or folder", path_.string());
  } else if (fs::is_directory(path_, code)) {
    has_names_ = true;
    std::error_code ignored;
    auto entry =
        fs::recursive_directory_iterator(path_, fs::directory_options::follow_directory_symlink, code);
    for (; !code && entry != fs::recursive_directory_iterator(); entry.increment(code))
      if (entry->is_regular_file(ignored) && render::lower_case_ending(entry->path()) == ".png")
        files_.push_back(entry->path());
    std::sort(files_.begin(), files_.end(),
              [this](const fs::path& a, const fs::path& b) { return name_of(a) < name_of(b); });
    if (code) error_ = fmt::format("{}: {}", path_.string(), code.message());
    if (!code && files_.empty()) error_ = fmt::format("{}: the folder holds no PNG", path_.string());
  } else if (render::lower_case_ending(path_) == ".png") {
    files_.push_back(path_);
  } else {
    video_ = std::make_unique<render::VideoReader>(path_);
    if (!video_->status().ok())
      error_ = video_->status().error + " (a PNG, a folder of PNGs or a video is wanted)";
  }
}

std::optional<Film::Shot> Film::next() {
  if (!error_.empty()) return std::nullopt;
  if (video_) {
    auto image = video_->next();
    if (!video_->status().ok())
      error_ = fmt::format("{}, after {} frames: {}", path_.string(), count_, video_->status().error);
    if (!image || !error_.empty()) return std::nullopt;
    return Shot{fmt::format("frame {}", count_++), std::move(*image)};
  }
  if (count_ == files_.size()) return std::nullopt;
  const fs::path& file = files_[count_++];
  auto image = render::read_image(file, &error_);
  if (!image) return std::nullopt;
  return Shot{name_of(file), std::move(*image)};
}

std::string Film::name_of(const fs::path& file) const {
  return has_names_ ? file.lexically_relative(path_).generic_string() : file.filename().string();
}

}  // namespace shatterbox::sandbox::compare
