#include <algorithm>
#include <cmath>

#include "engine/world/settings.h"
#include "sandbox/study/stopwatch.h"
#include "sandbox/study/study.h"

namespace shatterbox::sandbox::study {

namespace {

/// A call that takes longer than this (s) costs the same whatever the caches hold.
constexpr double kLongCall = 5.0;

/// Repeats of a row whose first call took `seconds`, all in all.
int repeats_of(double seconds, bool is_quick) {
  if (is_quick || seconds > kLongCall) return 1;
  return seconds > 1.0 ? 3 : 5;
}

/// `is_warm`: another row of the table has been measured.
Row measure_row(const Job& job, bool is_quick, bool is_warm) {
  Row row;
  row.setting = job.setting;
  row.value = job.value;
  row.is_default = job.is_default;
  const Stopwatch watch;
  Measured measured = job.measure();
  const double whole = watch.seconds();
  row.errors = measured.errors;
  row.note = measured.note;
  row.seconds = measured.seconds;
  if (std::isnan(measured.seconds) || (is_warm && whole > kLongCall)) return row;
  std::vector<double> times;
  const int repeats = repeats_of(whole, is_quick);
  for (int i = 0; i < repeats; ++i) times.push_back(job.measure().seconds);
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  row.seconds = times[static_cast<std::size_t>(repeats / 2)];
  return row;
}

}  // namespace

Table rate_table(std::string name, std::string what, std::vector<std::string> errors) {
  Table table;
  table.name = std::move(name);
  table.what = std::move(what);
  table.error_names = std::move(errors);
  table.setting_name = "steps a second";
  table.value_name = "step, s";
  return table;
}

void add_rates(Plan& plan, Table table, const std::vector<int>& rates,
               const std::function<Measured(int)>& measure) {
  const int usual = world::WorldSettings{}.steps_per_second;
  for (const int rate : rates)
    plan.jobs.push_back({plan.tables.size(), std::to_string(rate), 1.0 / rate, rate == usual,
                         [measure, rate] { return measure(rate); }});
  plan.tables.push_back(std::move(table));
}

StudyResult run_plan(const Plan& plan, const RunSettings& settings) {
  StudyResult result;
  result.tables = plan.tables;
  const int total = static_cast<int>(plan.jobs.size());
  for (int i = 0; i < total; ++i) {
    const Job& job = plan.jobs[static_cast<std::size_t>(i)];
    Table& table = result.tables[job.table];
    if (settings.go_on && !settings.go_on(i, total, table.name + ", " + job.setting)) {
      result.is_whole = false;
      return result;
    }
    table.rows.push_back(measure_row(job, settings.is_quick, !table.rows.empty()));
  }
  if (settings.go_on) settings.go_on(total, total, "");
  if (plan.conclude) result.conclusions = plan.conclude(result.tables);
  if (plan.draw) result.figures = plan.draw(result.tables);
  return result;
}

}  // namespace shatterbox::sandbox::study
