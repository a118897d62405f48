#include "sandbox/compare/tolerance.h"

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::compare {

namespace {

// Lossy encoders move edges by tens of levels, but leave the picture as a whole alone.
constexpr Tolerance kVideo{40, 1e-3, 24, 34.0, 0.97};
constexpr Tolerance kExact{0, 0.0, 0, INFINITY, 1.0};

const std::vector<std::string> kPresets{"default", "exact", "video"};
const std::vector<std::string> kKeys{"levels", "share", "cluster", "psnr", "ssim"};

std::optional<double> parse_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= 0.0)) return std::nullopt;
  return value;
}

bool set(Tolerance& tolerance, const std::string& key, double value, std::string& problem) {
  const auto in_range = [&](double most) {
    if (value > most) problem = fmt::format("{} is from 0 to {:g}, not {:g}", key, most, value);
    return problem.empty();
  };
  if (key == "levels" && in_range(255.0)) tolerance.levels = static_cast<int>(value);
  if (key == "share" && in_range(1.0)) tolerance.share = value;
  if (key == "cluster" && in_range(1e9)) tolerance.cluster = static_cast<long>(value);
  if (key == "psnr") tolerance.psnr = value;
  if (key == "ssim" && in_range(1.0)) tolerance.ssim = value;
  return problem.empty();
}

}  // namespace

std::optional<Tolerance> parse_tolerance(const std::string& text, std::string& problem) {
  if (text == "default") return Tolerance{};
  if (text == "exact") return kExact;
  if (text == "video") return kVideo;
  if (text.find('=') == std::string::npos) {
    problem =
        fmt::format("\"{}\" is no tolerance; {}", text, scene::hint_for_name(text, kPresets, "tolerances"));
    return std::nullopt;
  }
  Tolerance tolerance;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    const std::size_t sign = word.find('=');
    const std::string key = word.substr(0, sign);
    const auto value = sign == std::string::npos ? std::nullopt : parse_number(word.substr(sign + 1));
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      problem =
          fmt::format("a tolerance has no \"{}\"; {}", key, scene::hint_for_name(key, kKeys, "its numbers"));
      return std::nullopt;
    }
    if (!value) {
      problem = fmt::format("\"{}\": write {}=NUMBER, not below 0", word, key);
      return std::nullopt;
    }
    if (!set(tolerance, key, *value, problem)) return std::nullopt;
  }
  return tolerance;
}

std::string find_excess(const render::Difference& d, const Tolerance& tolerance) {
  if (!d.same_size) return "the pictures are of different size";
  if (d.share_beyond > tolerance.share)
    return fmt::format("{} pixels ({:.3g} %) are more than {} levels apart", d.pixels_beyond,
                       100.0 * d.share_beyond, tolerance.levels);
  if (d.largest_cluster > tolerance.cluster)
    return fmt::format("{} pixels side by side are more than {} levels apart", d.largest_cluster,
                       tolerance.levels);
  if (d.psnr < tolerance.psnr) return fmt::format("PSNR {:.1f} dB, below {:g}", d.psnr, tolerance.psnr);
  if (d.ssim < tolerance.ssim) return fmt::format("SSIM {:.4f}, below {:g}", d.ssim, tolerance.ssim);
  return {};
}

}  // namespace shatterbox::sandbox::compare
