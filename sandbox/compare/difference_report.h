// What a comparison of films found: in words, as JSON, and as tests.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sandbox/compare/film_difference.h"
#include "sandbox/compare/junit.h"

namespace shatterbox::sandbox::compare {

/// A few lines: how many pictures differ, the first, and the worst, with their numbers.
std::string describe(const FilmDifference& difference);

/// {"same", "frames_compared", "frames_differing", "first", "frames": [{"name", "same", "why", "psnr",
/// "ssim", "mean", "most", "pixels_beyond", "share_beyond", "largest_cluster"}]}; an infinite PSNR is null.
nlohmann::ordered_json make_json(const FilmDifference& difference);

/// A test for each frame.
std::vector<TestCase> test_cases(const FilmDifference& difference);

}  // namespace shatterbox::sandbox::compare
