#include "sandbox/run/bench.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sandbox/report/text_file.h"
#include "sandbox/run/again.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/options.h"
#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool has_pictures(const Benchmark& benchmark) {
  return std::find(benchmark.arguments.begin(), benchmark.arguments.end(), "--no-render") ==
         benchmark.arguments.end();
}

/// One run of one benchmark, as a row; nothing, after saying why, if it failed.
std::optional<Json> measure(const Benchmark& benchmark, int threads, const BenchOptions& options,
                            const fs::path& folder) {
  const fs::path report = folder / "report.json", log = folder / "log.txt";
  std::vector<std::string> arguments{"run"};
  arguments.insert(arguments.end(), benchmark.arguments.begin(), benchmark.arguments.end());
  for (const std::string& word :
       {std::string("--threads"), std::to_string(threads), std::string("--report"), report.string()})
    arguments.push_back(word);
  if (has_pictures(benchmark)) {
    arguments.emplace_back("-o");
    arguments.push_back((folder / "video.mp4").string());
  }
  if (options.has_audit) arguments.emplace_back("--audit");
  if (options.is_brief) {
    arguments.emplace_back("--seconds");
    arguments.emplace_back("0.1");
  }
  const int status = run_again(arguments, log);
  const auto json = nlohmann::json::parse(report::read_text(report), nullptr, false);
  const bool is_done =
      status == kDone || (options.has_audit && status == kDiffers);  // the table tells the findings
  if (!is_done || json.is_discarded()) {
    fmt::print(stderr, "{}: ended with status {}\n{}\n", benchmark.name, status, report::read_text(log));
    return std::nullopt;
  }
  Json row = bench_row(benchmark.name, json);
  std::string command = "shatterbox";
  for (const std::string& word : arguments) command += " " + word;
  row["command"] = command;
  return row;
}

std::string number(const Json& value, int digits) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), digits) : "-";
}

/// "12.3 / 45.6 / 78.9", or "-" where the phase had no frame.
std::string spread(const Json& phase) {
  if (phase["frames"] == 0) return "-";
  return fmt::format("{} / {} / {}", number(phase["median"], 1), number(phase["p95"], 1),
                     number(phase["max"], 1));
}

/// Where the time of the dearest frame went.
std::string dearest_line(const Json& row) {
  const Json& frame = row["dearest"];
  std::string text =
      fmt::format("{}: dearest frame {} ms", row["name"].get<std::string>(), number(frame["ms"], 0));
  for (const auto& [stage, time] : frame["stages"].items())
    if (time.get<double>() >= 0.01 * frame["ms"].get<double>())
      text += fmt::format(", {} {}", stage, number(time, 0));
  return text +
         fmt::format("; {} breaks, {} solves\n", frame["breaks"].get<long>(), frame["solves"].get<long>());
}

/// A benchmark is named in full, or, where that names none, by how its name begins.
bool names_it(const std::string& name, const Benchmark& benchmark) {
  const auto& list = benchmarks();
  const bool is_exact =
      std::any_of(list.begin(), list.end(), [&](const Benchmark& other) { return other.name == name; });
  return is_exact ? benchmark.name == name : benchmark.name.rfind(name, 0) == 0;
}

std::vector<Benchmark> chosen(const std::vector<std::string>& names) {
  std::vector<Benchmark> list;
  for (const Benchmark& benchmark : benchmarks()) {
    const bool is_named = std::any_of(names.begin(), names.end(),
                                      [&](const std::string& name) { return names_it(name, benchmark); });
    if (names.empty() || is_named) list.push_back(benchmark);
  }
  return list;
}

}  // namespace

const std::vector<Benchmark>& benchmarks() {
  const auto pile = [](const char* count, const char* sleep) {
    return std::vector<std::string>{"boats_pile", "--no-render",
                                    "--set",      std::string("boats.repeat.count=") + count,
                                    "--set",      std::string("scene.sleep=") + sleep};
  };
  const auto lasting = [](std::vector<std::string> arguments, const char* seconds) {
    arguments.insert(arguments.end(), {"--set", std::string("scene.seconds=") + seconds});
    return arguments;
  };
  const auto solid = [&](const char* scene, const char* element_size) {
    return lasting({scene, "--no-render", "--set", element_size}, "0.6");
  };
  static const std::vector<Benchmark> list{
      {"boats_10", "10 boats, sleep off", pile("10", "false")},
      {"boats_100", "100 boats, sleep off", pile("100", "false")},
      {"boats_1000", "1000 boats, sleep off", pile("1000", "false")},
      {"boats_rest", "100 boats until they sleep", lasting(pile("100", "true"), "20")},
      {"bowls", "50 bowls poured into a large one", {"bowls", "--no-render"}},
      {"card_house", "26 cards stand, then fall", {"card_house", "--no-render"}},
      {"plate_stack", "a stack of plates, hit", {"plate_stack", "--no-render"}},
      {"ornaments", "100 ornaments shatter", {"ornaments", "--no-render"}},
      {"bunny", "100 000 tetrahedra break", solid("bunny", "bunny.element_size=0.0117"),
       "/usr/share/glmark2/models/bunny.obj"},
      {"armadillo", "110 000 tetrahedra break", solid("armadillo", "figure.element_size=0.0105")},
      {"ornament", "one ornament, drawn and encoded", {"ornament"}},
      {"window", "one window, drawn and encoded", {"window"}},
      {"bowl", "one bowl, drawn and encoded", {"bowl"}},
      {"ornament_full", "one ornament in full quality", {"ornament", "--quality", "full"}},
      {"window_full", "one window in full quality", {"window", "--quality", "full"}},
      {"bowl_full", "one bowl in full quality", {"bowl", "--quality", "full"}},
  };
  return list;
}

nlohmann::ordered_json bench_row(const std::string& name, const nlohmann::json& report) {
  Json row;
  row["name"] = name;
  row["threads"] = report["threads"];
  row["state_hash"] = report["state_hash"];
  row["bodies"] = report["bodies"]["end"];
  row["pieces"] = report["pieces"];
  row["triangles"] = report["triangles"]["max"];
  row["contacts"] = report["contact"]["most"];
  row["frame"] = report["time_ms"]["frame"];
  row["phases"] = report["time_ms"]["phases"];
  row["stages"] = report["time_ms"]["stages"];
  row["dearest"] = report["time_ms"]["dearest"];
  row["load_ms"] = report["load_ms"];
  row["memory_mb"] = report["peak_memory_mb"];
  row["frozen_share"] = report["contact"]["frozen_share"];
  const bool is_audited = report.contains("audit") && report["audit"].value("on", false);
  row["crossings"] = is_audited ? Json(report["audit"]["crossings"]) : Json(nullptr);
  row["passages"] = is_audited ? Json(report["audit"]["passages"]) : Json(nullptr);
  const Json &rest = row["phases"]["rest"], &frame = row["frame"];
  const bool has_rest = rest["frames"].get<int>() > 0 && frame["max"].get<double>() > 0.0;
  row["rest_share"] =
      has_rest ? Json(rest["median"].get<double>() / frame["max"].get<double>()) : Json(nullptr);
  return row;
}

std::string bench_table(const nlohmann::ordered_json& rows) {
  std::string text =
      "ms a frame: median / 95th percentile / worst; rest: median, share of the worst frame\n" +
      fmt::format("{:<14}{:>3} {:>22} {:>22} {:>22} {:>20} {:>14} {:>8} {:>7} {:>7} {:>9} {:>9}\n", "", "thr",
                  "busy", "all", "after the break", "breaking frames", "rest", "contacts", "pieces", "MB",
                  "failsafe", "crossings");
  for (const Json& row : rows) {
    const Json& phases = row["phases"];
    const Json& rest = phases["rest"];
    const Json& frame = row["frame"];
    const std::string at_rest = rest["frames"] == 0
                                    ? "-"
                                    : fmt::format("{} {}%", number(rest["median"], 2),
                                                  number(Json(100.0 * row["rest_share"].get<double>()), 1));
    const std::string crossings =
        row["crossings"].is_null()
            ? "-"
            : fmt::format("{} + {}", row["crossings"].get<long>(), row["passages"].get<long>());
    text += fmt::format("{:<14}{:>3} {:>22} {:>22} {:>22} {:>20} {:>14} {:>8} {:>7} {:>7} {:>8}% {:>9}\n",
                        row["name"].get<std::string>(), row["threads"].get<int>(), spread(phases["busy"]),
                        fmt::format("{} / {} / {}", number(frame["median"], 1), number(frame["p95"], 1),
                                    number(frame["max"], 1)),
                        spread(phases["after"]), spread(phases["breaking"]), at_rest,
                        row["contacts"].get<long>(), row["pieces"].get<long>(), number(row["memory_mb"], 0),
                        number(Json(100.0 * row["frozen_share"].get<double>()), 2), crossings);
  }
  for (const Json& row : rows)
    if (row["pieces"] > 0) text += dearest_line(row);
  return text;
}

int run_bench(const BenchOptions& options) {
  std::vector<std::string> known;
  for (const Benchmark& benchmark : benchmarks()) known.push_back(benchmark.name);
  for (const std::string& name : options.names) {
    if (!chosen({name}).empty()) continue;
    fmt::print(stderr, "there is no benchmark \"{}\"\n    {}\n", name,
               scene::hint_for_name(name, known, "benchmarks"));
    return kBadInput;
  }
  const WorkFolder folder;
  if (folder.path().empty()) {
    fmt::print(stderr, "failed: {}\n", folder.fault());
    return kFailed;
  }
  catch_interrupts();
  Json rows = Json::array();
  bool has_failed = false;
  for (const Benchmark& benchmark : chosen(options.names)) {
    if (!benchmark.needs.empty() && !fs::exists(benchmark.needs)) {
      fmt::print(stderr, "{} is left out: sudo apt install glmark2-data\n", benchmark.name);
      continue;
    }
    for (const int threads : options.threads) {
      if (is_interrupted()) break;
      fmt::print(stderr, "{}: {}\n", benchmark.name, benchmark.what);
      if (auto row = measure(benchmark, threads, options, folder.path())) {
        rows.push_back(std::move(*row));
      } else {
        has_failed = true;
      }
    }
  }
  fmt::print("{}", bench_table(rows));
  std::fflush(stdout);
  if (!options.report.empty()) {
    const std::string fault = report::write_text(options.report, rows.dump(2) + "\n");
    if (!fault.empty()) {
      fmt::print(stderr, "failed: {}\n", fault);
      return kFailed;
    }
  }
  return has_failed || is_interrupted() ? kFailed : kDone;
}

}  // namespace shatterbox::sandbox::run
