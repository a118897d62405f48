// What a study measures: rows of a setting, its errors and its run time, in tables.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace shatterbox::sandbox::study {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// What one setting gave and cost.
struct Row {
  std::string setting;         // as a user would write it
  double value = kNoNumber;    // what the error is an order of (a step, an element size); NaN: nothing
  std::vector<double> errors;  // by Table::error_names; NaN: not measured
  double seconds = kNoNumber;  // processor time of the measured part, median of repeats; NaN: not measured
  bool is_default = false;
  std::string note;  // caps that were active, what did not converge; empty: nothing to say
};

/// One case, from the coarsest to the finest setting.
struct Table {
  std::string name;                      // one word: "incline"
  std::string what;                      // the case, and its exact answer, in a sentence without a stop
  std::string setting_name;              // "steps a second"
  std::string value_name;                // what `value` is, "step, s"; empty: the rows have none
  std::vector<std::string> error_names;  // the first one decides which setting is good enough
  std::vector<double> theory;  // the order in `value` that theory gives each error; NaN, or too short: none
  std::string order_name = "order";  // "exponent", where the first column is a cost
  bool is_relative = true;           // the first error is a share: 1 % means something
  bool is_plotted = true;
  std::vector<Row> rows;
};

}  // namespace shatterbox::sandbox::study
