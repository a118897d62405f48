#include "sandbox/compare/difference_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace shatterbox::sandbox::compare {

namespace {

std::string numbers(const render::Difference& d) {
  if (!d.same_size) return {};
  return fmt::format(" (PSNR {:.1f} dB, SSIM {:.4f}, most {} levels, {} pixels beyond, {} side by side)",
                     d.psnr, d.ssim, d.most, d.pixels_beyond, d.largest_cluster);
}

}  // namespace

std::string describe(const FilmDifference& difference) {
  const auto count = static_cast<long>(difference.frames.size());
  const FrameDifference* const first = difference.first();
  if (first == nullptr) {
    const bool is_exact = std::all_of(difference.frames.begin(), difference.frames.end(),
                                      [](const auto& frame) { return frame.difference.most == 0; });
    return fmt::format("{} picture{}: the same{}\n", count, count == 1 ? "" : "s",
                       is_exact ? ", to the bit" : ", within the tolerance");
  }
  std::string text = fmt::format("{} of {} picture{} differ{}\n", difference.differing(), count,
                                 count == 1 ? "" : "s", difference.differing() == 1 ? "s" : "");
  const auto add = [&text](const char* word, const FrameDifference& frame) {
    text += fmt::format("    {:<6} {}: {}{}\n", word, frame.name, frame.excess, numbers(frame.difference));
  };
  add("first", *first);
  for (const FrameDifference& frame : difference.frames)
    if (frame.name == difference.worst && &frame != first) add("worst", frame);
  return text;
}

nlohmann::ordered_json make_json(const FilmDifference& difference) {
  nlohmann::ordered_json json;
  json["same"] = difference.is_same();
  json["frames_compared"] = difference.frames.size();
  json["frames_differing"] = difference.differing();
  const FrameDifference* const first = difference.first();
  json["first"] = first != nullptr ? nlohmann::ordered_json(first->name) : nlohmann::ordered_json(nullptr);
  json["frames"] = nlohmann::ordered_json::array();
  for (const FrameDifference& frame : difference.frames) {
    const render::Difference& d = frame.difference;
    nlohmann::ordered_json row{{"name", frame.name}, {"same", frame.excess.empty()}, {"why", frame.excess}};
    if (d.same_size) {
      row["psnr"] = std::isfinite(d.psnr) ? nlohmann::ordered_json(d.psnr) : nlohmann::ordered_json(nullptr);
      row["ssim"] = d.ssim;
      row["mean"] = d.mean;
      row["most"] = d.most;
      row["pixels_beyond"] = d.pixels_beyond;
      row["share_beyond"] = d.share_beyond;
      row["largest_cluster"] = d.largest_cluster;
    }
    json["frames"].push_back(std::move(row));
  }
  return json;
}

std::vector<TestCase> test_cases(const FilmDifference& difference) {
  std::vector<TestCase> cases;
  for (const FrameDifference& frame : difference.frames)
    cases.push_back({frame.name, frame.excess.empty() ? "" : frame.excess + numbers(frame.difference)});
  return cases;
}

}  // namespace shatterbox::sandbox::compare
