#include "sandbox/run/options.h"

#include <charconv>

#include <fmt/format.h>

#include "render/output/video_file.h"

namespace shatterbox::sandbox::run {

std::optional<render::Size> parse_size(const std::string& text, scene::Problems& problems) {
  render::Size size;
  const char* const end = text.data() + text.size();
  const auto [cross, fault] = std::from_chars(text.data(), end, size.width);
  bool is_good = fault == std::errc() && cross != end && (*cross == 'x' || *cross == 'X');
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

void check_video(const std::string& file, scene::Problems& problems) {
  if (file.empty()) return;
  const render::Status status = render::can_write_video(file);
  if (!status) scene::book(problems, scene::Place{"-o", 0, 0}, status.error, "");
}

}  // namespace shatterbox::sandbox::run
