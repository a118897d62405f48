#include "sandbox/run/diff.h"

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "render/output/image_file.h"
#include "sandbox/compare/difference_report.h"
#include "sandbox/compare/report_difference.h"
#include "sandbox/compare/report_file.h"
#include "sandbox/report/text_file.h"
#include "sandbox/run/job.h"

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

namespace {

int refuse_tolerance(const std::string& problem) {
  fmt::print(stderr, "--tolerance: {}\n", problem);
  return kBadInput;
}

/// What was found, in words and where it was asked for; the exit status.
template <class Difference>
int tell(const Difference& difference, const DiffOptions& options) {
  fmt::print("{}", compare::describe(difference));
  std::fflush(stdout);
  const std::string fault =
      write_findings(options.findings, compare::make_json(difference), "shatterbox diff " + options.expected,
                     compare::test_cases(difference));
  if (fault.empty()) return difference.is_same() ? kDone : kDiffers;
  fmt::print(stderr, "failed: {}\n", fault);
  return kFailed;
}

int diff_reports(const DiffOptions& options) {
  std::string problem;
  const auto tolerance = compare::parse_report_tolerance(options.findings.tolerance, problem);
  if (!tolerance) return refuse_tolerance(problem);
  scene::Problems problems;
  if (!(options.picture + options.findings.pictures_folder).empty())
    scene::book(problems, scene::Place{"--picture, --pictures", 0, 0}, "reports have no pictures",
                "leave them out");
  prepare_findings(options.findings, problems);
  const auto expected = compare::read_report(options.expected), actual = compare::read_report(options.actual);
  if (!expected) scene::book(problems, scene::Place{options.expected, 0, 0}, expected.error());
  if (!actual) scene::book(problems, scene::Place{options.actual, 0, 0}, actual.error());
  if (!problems.empty()) return refuse(problems);
  return tell(compare::compare_reports(expected.value(), actual.value(), *tolerance), options);
}

}  // namespace

int run_diff(const DiffOptions& options) {
  if (compare::is_report_name(options.expected) || compare::is_report_name(options.actual))
    return diff_reports(options);
  std::string problem;
  const auto tolerance = compare::parse_tolerance(options.findings.tolerance, problem);
  if (!tolerance) return refuse_tolerance(problem);
  scene::Problems problems;
  prepare_findings(options.findings, problems);
  check_file("--picture", options.picture, problems);
  if (!problems.empty()) return refuse(problems);
  compare::Film expected(options.expected), actual(options.actual);
  const compare::FilmDifference difference =
      compare::compare_films(expected, actual, *tolerance, options.findings.pictures_folder);
  if (!difference.error.empty()) {
    fmt::print(stderr, "{}\n", difference.error);
    return kBadInput;
  }
  const int status = tell(difference, options);
  if (status == kFailed || options.picture.empty() || difference.worst.empty()) return status;
  const render::Status written = render::write_png(options.picture, difference.worst_picture);
  if (!written) fmt::print(stderr, "failed: {}\n", written.error);
  return written ? status : kFailed;
}

}  // namespace shatterbox::sandbox::run
