// What a comparison found: in words, as JSON, and as JUnit XML for test farms.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "sandbox/compare/film_difference.h"

namespace shatterbox::sandbox::compare {

/// A few lines: how many pictures differ, the first, and the worst, with their numbers.
std::string describe(const FilmDifference& difference);

/// {"same", "frames_compared", "frames_differing", "first", "frames": [{"name", "same", "why", "psnr",
/// "ssim", "mean", "most", "pixels_beyond", "share_beyond", "largest_cluster"}]}; an infinite PSNR is null.
nlohmann::ordered_json make_json(const FilmDifference& difference);

/// One test of a suite: it passes without a failure.
struct TestCase {
  std::string name, failure;
};

/// One suite, as Jenkins, GitLab and their like read it.
std::string make_junit(const std::string& suite, const std::vector<TestCase>& cases);

/// A test for each frame.
std::vector<TestCase> test_cases(const FilmDifference& difference);

}  // namespace shatterbox::sandbox::compare
