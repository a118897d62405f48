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

namespace fs = std::filesystem;

void add_outputs(const FindingOptions& options, Outputs& outputs) {
  outputs.write_file("--report", options.report);
  outputs.write_file("--junit", options.junit);
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

/// What is compared stays, whatever is written; `folder_names` of the files in --pictures.
void add_paths(const DiffOptions& options, std::vector<std::string> folder_names, Outputs& outputs) {
  for (const auto& [option, path] : {std::pair("EXPECTED", options.expected), {"ACTUAL", options.actual}}) {
    std::error_code code;
    if (fs::is_directory(path, code))
      outputs.read_folder(option, path, ".png");
    else
      outputs.read_file(option, path);
  }
  outputs.write_file("--picture", options.picture);
  outputs.write_folder("--pictures", options.findings.pictures_folder, std::move(folder_names));
  add_outputs(options.findings, outputs);
}

/// A report beside something else is no pair.
std::string pair_fault(const std::string& report, const std::string& other) {
  std::error_code code;
  if (!compare::is_report_name(report) || !fs::is_directory(other, code)) return {};
  return fmt::format("{} is a folder and {} a report: compare two folders, or two reports", other, report);
}

int diff_reports(const DiffOptions& options) {
  std::string problem;
  const auto tolerance = compare::parse_report_tolerance(options.findings.tolerance, problem);
  if (!tolerance) return refuse_tolerance(problem);
  scene::Problems problems;
  if (!(options.picture + options.findings.pictures_folder).empty())
    scene::book(problems, scene::Place{"--picture, --pictures", 0, 0}, "reports have no pictures",
                "leave them out");
  for (const std::string& fault :
       {pair_fault(options.expected, options.actual), pair_fault(options.actual, options.expected)})
    if (!fault.empty()) scene::book(problems, scene::Place{"diff", 0, 0}, fault);
  if (!problems.empty()) return refuse(problems);
  Outputs outputs;
  add_paths(options, {}, outputs);
  outputs.check(problems);
  const auto expected = compare::read_report(options.expected), actual = compare::read_report(options.actual);
  if (!expected) scene::book(problems, scene::Place{options.expected, 0, 0}, expected.error());
  if (!actual) scene::book(problems, scene::Place{options.actual, 0, 0}, actual.error());
  if (problems.empty()) outputs.take(problems);
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
  Outputs outputs;
  add_paths(options, {"frame_*.png", fs::path(options.expected).stem().string() + ".png"}, outputs);
  outputs.check(problems);
  compare::Film expected(options.expected), actual(options.actual);
  for (const compare::Film* film : {&expected, &actual})
    if (problems.empty() && !film->error().empty()) {
      fmt::print(stderr, "{}\n", film->error());
      return kBadInput;
    }
  if (problems.empty()) outputs.take(problems);
  if (!problems.empty()) return refuse(problems);
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
