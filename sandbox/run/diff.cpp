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

void prepare_findings(const FindingOptions& options, scene::Problems& problems) {
  Options outputs;
  outputs.report = options.report;
  outputs.frames_folder = options.pictures_folder;
  prepare_outputs(outputs, problems);
  check_file("--junit", options.junit, problems);
}

std::string write_findings(const FindingOptions& options, const nlohmann::ordered_json& report,
                           const std::string& suite, const std::vector<compare::TestCase>& cases) {
  std::string fault;
  if (!options.report.empty()) fault = report::write_text(options.report, report.dump(2) + "\n");
  if (fault.empty() && !options.junit.empty())
    fault = report::write_text(options.junit, compare::make_junit(suite, cases));
  return fault;
}

int run_diff(const DiffOptions& options) {
  std::string problem;
  const auto tolerance = compare::parse_tolerance(options.findings.tolerance, problem);
  if (!tolerance) {
    fmt::print(stderr, "--tolerance: {}\n", problem);
    return kBadInput;
  }
  scene::Problems problems;
  prepare_findings(options.findings, problems);
  check_file("--picture", options.picture, problems);
  if (!problems.empty()) {
    fmt::print(stderr, "{}\n", scene::describe(problems));
    return kBadInput;
  }
  compare::Film expected(options.expected), actual(options.actual);
  const compare::FilmDifference difference =
      compare::compare_films(expected, actual, *tolerance, options.findings.pictures_folder);
  if (!difference.error.empty()) {
    fmt::print(stderr, "{}\n", difference.error);
    return kBadInput;
  }
  fmt::print("{}", compare::describe(difference));
  std::fflush(stdout);
  std::string fault = write_findings(options.findings, compare::make_json(difference),
                                     "shatterbox diff " + options.expected, compare::test_cases(difference));
  if (fault.empty() && !options.picture.empty() && !difference.worst.empty())
    fault = render::write_png(options.picture, difference.worst_picture).error;
  if (!fault.empty()) {
    fmt::print(stderr, "failed: {}\n", fault);
    return kFailed;
  }
  return difference.is_same() ? kDone : kDiffers;
}

}  // namespace shatterbox::sandbox::run
