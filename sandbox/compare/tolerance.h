// How far apart two pictures may be and still count as the same.
#pragma once

#include <optional>
#include <string>

#include "render/output/compare.h"

namespace shatterbox::sandbox::compare {

struct Tolerance {
  int levels = 2;       // up to so many levels (of 255) apart, in every channel, a pixel is the same
  double share = 1e-4;  // of the pixels may be further apart,
  long cluster = 4;     // if no more than so many of them touch,
  double psnr = 60.0;   // dB at least,
  double ssim = 0.0;    // and at least this similar
};

/// "default" (what another processor's rounding does passes, a missing shard does not), "exact" (every bit),
/// "video" (two encodings of one film), or changes to the default: "levels=3,share=0.001,cluster=10,psnr=50,
/// ssim=0.99". Nothing, with a sentence, if it is none of them.
std::optional<Tolerance> parse_tolerance(const std::string& text, std::string& problem);

/// Why `difference` is beyond the tolerance, or empty.
std::string find_excess(const render::Difference& difference, const Tolerance& tolerance);

}  // namespace shatterbox::sandbox::compare
