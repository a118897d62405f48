#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "sandbox/compare/difference_report.h"
#include "sandbox/run/again.h"
#include "sandbox/run/golden.h"
#include "sandbox/run/golden_folder.h"
#include "sandbox/run/interrupt.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Checked {
  std::string name;
  std::string failure;  // empty: as it must be
  std::string words;    // for people
  compare::FilmDifference pictures;
  Refusal error{kDone, {}};  // why it could not be checked
};

/// Plays it again and compares; what keeps it from that is in `error`.
void play_and_compare(const GoldenOptions& options, const compare::Tolerance& tolerance, Checked& checked) {
  const fs::path folder = fs::path(options.folder) / checked.name;
  const auto golden = read_golden(folder, checked.error);
  if (!golden) return;
  const WorkFolder work;
  if (!work.fault().empty()) {
    checked.error = {kFailed, work.fault()};
    return;
  }
  const auto report = play_golden(*golden, folder, work.path(), checked.error);
  if (!report) return;
  const fs::path& pictures = options.findings.pictures_folder;
  compare::Film expected(folder), actual(work.path() / "frames");
  checked.pictures = compare::compare_films(expected, actual, tolerance,
                                            pictures.empty() ? "" : (pictures / checked.name).string());
  if (!checked.pictures.error.empty()) {
    checked.error = {kBadInput, checked.pictures.error};
    return;
  }
  const std::string was = (*golden)["state_hash"], is = state_of(*report);
  if (was != is) checked.failure = fmt::format("the state is {}, not {}", is, was);
  if (const auto* first = checked.pictures.first()) {
    checked.failure +=
        fmt::format("{}{}: {}", checked.failure.empty() ? "" : "; ", first->name, first->excess);
  }
  checked.words =
      fmt::format("state {}; {}", was == is ? "equal" : "differs", compare::describe(checked.pictures));
}

std::string tell_findings(const GoldenOptions& options, const std::vector<Checked>& all) {
  Json rows = Json::array();
  std::vector<compare::TestCase> cases;
  for (const Checked& one : all) {
    rows.push_back({{"name", one.name},
                    {"same", one.failure.empty() && one.error.words.empty()},
                    {"why", one.failure},
                    {"error", one.error.words},
                    {"pictures", compare::make_json(one.pictures)}});
    cases.push_back({one.name, one.failure, one.error.words});
  }
  return write_findings(options.findings, rows, "shatterbox golden", cases);
}

/// All of them, or until Ctrl-C: one that cannot be checked does not keep the others from it.
std::vector<Checked> check_all(const std::vector<std::string>& names, const GoldenOptions& options,
                               const compare::Tolerance& tolerance) {
  std::vector<Checked> all;
  for (const std::string& name : names) {
    Checked checked{name, {}, {}, {}};
    play_and_compare(options, tolerance, checked);
    if (is_interrupted() && checked.words.empty()) break;
    if (checked.error.words.empty())
      fmt::print("{}: {}", name, checked.words);
    else
      fmt::print(stderr, "{}: {}\n", name, checked.error.words);
    std::fflush(stdout);
    all.push_back(std::move(checked));
    if (is_interrupted()) break;
  }
  return all;
}

/// What came of all, in a line each; the exit status.
int tell_outcome(const std::vector<Checked>& all, std::size_t asked, const std::string& folder) {
  int status = kDone;
  std::size_t failures = 0;
  std::string broken;
  for (const Checked& one : all) {
    failures += one.failure.empty() ? 0 : 1;
    status = std::max({status, one.error.status, one.failure.empty() ? kDone : kDiffers});
    if (!one.error.words.empty()) broken += (broken.empty() ? "" : ", ") + one.name;
  }
  if (failures > 0)
    fmt::print("{} of {} differ. If that is meant: shatterbox golden make {} --reason \"...\"\n", failures,
               all.size(), folder);
  std::fflush(stdout);
  if (!broken.empty()) fmt::print(stderr, "could not be checked: {}\n", broken);
  if (!is_interrupted()) return status;
  fmt::print(stderr, "interrupted: {} of {} were checked\n", all.size(), asked);
  return kFailed;
}

}  // namespace

int check_goldens(const GoldenOptions& options) {
  catch_interrupts();
  Refusal refusal;
  const auto tolerance = compare::parse_tolerance(options.findings.tolerance, refusal.words);
  if (!tolerance) return refuse({kBadInput, "--tolerance: " + refusal.words});
  const auto names = find_goldens(options.folder, options.names, refusal);
  if (!names) return refuse(refusal);
  Outputs outputs;
  add_outputs(options.findings, outputs);
  const fs::path pictures = options.findings.pictures_folder;
  outputs.write_folder("--pictures", pictures.string());
  for (const std::string& name : *names) {
    const fs::path folder = fs::path(options.folder) / name;
    outputs.read_folder("DIR", folder.string());
    if (const auto golden = read_golden(folder, refusal))
      add_inputs(*golden, folder, "the golden " + name, outputs);
    if (!pictures.empty()) outputs.write_folder("--pictures", (pictures / name).string());
  }
  scene::Problems problems;
  outputs.check(problems);
  if (problems.empty()) outputs.take(problems);
  if (!problems.empty()) return refuse({kBadInput, scene::describe(problems)});
  const std::vector<Checked> all = check_all(*names, options, *tolerance);
  const std::string fault = tell_findings(options, all);
  if (!fault.empty()) return refuse({kFailed, "failed: " + fault});
  return tell_outcome(all, names->size(), options.folder);
}

}  // namespace shatterbox::sandbox::run
