#include "sandbox/run/gallery.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "render/output/image_file.h"
#include "render/output/video_reader.h"
#include "sandbox/report/text_file.h"
#include "sandbox/scene/words.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;

constexpr double kAfterBreak = 0.25;  // s: pieces are on their way
constexpr const char* kBegin = "begin.png";
constexpr const char* kTelling = "broken.png";
constexpr const char* kEnd = "end.png";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

const nlohmann::json& first_shot(const nlohmann::json& report) {
  return report.contains("shots") && !report["shots"].empty() ? report["shots"].front() : report;
}

/// The frame of the film that shows the first break, or, where nothing breaks, its middle. The film of a run
/// at true speed; where its speed changes, somewhat early or late.
long telling_frame(const nlohmann::json& report, long frames) {
  const nlohmann::json& shot = first_shot(report);
  const double seconds = shot.value("simulated_seconds", 0.0);
  double time = 0.5 * seconds;
  if (shot.contains("breaks") && !shot["breaks"].empty())
    time = shot["breaks"][0].value("time", 0.0) + kAfterBreak;
  const long shot_frames = static_cast<long>(shot.value("frame_hashes", nlohmann::json::array()).size());
  const double share = seconds > 0.0 ? std::clamp(time / seconds, 0.0, 1.0) : 0.5;
  return std::clamp(std::lround(share * static_cast<double>(shot_frames)), 0L, std::max(frames - 1, 0L));
}

long count_pictures(const nlohmann::json& report) {
  if (!report.contains("shots"))
    return static_cast<long>(report.value("frame_hashes", nlohmann::json::array()).size());
  long count = 0;
  for (const nlohmann::json& shot : report["shots"]) count += count_pictures(shot);
  return count;
}

/// Writes three of the film's pictures: what is there, what happens to it, what becomes of it. A sentence if
/// that fails.
std::string take_stills(const Exhibit& exhibit) {
  const long last = count_pictures(exhibit.report) - 1, telling = telling_frame(exhibit.report, last + 1);
  render::VideoReader film(exhibit.folder / "film.mp4");
  std::optional<render::Image> picture, end;
  for (long number = 0; (picture = film.next()); ++number) {
    for (const auto& [name, at] : {std::pair(kBegin, 0L), std::pair(kTelling, telling)})
      if (number == at)
        if (const auto status = render::write_png(exhibit.folder / name, *picture); !status)
          return status.error;
    end = std::move(picture);
  }
  if (!film.status()) return film.status().error;
  if (!end) return "there is no picture in it";
  const auto status = render::write_png(exhibit.folder / kEnd, *end);
  return status ? std::string() : status.error;
}

/// What drawing alone reaches, and where its time goes, by the median of each.
std::string told(const DrawingCost& cost) {
  std::string passes;
  for (const auto& [name, spread] : cost.passes.items())
    if (const double median = spread.value("median", 0.0); median >= 0.05)
      passes += fmt::format("{}{} {:.1f}", passes.empty() ? "" : ", ", name, median);
  return fmt::format("drawn in {} quality: {:.0f} frames a second, worst frame {:.0f} ms{}", cost.quality,
                     cost.frames_per_second, cost.worst, passes.empty() ? "" : "; " + passes + " ms");
}

std::string numbers_of(const nlohmann::json& shot) {
  const auto number = [&shot](const char* key) { return shot.value(key, 0.0); };
  const nlohmann::json& frame = shot["time_ms"]["frame"];
  const auto of_frame = [&frame](const char* key) {
    return frame.contains(key) && frame[key].is_number() ? frame[key].get<double>() : 0.0;
  };
  return fmt::format(
      "{} of {}, {} triangles at most, {}; {:.3g} s of film in {:.3g} s; a frame {:.1f} "
      "ms "
      "(median; worst {:.0f})",
      scene::counted(shot.value("pieces", 0L), "piece"),
      scene::counted(static_cast<long>(shot["breaks"].size()), "break"), shot["triangles"].value("max", 0L),
      scene::counted(shot.value("steps", 0L), "step"), number("video_seconds"), number("wall_seconds"),
      of_frame("median"), of_frame("max"));
}

std::string entry_of(const Exhibit& exhibit, const std::string& fault) {
  const fs::path place = exhibit.folder.filename();
  std::string text = fmt::format("<section>\n<h2>{}</h2>\n", escaped(exhibit.name));
  if (!exhibit.report.is_object()) return text + "<p>It left no report: see its log.txt.</p>\n</section>\n";
  const nlohmann::json& first = first_shot(exhibit.report);
  text += fmt::format("<p>{}</p>\n", escaped(first.value("goal", "")));
  if (fault.empty()) {
    std::error_code ignored;
    const auto bytes = fs::file_size(exhibit.folder / "film.mp4", ignored);
    for (const char* picture : {kBegin, kTelling, kEnd})
      text += fmt::format("<a href=\"{0}/{1}\"><img src=\"{0}/{1}\" alt=\"{2}\"></a>\n",
                          escaped(place.string()), picture, escaped(exhibit.name));
    text += fmt::format("<p><a href=\"{}/film.mp4\">film.mp4</a>, {:.2f} MB</p>\n", escaped(place.string()),
                        static_cast<double>(bytes) / 1e6);
  } else {
    text += fmt::format("<p>no pictures: {}</p>\n", escaped(fault));
  }
  const bool has_shots = exhibit.report.contains("shots");
  const nlohmann::json shots = has_shots ? exhibit.report["shots"] : nlohmann::json::array({exhibit.report});
  for (const nlohmann::json& shot : shots)
    text += fmt::format("<p class=\"numbers\">{}{}</p>\n",
                        has_shots ? escaped(shot.value("scene", "")) + ": " : "", escaped(numbers_of(shot)));
  for (const DrawingCost& cost : exhibit.drawing)
    text += fmt::format("<p class=\"numbers\">{}</p>\n", escaped(told(cost)));
  return text + "</section>\n";
}

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>Shatterbox: gallery</title>
<style>
body { font: 16px/1.4 sans-serif; margin: 2em auto; max-width: 1320px; padding: 0 1em; background: #fafaf8; color: #222; }
section { margin-bottom: 2.5em; }
h2 { margin: 0; }
img { width: 32.8%; border-radius: 4px; }
p { margin: 0.3em 0; }
.numbers { color: #666; font-size: 14px; }
</style>
<h1>Gallery</h1>
)";

}  // namespace

std::string write_gallery(const fs::path& folder, const std::vector<Exhibit>& exhibits,
                          const std::vector<LeftOut>& left_out) {
  std::string page = kHead;
  for (const Exhibit& exhibit : exhibits) {
    const bool has_film = exhibit.report.is_object() && fs::exists(exhibit.folder / "film.mp4");
    page += entry_of(exhibit, has_film ? take_stills(exhibit) : "there is no film.mp4");
  }
  for (const LeftOut& left : left_out)
    page += fmt::format(
        "<section>\n<h2>{0}</h2>\n<p>left out: it takes {1}. --with {0} takes it in.</p>\n</section>\n",
        escaped(left.name), escaped(left.takes));
  return report::write_text((folder / "index.html").string(), page + "</html>\n");
}

}  // namespace shatterbox::sandbox::run
