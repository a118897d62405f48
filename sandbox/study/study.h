// A study: what is to be measured, as jobs that are run one after the other, timed, and told in words.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sandbox/study/table.h"

namespace shatterbox::sandbox::study {

/// What one run of a job found. `seconds` is the processor time of its measured part (Stopwatch).
struct Measured {
  std::vector<double> errors;
  double seconds = kNoNumber;
  std::string note;
};

/// One row of one table. `measure` is called several times: it must do all of its work each time.
struct Job {
  std::size_t table = 0;  // number in Plan::tables
  std::string setting;
  double value = kNoNumber;
  bool is_default = false;
  std::function<Measured()> measure;
};

/// A picture of its own, beside error against run time.
struct Figure {
  struct Curve {
    std::string name;
    std::vector<double> x, y;
  };
  std::string name;  // of the file, behind the study's
  std::string title, x_label, y_label;
  bool is_x_logarithmic = false, is_y_logarithmic = false;
  std::vector<Curve> curves;
};

struct Plan {
  std::vector<Table> tables;  // without rows: the jobs bring them
  std::vector<Job> jobs;
  /// More to be said when all is measured: sentences, each of which follows from numbers of the tables.
  std::function<std::vector<std::string>(const std::vector<Table>&)> conclude;
  std::function<std::vector<Figure>(const std::vector<Table>&)> draw;  // after all jobs
};

/// A table over steps a second, without rows.
Table rate_table(std::string name, std::string what, std::vector<std::string> errors);
/// Adds it, and a job for each of `rates`; the world's own rate is the default's row.
void add_rates(Plan& plan, Table table, const std::vector<int>& rates,
               const std::function<Measured(int)>& measure);

struct Study {
  std::string name;
  std::string what;
  std::function<Plan(bool is_quick)> plan;  // quick: fewer settings and smaller cases
};

/// All studies, in the order in which `list` names them.
const std::vector<Study>& studies();

struct RunSettings {
  bool is_quick = false;
  /// Called before each job; false stops the study there.
  std::function<bool(int done, int total, const std::string& note)> go_on;
};

struct StudyResult {
  std::vector<Table> tables;
  std::vector<std::string> conclusions;
  std::vector<Figure> figures;
  bool is_whole = true;  // false: stopped before its end
};

/// Runs all jobs. The first call of each row is not timed, for what is cold is not what a setting costs; only
/// where it takes more than 5 s, in a table that has a row already, it stands for itself. Then the median of
/// repeats: five, fewer for what takes long, one if quick.
StudyResult run_plan(const Plan& plan, const RunSettings& settings);

}  // namespace shatterbox::sandbox::study
