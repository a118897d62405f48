// Any bytes as a report: a sentence, or one that is the same as itself and can be compared with another.
#include "sandbox/compare/report_difference.h"
#include "sandbox/compare/report_file.h"
#include "tests/fuzz/target.h"

using namespace shatterbox::sandbox;

int fuzz::run_one(std::string_view bytes) {
  static const auto kOther = compare::parse_report(R"({"report_version": 1, "pieces": 2, "goal": "",
    "breaks": [{"time": 0.5, "pieces": 2, "place": [0, 1, 2]}], "shots": [{"pieces": 1}],
    "trace": {"quantities": ["position"], "names": {"2": "ball"}, "rows": [[1, 1, 1, 1, "acts", "2 0:1a2b3c4d"]]}})");
  const auto report = compare::parse_report(bytes);
  if (!report) {
    require(!report.error().empty(), "a sentence");
    return 0;
  }
  require(compare::compare_reports(report.value(), report.value(), 0.0).is_same(), "a report is as it is");
  const compare::ReportDifference there = compare::compare_reports(report.value(), kOther.value(), 0.1);
  const compare::ReportDifference back = compare::compare_reports(kOther.value(), report.value(), 0.1);
  require(there.differing() == back.differing(), "there is no first and second");
  require(!compare::describe(there).empty() && !compare::make_json(there).dump().empty(), "it can be told");
  (void)compare::make_junit("fuzz", compare::test_cases(there));
  return 0;
}
