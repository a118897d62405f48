// What the pictures of a recorded film cost: it is drawn once more in each quality, with nothing beside it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace shatterbox::sandbox::run {

/// The recording in a gallery's folder of a run; gone when it is measured, kept where Ctrl-C broke that off.
inline constexpr const char* kGalleryRecording = "film.rec";

struct DrawingCost {
  std::string quality;
  double frames_per_second = 0.0;  // of the median frame
  double worst = 0.0;              // ms, of a frame
  nlohmann::ordered_json passes;   // as in a report: time_ms.passes
};

/// Of a folder without a recording, what was measured there before. Nothing of what cannot be drawn:
/// drawing.txt there says why.
std::vector<DrawingCost> measure_drawing(const std::filesystem::path& folder);

}  // namespace shatterbox::sandbox::run
