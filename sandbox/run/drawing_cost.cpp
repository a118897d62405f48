#include "sandbox/run/drawing_cost.h"

#include <fmt/format.h>

#include "sandbox/report/text_file.h"
#include "sandbox/run/again.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/options.h"

namespace shatterbox::sandbox::run {

namespace fs = std::filesystem;

namespace {

bool draw(const fs::path& folder, const std::string& quality, const std::string& report) {
  const pid_t child = start_again({"render", kGalleryRecording, "--quality", quality, "--report", report},
                                  folder, folder / "drawing.txt");
  return child > 0 && wait_again(child) == kDone;
}

}  // namespace

std::vector<DrawingCost> measure_drawing(const fs::path& folder) {
  std::vector<DrawingCost> costs;
  const bool has_recording = fs::exists(folder / kGalleryRecording);
  for (const char* quality : {"preview", "full"}) {
    const std::string report = fmt::format("drawing_{}.json", quality);
    if (has_recording && (is_interrupted() || !draw(folder, quality, report))) continue;
    const auto drawn =
        nlohmann::ordered_json::parse(report::read_text((folder / report).string()), nullptr, false);
    if (!drawn.is_object()) continue;
    const auto& times = drawn["time_ms"];
    const double median = times["render"].value("median", 0.0);
    costs.push_back(
        {quality, median > 0.0 ? 1e3 / median : 0.0, times["render"].value("max", 0.0), times["passes"]});
  }
  std::error_code ignored;
  if (!is_interrupted()) fs::remove(folder / kGalleryRecording, ignored);
  return costs;
}

}  // namespace shatterbox::sandbox::run
