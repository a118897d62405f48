// The benchmark scenes: each runs in a process of its own, so that its memory and its caches are its own, and
// its report is read back.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace shatterbox::sandbox::run {

struct Benchmark {
  std::string name;
  std::string what;                    // in words
  std::vector<std::string> arguments;  // of `run`; pictures are drawn unless they say --no-render
  std::string needs = {};              // a file of Debian's glmark2-data; left out without it
};

/// All benchmarks, in the order of the table.
const std::vector<Benchmark>& benchmarks();

struct BenchOptions {
  std::vector<std::string> names;  // benchmarks, or how their names begin; empty: all
  std::vector<int> threads{0};     // one run for each; 0: one a core
  std::string report;              // JSON; empty: none
  bool has_audit = false;          // crossings and passages are counted, which costs time of its own
  bool is_brief = false;           // a tenth of a second each: does everything run?
};

/// What one run's report says about speed, by the words of the table: medians, p95 and worst times in ms by
/// phase, the dearest frame by stage, memory in MB, contacts, failsafe share, crossings (null without the
/// audit).
nlohmann::ordered_json bench_row(const std::string& name, const nlohmann::json& report);

/// The rows as a table for people.
std::string bench_table(const nlohmann::ordered_json& rows);

/// Runs what `options` names, prints the table. Returns the exit status.
int run_bench(const BenchOptions& options);

}  // namespace shatterbox::sandbox::run
