#include "sandbox/run/batch.h"

#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sandbox/report/table_file.h"
#include "sandbox/report/text_file.h"
#include "sandbox/run/again.h"
#include "sandbox/run/batch_plan.h"
#include "sandbox/run/gallery.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/job.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;

struct Row {
  BatchRun run;
  fs::path folder;
  std::vector<std::string> words;  // of the command line
  int status = -1;                 // -1: not run
  nlohmann::json report;           // null: there is none
};

bool has_word(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Options and their values as words of their own: `--threads=2` and `-oFILE` are two each.
std::vector<std::string> parted(const std::vector<std::string>& words) {
  std::vector<std::string> parts;
  for (const std::string& word : words) {
    const bool is_long = word.rfind("--", 0) == 0;
    const std::size_t sign = is_long ? word.find('=') : std::string::npos;
    const std::size_t end = !is_long && word.rfind("-o", 0) == 0 ? 2 : sign;
    parts.push_back(word.substr(0, end));
    if (end < word.size()) parts.push_back(word.substr(end + (is_long ? 1 : 0)));
  }
  return parts;
}

/// The run works in its own folder: files named on the command line of the batch are found from there too.
std::vector<std::string> words_of(const BatchRun& run, const BatchOptions& options, int jobs) {
  std::vector<std::string> words{"run", run.scene, "--report", "report.json"};
  for (const auto& [key, value] : run.values) words.insert(words.end(), {"--set", key + "=" + value});
  const std::vector<std::string> own = parted(options.run_words);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const bool is_file = i > 0 && own[i - 1] == "--script";
    words.push_back(is_file ? fs::absolute(own[i]).string() : own[i]);
  }
  if (!has_word(words, "--no-render") && !has_word(words, "-o"))
    words.insert(words.end(), {"-o", "film.mp4"});
  if (options.has_gallery && !has_word(words, "--no-render") && !has_word(words, "--record"))
    words.insert(words.end(), {"--record", kGalleryRecording});
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (!has_word(words, "--threads"))
    words.insert(words.end(), {"--threads", fmt::format("{}", std::max(1, cores / jobs))});
  return words;
}

nlohmann::json read_json_file(const fs::path& file) {
  const std::string text = report::read_text(file.string());
  return nlohmann::json::parse(text, nullptr, false);
}

/// What is done says so in words of its own: the command line and how it ended.
bool is_done(Row& row) {
  const nlohmann::json done = read_json_file(row.folder / "done.json");
  if (!done.is_object() || done.value("words", nlohmann::json()) != nlohmann::json(row.words)) return false;
  row.status = done.value("status", kFailed);
  return true;
}

void finish(Row& row, int status) {
  row.status = status;
  if (is_interrupted()) return;
  const nlohmann::json done = {{"words", row.words}, {"status", status}};
  (void)report::write_text((row.folder / "done.json").string(), done.dump(1) + "\n");
}

/// The first lines of a log, which say what is wrong with a run's words or scene.
std::string first_lines(const fs::path& log) {
  constexpr int kMost = 4;
  std::istringstream text(report::read_text(log.string()));
  std::string lines, line;
  for (int k = 0; k < kMost && std::getline(text, line); ++k) lines += "    " + line + "\n";
  return lines;
}

/// Runs what is not done, `jobs` at a time, in the order of the table.
void run_rows(std::vector<Row>& rows, int jobs, bool resumes) {
  std::map<pid_t, Row*> running;
  std::size_t next = 0, count = 0;
  bool is_ending = false;
  while (next < rows.size() || !running.empty()) {
    while (!is_interrupted() && next < rows.size() && running.size() < static_cast<std::size_t>(jobs)) {
      Row& row = rows[next++];
      if (row.status >= 0) continue;
      std::vector<std::string> words = row.words;
      if (resumes) words.push_back("--resume");
      const pid_t child = start_again(words, row.folder, row.folder / "log.txt");
      if (child > 0) {
        running[child] = &row;
        continue;
      }
      row.status = kFailed;  // and not done: --resume tries again
      fmt::print(stderr, "{} of {}: {} cannot be started: {}\n", ++count, rows.size(), row.run.name,
                 std::strerror(errno));
    }
    if (is_interrupted() && !is_ending) {  // each ends in order, and goes on with --resume
      for (const auto& [child, row] : running) kill(child, SIGINT);
      is_ending = true;
      next = rows.size();
    }
    for (auto child = running.begin(); child != running.end();) {
      int status = 0;
      if (waitpid(child->first, &status, WNOHANG) == 0) {
        ++child;
        continue;
      }
      Row& row = *child->second;
      finish(row, WIFEXITED(status) ? WEXITSTATUS(status) : kFailed);
      fmt::print(stderr, "{} of {}: {}{}\n", ++count, rows.size(), row.run.name,
                 row.status == kDone ? ""
                                     : fmt::format(" ended with status {}: see {}", row.status,
                                                   (row.folder / "log.txt").string()));
      if (row.status == kBadInput) fmt::print(stderr, "{}", first_lines(row.folder / "log.txt"));
      child = running.erase(child);
    }
    if (!running.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

report::Cell number_of(const nlohmann::json& value) {
  return value.is_number() ? report::Cell{value.get<double>()} : report::Cell{};
}

double sum_of(const nlohmann::json& rows, const char* key) {
  double sum = 0.0;
  for (const auto& row : rows) sum += row[key].is_number() ? row[key].get<double>() : 0.0;
  return sum;
}

double greatest(const nlohmann::json& rows, const char* key) {
  double most = 0.0;
  for (const auto& row : rows) most = std::max(most, row[key].is_number() ? row[key].get<double>() : 0.0);
  return most;
}

const std::vector<report::Column> kResults{{"status", "1"},
                                           {"pieces", "1"},
                                           {"breaks", "1"},
                                           {"impacts", "1"},
                                           {"greatest_ratio", "1"},
                                           {"new_area_m2", "m2"},
                                           {"fracture_energy_j", "J"},
                                           {"simulated_s", "s"},
                                           {"wall_s", "s"},
                                           {"frame_median_ms", "ms"},
                                           {"state_hash", ""}};

std::vector<report::Cell> results_of(const Row& row) {
  const report::Cell status = row.status < 0 ? report::Cell{} : report::Cell{static_cast<long>(row.status)};
  // One of a comparison has several runs in it, and no results of its own.
  if (!row.report.is_object() || row.report.contains("shots")) {
    std::vector<report::Cell> nothing(kResults.size());
    nothing.front() = status;
    return nothing;
  }
  const auto& r = row.report;
  return {status,
          r["pieces"].get<long>(),
          static_cast<long>(r["breaks"].size()),
          static_cast<long>(r["impacts"].size()),
          greatest(r["impacts"], "ratio"),
          sum_of(r["breaks"], "new_area_m2"),
          sum_of(r["breaks"], "fracture_energy_j"),
          number_of(r["simulated_seconds"]),
          number_of(r["wall_seconds"]),
          number_of(r["time_ms"]["frame"]["median"]),
          r["state_hash"].get<std::string>()};
}

struct Shown {
  std::string operator()(std::monostate) const { return "-"; }
  std::string operator()(long number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const { return fmt::format("{:.4g}", number); }
  std::string operator()(const std::string& text) const { return text; }
};

/// The table on the screen and in summary.csv and .json. A sentence if they cannot be written.
std::string tell(const std::vector<Row>& rows, const std::vector<Sweep>& sweeps, const fs::path& folder) {
  std::vector<report::Column> columns{{"run", ""}};
  for (const Sweep& sweep : sweeps) columns.push_back({sweep.key.c_str(), ""});
  columns.insert(columns.end(), kResults.begin(), kResults.end());
  report::TableFile file(folder.string(), "summary", columns);
  std::vector<std::vector<std::string>> lines(1);
  for (const report::Column& column : columns) lines[0].emplace_back(column.name);
  for (const Row& row : rows) {
    std::vector<report::Cell> cells{row.run.name};
    for (const auto& [key, value] : row.run.values) cells.emplace_back(value);
    for (report::Cell& cell : results_of(row)) cells.push_back(std::move(cell));
    file.add_row(cells);
    auto& line = lines.emplace_back();
    for (const report::Cell& cell : cells) line.push_back(std::visit(Shown{}, cell));
  }
  std::vector<std::size_t> widths(columns.size(), 0);
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) text += fmt::format("{:<{}}  ", line[i], widths[i]);
    fmt::print("{}\n", text.substr(0, text.find_last_not_of(' ') + 1));
  }
  return file.close();
}

}  // namespace

int run_batch(const BatchOptions& options) {
  scene::Problems problems;
  std::vector<Sweep> sweeps;
  for (const std::string& text : options.sweeps) sweeps.push_back(parse_sweep(text, problems));
  std::vector<Row> rows;
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int jobs = options.jobs > 0 ? options.jobs : cores;
  BatchPlan plan = plan_batch(options.scenes, sweeps, options.with, problems);
  for (BatchRun& run : plan.runs) {
    const fs::path folder = fs::absolute(fs::path(options.folder) / run.name);
    std::vector<std::string> words = words_of(run, options, jobs);
    rows.push_back({std::move(run), folder, std::move(words), -1, {}});
  }
  if (!problems.empty()) return refuse(problems);
  Outputs outputs, rooms;  // rooms are the runs' own, who may say that they write there
  outputs.write_folder("-o", options.folder);
  for (const Row& row : rows) rooms.write_folder("-o", row.folder.string());
  outputs.check(problems);
  rooms.check(problems);
  if (problems.empty()) outputs.take(problems);
  for (const Row& row : rows) {
    std::error_code code;
    if (problems.empty() && !fs::create_directories(row.folder, code) && code)
      scene::book(problems, scene::Place{"-o", 0, 0},
                  fmt::format("folder {} cannot be made: {}", row.folder.string(), code.message()));
  }
  if (!problems.empty()) return refuse(problems);
  for (const LeftOut& left : plan.left_out)
    fmt::print(stderr, "left out: {} (takes {}); --with {} takes it in\n", left.name, left.takes, left.name);
  catch_interrupts();
  for (Row& row : rows) {
    std::error_code ignored;
    if (options.resumes && is_done(row)) continue;
    fs::remove(row.folder / "done.json", ignored);
    fs::remove(row.folder / "report.json", ignored);
  }
  run_rows(rows, jobs, options.resumes);
  int worst = kDone;
  for (Row& row : rows) {
    row.report = read_json_file(row.folder / "report.json");
    worst = std::max(worst, row.status);
  }
  std::string fault = tell(rows, sweeps, options.folder);
  if (fault.empty() && options.has_gallery) {
    std::vector<Exhibit> exhibits;
    for (const Row& row : rows)
      exhibits.push_back({row.run.name, row.folder, row.report, measure_drawing(row.folder)});
    fault = write_gallery(options.folder, exhibits, plan.left_out);
  }
  std::fflush(stdout);
  if (!fault.empty()) fmt::print(stderr, "failed: {}\n", fault);
  return !fault.empty() || is_interrupted() ? kFailed : worst;
}

}  // namespace shatterbox::sandbox::run
