#include "sandbox/run/rendering.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/clock.h"
#include "sandbox/recording/recording_reader.h"
#include "sandbox/report/json_report.h"
#include "sandbox/report/text_file.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/job.h"
#include "sandbox/run/painter.h"
#include "sandbox/run/progress.h"
#include "sandbox/scene/overrides.h"
#include "sandbox/scene/read_picture.h"
#include "sandbox/view/to_glm.h"

namespace shatterbox::sandbox::run {

namespace {

using recording::RecordingReader;

/// A number of a frame; `otherwise` if the text is empty, negative if it is none.
int frame_number(std::string_view text, int otherwise) {
  if (text.empty()) return otherwise;
  int number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  return fault == std::errc() && end == text.data() + text.size() ? number : -1;
}

void check_outputs(const RenderOptions& options, Outputs& outputs, scene::Problems& problems) {
  if ((options.video + options.pictures_folder + options.truth_folder + options.report).empty())
    scene::book(problems, scene::Place{"render", 0, 0}, "no output is asked for",
                "ask for one: -o FILE, --pictures DIR, --truth DIR or --report FILE");
  check_video(options.video, problems);
  outputs.read_file("RECORDING", options.recording);
  outputs.write_file("-o", options.video);
  outputs.write_folder("--pictures", options.pictures_folder, {"frame_*.png"});
  outputs.write_folder("--truth", options.truth_folder, {"truth_*.npz"});
  outputs.write_file("--report", options.report);
  outputs.check(problems);
}

PainterSettings painter_settings(const RenderOptions& options, const recording::Settings& recorded,
                                 scene::Problems& problems) {
  PainterSettings settings;
  settings.size = {static_cast<int>(recorded.width), static_cast<int>(recorded.height)};
  if (!options.size.empty())
    if (const auto size = parse_size(options.size, problems)) settings.size = *size;
  settings.quality = recorded.quality;
  if (!options.quality.empty()) settings.quality = parse_quality(options.quality);
  settings.back_end = parse_back_end(options.gl, problems);
  settings.panels = static_cast<int>(recorded.panels);
  settings.frames_per_second = static_cast<int>(recorded.frames_per_second);
  settings.video = options.video;
  settings.frames_folder = options.pictures_folder;
  settings.truth_folder = options.truth_folder;
  settings.has_pass_times = !options.report.empty();
  if (settings.panels > 1 && !options.truth_folder.empty())
    scene::book(problems, scene::Place{"--truth", 0, 0}, "holds one world, and this recording shows several",
                "leave it out");
  return settings;
}

constexpr const char* kOtherEye =
    "for example --set camera.position=[1,1,3] --set camera.target=[0,0,0]; else run the scene again";

/// An eye in place of the recorded one.
struct Eye {
  glm::vec3 position, target, up;
  std::optional<float> fov;  // degrees; nothing: as recorded

  void take_over(render::Camera& camera) const {
    camera = {position, target, up, fov.value_or(camera.vertical_fov)};
  }
};

/// Nothing if no other is asked for, or with problems.
std::optional<Eye> read_eye(const std::vector<std::string>& changes, scene::Problems& problems) {
  scene::TomlValue tree;
  for (const std::string& change : changes) {
    if (change.rfind("camera.", 0) == 0)
      scene::apply_override(tree, change, problems);
    else
      scene::book(problems, scene::Place{"--set " + change, 0, 0},
                  "of a recording the camera alone can be another", kOtherEye);
  }
  const scene::TomlValue* table = tree.find("camera");
  if (table == nullptr || !problems.empty()) return std::nullopt;
  for (const auto& [key, value] : table->entries)
    if (key != "position" && key != "target" && key != "up" && key != "fov")
      scene::book(problems, value.place, "the camera of a recording has a position, target, up and fov alone",
                  "leave " + key + " out, or run the scene again");
  if (!problems.empty()) return std::nullopt;
  scene::SceneDescription scene;
  scene::read_camera(*table, scene, problems);
  const scene::CameraEntry& camera = scene.camera;
  if (problems.empty() && (!camera.position || !camera.target))
    scene::book(problems, table->entries.front().value.place, "another camera needs a position and a target",
                kOtherEye);
  if (!problems.empty()) return std::nullopt;
  Eye eye{view::to_glm(*camera.position), view::to_glm(*camera.target), view::to_glm(camera.up),
          std::nullopt};
  if (table->find("fov") != nullptr) eye.fov = static_cast<float>(camera.fov);
  return eye;
}

/// The frames from `first` to before `end`, all or until Ctrl-C. A sentence if it failed, else empty.
std::string paint_frames(RecordingReader& reader, int first, int end, const std::optional<Eye>& eye,
                         Painter& painter) {
  Progress progress(end - first, stderr_is_terminal());
  for (int number = first; number < end && !is_interrupted(); ++number) {
    auto panels = reader.read(number);
    for (std::vector<render::Frame>& samples : panels)
      for (render::Frame& frame : samples)
        if (eye) eye->take_over(frame.camera);
    if (!painter.add(std::move(panels), number)) return painter.error();
    progress.show(painter.finished_frames(), fmt::format("frame {}", number));
  }
  return painter.finish() ? std::string() : painter.error();
}

std::string write_rendering(const RenderOptions& options, const RecordingReader& reader,
                            const PainterSettings& settings, const Painted& painted, double seconds) {
  nlohmann::ordered_json json = {{"report_version", report::kReportVersion},
                                 {"version", SHATTERBOX_VERSION},
                                 {"compiler", SHATTERBOX_COMPILER},
                                 {"gl_renderer", painted.gl_renderer},
                                 {"recording", options.recording},
                                 {"recorded_by", reader.settings().program},
                                 {"scene", reader.settings().scene},
                                 {"goal", reader.settings().goal},
                                 {"size", {settings.size.width, settings.size.height}},
                                 {"quality", settings.quality == render::Quality::full ? "full" : "preview"},
                                 {"recorded_frames", reader.frame_count()},
                                 {"frames", painted.numbers},
                                 {"frame_hashes", nlohmann::ordered_json::array()},
                                 {"interrupted", is_interrupted()},
                                 {"wall_seconds", seconds}};
  for (const std::uint64_t hash : painted.hashes) json["frame_hashes"].push_back(report::hex_digits(hash));
  json["time_ms"] = {{"frame", report::make_spread(painted.frame)},
                     {"render", report::make_spread(painted.render)},
                     {"encode", report::make_spread(painted.encode)},
                     {"passes", report::make_spreads(painted.passes)},
                     {"start", painted.start}};
  return report::write_text(options.report, json.dump(1) + "\n");
}

/// What is done is told; the exit status.
int tell_rendering(const RenderOptions& options, const RecordingReader& reader, const Painted& painted,
                   double seconds) {
  std::string outputs;
  for (const std::string& output :
       {options.video, options.pictures_folder, options.truth_folder, options.report})
    if (!output.empty()) outputs += (outputs.empty() ? "" : ", ") + output;
  const std::size_t count = painted.numbers.size();
  const std::string which =
      count == 0 ? "" : fmt::format(" ({} to {})", painted.numbers.front(), painted.numbers.back());
  fmt::print("{}: {} of {} frames{} in {:.2f} s: {}\n", reader.settings().scene, count, reader.frame_count(),
             which, seconds, outputs);
  std::fflush(stdout);
  return is_interrupted() ? kFailed : kDone;
}

/// Opens the recording and reads the range once, so that a damaged one costs no picture. None, with a
/// problem, if that cannot be.
std::unique_ptr<RecordingReader> open_recording(const RenderOptions& options, std::pair<int, int>& range,
                                                scene::Problems& problems) {
  try {
    auto reader = std::make_unique<RecordingReader>(options.recording);
    const auto frames = parse_frames(options.frames, reader->frame_count(), problems);
    if (!frames) return nullptr;
    range = *frames;
    for (int number = range.first; number < range.second; ++number) (void)reader->read(number);
    return reader;
  } catch (const recording::Unreadable& fault) {
    scene::book(problems, scene::Place{options.recording, 0, 0}, fault.what(), "");
    return nullptr;
  }
}

}  // namespace

std::optional<std::pair<int, int>> parse_frames(const std::string& text, int count,
                                                scene::Problems& problems) {
  const scene::Place place{"--frames", 0, 0};
  const std::size_t colon = text.find(':');
  const int first = frame_number(text.substr(0, colon), 0);
  const int end =
      colon == std::string::npos ? -1 : frame_number(text.substr(colon + 1), std::max(count, first + 1));
  if (!text.empty() && (first < 0 || end <= first)) {
    scene::book(
        problems, place, fmt::format("\"{}\" is no range of frames", text),
        "write FIRST:END, for example 100:200: the hundred frames from 100 on; 100: and :200 are ranges too");
    return std::nullopt;
  }
  if (first < count) return std::pair(first, text.empty() ? count : std::min(end, count));
  scene::book(problems, place,
              fmt::format("the recording has {} frames, and the range begins at {}", count, first),
              count > 0 ? fmt::format("the last one has the number {}", count - 1) : "");
  return std::nullopt;
}

int render_recording(const RenderOptions& options) {
  heed_interrupts();
  scene::Problems problems;
  std::pair<int, int> range;
  const auto start = core::Clock::now();
  const std::unique_ptr<RecordingReader> reader = open_recording(options, range, problems);
  if (!reader) return refuse(problems);
  catch_interrupts();
  Outputs outputs;
  check_outputs(options, outputs, problems);
  const PainterSettings settings = painter_settings(options, reader->settings(), problems);
  const std::optional<Eye> eye = read_eye(options.changes, problems);
  if (problems.empty()) outputs.take(problems);
  if (!problems.empty()) return refuse(problems);
  Painter painter(settings);
  if (!painter.opening_fault().empty()) {
    scene::book(problems, scene::Place{"-o", 0, 0}, painter.opening_fault());
    return refuse(problems);
  }
  std::string fault = paint_frames(*reader, range.first, range.second, eye, painter);
  (void)painter.finish();
  const double seconds = core::milliseconds_since(start) / 1000.0;
  if (fault.empty() && !options.report.empty())
    fault = write_rendering(options, *reader, settings, painter.painted(), seconds);
  if (!fault.empty()) {
    fmt::print(stderr, "failed: {}\n", fault);
    return kFailed;
  }
  return tell_rendering(options, *reader, painter.painted(), seconds);
}

}  // namespace shatterbox::sandbox::run
