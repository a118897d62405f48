// Two reports side by side, field by field. What differs from machine to machine is left aside: times,
// memory, threads, versions and names of files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sandbox/compare/junit.h"

namespace shatterbox::sandbox::compare {

/// One number, word or length that is not the same.
struct ValueDifference {
  std::string place;               // "breaks[1].pieces"
  std::string expected, actual;    // as JSON; or what there is instead: "nothing", "3 entries"
  std::optional<double> relative;  // of numbers: the difference over the greater one
};

/// A field of the report, or of one of its shots, with all that is in it.
struct FieldDifference {
  std::string name;
  long compared = 0;  // numbers and words in it
  std::vector<ValueDifference> differences;
};

struct ReportDifference {
  double tolerance = 0.0;
  std::vector<FieldDifference> fields;

  bool is_same() const;
  long compared() const;
  long differing() const;
};

/// "default" and "exact" are 0; a number is the relative difference that numbers may have. Nothing, with a
/// sentence, for anything else.
std::optional<double> parse_report_tolerance(const std::string& text, std::string& problem);

/// With a tolerance above 0 hashes are not compared, nor are errors and residuals, which measure rounding,
/// nor the ratio in the words of a verdict.
ReportDifference compare_reports(const nlohmann::ordered_json& expected, const nlohmann::ordered_json& actual,
                                 double tolerance);

/// A few lines: how many values differ, the first ones, and the number that differs most.
std::string describe(const ReportDifference& difference);

/// {"same", "tolerance", "values_compared", "values_differing", "differences": [{"place", "expected",
/// "actual", "relative"}]}.
nlohmann::ordered_json make_json(const ReportDifference& difference);

/// A test for each field.
std::vector<TestCase> test_cases(const ReportDifference& difference);

}  // namespace shatterbox::sandbox::compare
