#include "sandbox/run/diff.h"

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "render/output/image_file.h"
#include "sandbox/compare/difference_report.h"
#include "sandbox/report/text_file.h"
#include "sandbox/run/options.h"

namespace shatterbox::sandbox::run {

namespace {

/// Writes what was asked for; a sentence if that fails.
std::string write_findings(const DiffOptions& options, const compare::FilmDifference& difference) {
  std::string fault;
  if (!options.report.empty())
    fault = report::write_text(options.report, compare::make_json(difference).dump(2) + "\n");
  if (fault.empty() && !options.junit.empty())
    fault = report::write_text(options.junit, compare::make_junit("shatterbox diff " + options.expected,
                                                                  compare::test_cases(difference)));
  if (fault.empty() && !options.picture.empty() && !difference.worst.empty())
    fault = render::write_png(options.picture, difference.worst_picture).error;
  return fault;
}

}  // namespace

int run_diff(const DiffOptions& options) {
  std::string problem;
  const auto tolerance = compare::parse_tolerance(options.tolerance, problem);
  if (!tolerance) {
    fmt::print(stderr, "--tolerance: {}\n", problem);
    return kBadInput;
  }
  scene::Problems problems;
  Options outputs;
  outputs.report = options.report;
  outputs.frames_folder = options.pictures_folder;
  prepare_outputs(outputs, problems);
  check_file("--junit", options.junit, problems);
  check_file("--picture", options.picture, problems);
  if (!problems.empty()) {
    fmt::print(stderr, "{}\n", scene::describe(problems));
    return kBadInput;
  }
  compare::Film expected(options.expected), actual(options.actual);
  const compare::FilmDifference difference =
      compare::compare_films(expected, actual, *tolerance, options.pictures_folder);
  if (!difference.error.empty()) {
    fmt::print(stderr, "{}\n", difference.error);
    return kBadInput;
  }
  fmt::print("{}", compare::describe(difference));
  std::fflush(stdout);
  const std::string fault = write_findings(options, difference);
  if (!fault.empty()) {
    fmt::print(stderr, "failed: {}\n", fault);
    return kFailed;
  }
  return difference.is_same() ? kDone : kDiffers;
}

}  // namespace shatterbox::sandbox::run
