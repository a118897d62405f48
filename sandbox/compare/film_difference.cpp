#include "sandbox/compare/film_difference.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "render/output/image_file.h"

namespace shatterbox::sandbox::compare {

namespace {

std::string file_name(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return std::filesystem::path(name).replace_extension(".png").string();
}

/// One of a subfolder goes to a subfolder.
render::Status write_picture(const std::filesystem::path& file, const render::Image& picture) {
  std::error_code code;
  std::filesystem::create_directories(file.parent_path(), code);
  return code ? render::Status{file.parent_path().string() + ": " + code.message()}
              : render::write_png(file, picture);
}

/// Puts the pictures of two films side by side.
class Pairing {
 public:
  Pairing(Film& expected, Film& actual)
      : expected_(expected), actual_(actual), is_by_name_(expected.has_names() && actual.has_names()) {
    expected_shot_ = expected_.next();
    actual_shot_ = actual_.next();
  }

  struct Pair {
    std::optional<Film::Shot> expected, actual;
  };
  /// Neither is there: it is over.
  Pair next() {
    const bool has_both = expected_shot_ && actual_shot_;
    const bool takes_expected = !has_both || !is_by_name_ || expected_shot_->name <= actual_shot_->name;
    const bool takes_actual = !has_both || !is_by_name_ || actual_shot_->name <= expected_shot_->name;
    Pair pair;
    if (takes_expected) pair.expected = std::exchange(expected_shot_, expected_.next());
    if (takes_actual) pair.actual = std::exchange(actual_shot_, actual_.next());
    return pair;
  }

 private:
  Film &expected_, &actual_;
  bool is_by_name_;
  std::optional<Film::Shot> expected_shot_, actual_shot_;
};

}  // namespace

bool FilmDifference::is_same() const {
  return error.empty() && differing() == 0;
}

long FilmDifference::differing() const {
  return std::count_if(frames.begin(), frames.end(), [](const auto& frame) { return !frame.excess.empty(); });
}

const FrameDifference* FilmDifference::first() const {
  const auto found =
      std::find_if(frames.begin(), frames.end(), [](const auto& frame) { return !frame.excess.empty(); });
  return found == frames.end() ? nullptr : &*found;
}

FilmDifference compare_films(Film& expected, Film& actual, const Tolerance& tolerance,
                             const std::string& pictures_folder) {
  FilmDifference result;
  long most_beyond = -1;
  Pairing pairing(expected, actual);
  for (;;) {
    const auto [a, b] = pairing.next();
    if (!expected.error().empty() || !actual.error().empty()) break;
    if (!a && !b) break;
    FrameDifference frame;
    frame.name = a ? a->name : b->name;
    if (!a) frame.excess = "there is no such picture among the expected ones";
    if (!b) frame.excess = "the picture is missing";
    if (a && b) {
      frame.difference = render::compare(a->image, b->image, tolerance.levels);
      frame.excess = find_excess(frame.difference, tolerance);
      if (!frame.difference.same_size)
        frame.excess = fmt::format("{} x {} pixels, {} channels, instead of {} x {}, {}", b->image.width,
                                   b->image.height, b->image.channels, a->image.width, a->image.height,
                                   a->image.channels);
    }
    if (!frame.excess.empty() && frame.difference.same_size) {
      render::Image picture = render::difference_picture(a->image, b->image, tolerance.levels);
      if (!pictures_folder.empty()) {
        const auto status =
            write_picture(std::filesystem::path(pictures_folder) / file_name(frame.name), picture);
        if (!status) result.error = status.error;
      }
      if (frame.difference.pixels_beyond > most_beyond) {
        most_beyond = frame.difference.pixels_beyond;
        result.worst = frame.name;
        result.worst_picture = std::move(picture);
      }
    }
    result.frames.push_back(std::move(frame));
  }
  for (const Film* film : {&expected, &actual})
    if (!film->error().empty()) result.error = film->error();
  return result;
}

}  // namespace shatterbox::sandbox::compare
