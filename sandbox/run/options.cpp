#include "sandbox/run/options.h"

#include <unistd.h>

#include <charconv>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "render/output/video_file.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;

/// Why no file of that name can be written, or empty.
std::string file_fault(const std::string& file) {
  std::error_code code;
  const fs::path path(file);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (fs::is_directory(path, code)) return "is a folder";
  // It is written beside itself and takes the name when it is whole: a device or a pipe would be gone.
  if (fs::exists(path, code) && !fs::is_regular_file(path, code)) return "is no plain file";
  if (!fs::is_directory(folder, code)) return fmt::format("there is no folder {}", folder.string());
  if (access(folder.c_str(), W_OK) != 0)
    return fmt::format("folder {}: {}", folder.string(), std::strerror(errno));
  if (fs::exists(path, code) && access(path.c_str(), W_OK) != 0) return std::strerror(errno);
  return {};
}

}  // namespace

std::optional<render::Size> parse_size(const std::string& text, scene::Problems& problems) {
  render::Size size;
  const char* const end = text.data() + text.size();
  const auto [cross, fault] = std::from_chars(text.data(), end, size.width);
  bool is_good = fault == std::errc() && cross != end && *cross == 'x';
  if (is_good) {
    const auto [rest, second_fault] = std::from_chars(cross + 1, end, size.height);
    is_good = second_fault == std::errc() && rest == end;
  }
  const auto fits = [](int side) { return side >= 16 && side <= 8192 && side % 2 == 0; };
  if (is_good && fits(size.width) && fits(size.height)) return size;
  scene::book(problems, scene::Place{"--size", 0, 0}, fmt::format("\"{}\" is no picture size", text),
              "write WIDTHxHEIGHT, for example 640x360: even numbers from 16 to 8192");
  return std::nullopt;
}

render::Quality parse_quality(const std::string& text) {
  return text == "full" ? render::Quality::full : render::Quality::preview;
}

render::BackEnd parse_back_end(const std::string& text, scene::Problems& problems) {
  render::BackEnd back_end = render::BackEnd::usual;
  if (!text.empty()) back_end = text == "egl" ? render::BackEnd::egl : render::BackEnd::osmesa;
  if (const std::string fault = render::back_end_fault(back_end); !fault.empty())
    scene::book(problems, scene::Place{"--gl", 0, 0}, fault);
  return back_end;
}

scene::SceneChanges changes_of(const Options& options) {
  scene::SceneChanges changes;
  changes.overrides = options.overrides;
  if (options.seconds) changes.overrides.push_back(fmt::format("scene.seconds={:.17g}", *options.seconds));
  if (options.seed) changes.overrides.push_back(fmt::format("scene.seed={}", *options.seed));
  changes.script_file = options.script;
  return changes;
}

void check_file(const char* option, const std::string& file, scene::Problems& problems) {
  if (file.empty()) return;
  const std::string fault = file_fault(file);
  if (!fault.empty())
    scene::book(problems, scene::Place{option, 0, 0}, fmt::format("{} cannot be written: {}", file, fault),
                "");
}

void make_folder(const char* option, const std::string& folder, scene::Problems& problems) {
  if (folder.empty()) return;
  std::error_code code;
  fs::create_directories(folder, code);
  if (code || !fs::is_directory(folder)) {
    scene::book(problems, scene::Place{option, 0, 0},
                fmt::format("folder {} cannot be made: {}", folder, code ? code.message() : "it is a file"));
  } else if (access(folder.c_str(), W_OK) != 0) {
    scene::book(problems, scene::Place{option, 0, 0},
                fmt::format("folder {}: {}", folder, std::strerror(errno)), "");
  }
}

void prepare_outputs(const Options& options, scene::Problems& problems) {
  if (!options.video.empty()) {
    const render::Status status = render::can_write_video(options.video);
    if (!status) scene::book(problems, scene::Place{"-o", 0, 0}, status.error, "");
  }
  check_file("-o", options.video, problems);
  check_file("--report", options.report, problems);
  if (options.has_trace && options.report.empty())
    scene::book(problems, scene::Place{"--trace", 0, 0}, "is kept in the report, and none is asked for",
                "add --report FILE");
  make_folder("--frames", options.frames_folder, problems);
}

}  // namespace shatterbox::sandbox::run
