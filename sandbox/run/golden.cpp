#include "sandbox/run/golden.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sandbox/compare/difference_report.h"
#include "sandbox/report/text_file.h"
#include "sandbox/run/again.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kGoldenVersion = 1;

/// What the program says when it refuses or fails.
struct Refusal {
  int status = kBadInput;
  std::string words;
};

int tell(const Refusal& refusal) {
  fmt::print(stderr, "{}\n", refusal.words);
  return refusal.status;
}

/// The options of `run` that make the pictures what they are.
std::vector<std::string> arguments_of(const Options& options) {
  std::vector<std::string> words{"--size",        options.size, "--quality",
                                 options.quality, "--fps",      std::to_string(options.frames_per_second)};
  const auto add = [&words](const char* option, const std::string& value) {
    words.emplace_back(option);
    words.push_back(value);
  };
  if (options.seconds) add("--seconds", fmt::format("{}", *options.seconds));
  if (options.seed) add("--seed", fmt::format("{}", *options.seed));
  for (const std::string& change : options.overrides) add("--set", change);
  std::string moments;
  for (const double time : options.stills) moments += fmt::format("{}{}", moments.empty() ? "" : ",", time);
  add("--stills", moments);
  return words;
}

/// A file is kept by its way from the golden's folder, so that both can move together.
std::string seen_from(const fs::path& folder, const std::string& file) {
  std::error_code code;
  return fs::exists(file, code) ? fs::relative(fs::absolute(file), fs::absolute(folder), code).string()
                                : file;
}

std::string file_of(const fs::path& folder, const std::string& kept) {
  std::error_code code;
  const fs::path file = (folder / kept).lexically_normal();
  return fs::exists(file, code) ? file.string() : kept;
}

/// Plays a golden's scene into `work`/frames; its report.
std::optional<nlohmann::json> play(const Json& golden, const fs::path& folder, const fs::path& work,
                                   Refusal& refusal) {
  std::vector<std::string> words{"run", file_of(folder, golden["scene"])};
  for (const auto& word : golden["arguments"]) words.push_back(word);
  if (golden.contains("script")) {
    words.emplace_back("--script");
    words.push_back(file_of(folder, golden["script"]));
  }
  const std::string report = (work / "report.json").string();
  for (const std::string& word :
       {std::string("--frames"), (work / "frames").string(), std::string("--report"), report})
    words.push_back(word);
  const int status = run_again(words, work / "log.txt");
  if (status != kDone) {
    refusal = {status, report::read_text((work / "log.txt").string())};
    return std::nullopt;
  }
  return nlohmann::json::parse(report::read_text(report), nullptr, false);
}

std::optional<Json> read_golden(const fs::path& folder, Refusal& refusal) {
  const fs::path file = folder / "golden.json";
  Json json = Json::parse(report::read_text(file.string()), nullptr, false);
  const auto has = [&json](const char* key, Json::value_t kind) {
    return json.contains(key) && json[key].type() == kind;
  };
  const bool is_good = json.is_object() && json.contains("golden_version") &&
                       json["golden_version"] == kGoldenVersion && has("scene", Json::value_t::string) &&
                       has("arguments", Json::value_t::array) && has("state_hash", Json::value_t::string) &&
                       has("reasons", Json::value_t::array) &&
                       (!json.contains("script") || json["script"].is_string()) &&
                       std::all_of(json["arguments"].begin(), json["arguments"].end(),
                                   [](const Json& word) { return word.is_string(); });
  if (is_good) return json;
  refusal = {kBadInput, fmt::format("{}: is no golden of version {}", file.string(), kGoldenVersion)};
  return std::nullopt;
}

/// Names of the goldens in a folder, ascending; those of `wanted` alone, if any are.
std::optional<std::vector<std::string>> find_goldens(const std::string& folder,
                                                     const std::vector<std::string>& wanted,
                                                     Refusal& refusal) {
  std::vector<std::string> known;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code))
    if (fs::exists(entry.path() / "golden.json", code)) known.push_back(entry.path().filename().string());
  std::sort(known.begin(), known.end());
  if (known.empty()) {
    refusal.words = fmt::format(
        "{}: there is no golden in this folder\n    make one: shatterbox golden make {} SCENE --stills 0.5 "
        "--reason \"first\"",
        folder, folder);
    return std::nullopt;
  }
  for (const std::string& name : wanted)
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      refusal.words = fmt::format("there is no golden \"{}\"\n    {}", name,
                                  scene::hint_for_name(name, known, "goldens"));
      return std::nullopt;
    }
  return wanted.empty() ? known : wanted;
}

/// Plays `golden` and puts it, with its pictures, in place of what is in `folder`.
bool keep(Json golden, const fs::path& folder, const std::string& reason, Refusal& refusal) {
  const WorkFolder work;
  const auto report = play(golden, folder, work.path(), refusal);
  if (!report) return false;
  golden["state_hash"] = (*report)["state_hash"];
  golden["made_with"] = {{"version", (*report)["version"]},
                         {"compiler", (*report)["compiler"]},
                         {"gl_renderer", (*report)["gl_renderer"]}};
  golden["reasons"].push_back(
      {{"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::now()))},
       {"reason", reason},
       {"state_hash", golden["state_hash"]}});
  // The whole golden beside its name, then in its place: one that is there already stays until then.
  const fs::path part = folder.string() + ".part";
  std::error_code code;
  fs::remove_all(part, code);
  fs::create_directories(part, code);
  if (!code) fs::copy(work.path() / "frames", part, code);
  std::string fault = code ? fmt::format("{}: {}", part.string(), code.message())
                           : report::write_text((part / "golden.json").string(), golden.dump(2) + "\n");
  if (fault.empty()) {
    fs::remove_all(folder, code);
    fs::rename(part, folder, code);
    if (code) fault = fmt::format("{}: {}", folder.string(), code.message());
  }
  if (!fault.empty()) refusal = {kFailed, "failed: " + fault};
  return fault.empty();
}

struct Checked {
  std::string name;
  std::string failure;  // empty: as it must be
  std::string words;    // for people
  compare::FilmDifference pictures;
};

std::optional<Checked> check(const std::string& name, const GoldenOptions& options,
                             const compare::Tolerance& tolerance, Refusal& refusal) {
  const fs::path folder = fs::path(options.folder) / name;
  const auto golden = read_golden(folder, refusal);
  if (!golden) return std::nullopt;
  const WorkFolder work;
  const auto report = play(*golden, folder, work.path(), refusal);
  if (!report) return std::nullopt;
  std::string differences;
  if (!options.findings.pictures_folder.empty()) {
    differences = (fs::path(options.findings.pictures_folder) / name).string();
    std::error_code code;
    fs::create_directories(differences, code);
  }
  Checked checked{name, {}, {}, {}};
  compare::Film expected(folder), actual(work.path() / "frames");
  checked.pictures = compare::compare_films(expected, actual, tolerance, differences);
  if (!checked.pictures.error.empty()) {
    refusal = {kBadInput, checked.pictures.error};
    return std::nullopt;
  }
  const std::string was = (*golden)["state_hash"], is = (*report)["state_hash"];
  if (was != is) checked.failure = fmt::format("the state is {}, not {}", is, was);
  if (const auto* first = checked.pictures.first()) {
    checked.failure +=
        fmt::format("{}{}: {}", checked.failure.empty() ? "" : "; ", first->name, first->excess);
  }
  checked.words =
      fmt::format("state {}; {}", was == is ? "equal" : "differs", compare::describe(checked.pictures));
  return checked;
}

std::string tell_findings(const GoldenOptions& options, const std::vector<Checked>& all) {
  Json rows = Json::array();
  std::vector<compare::TestCase> cases;
  for (const Checked& one : all) {
    rows.push_back({{"name", one.name},
                    {"same", one.failure.empty()},
                    {"why", one.failure},
                    {"pictures", compare::make_json(one.pictures)}});
    cases.push_back({one.name, one.failure});
  }
  return write_findings(options.findings, rows, "shatterbox golden", cases);
}

bool is_plain(const std::string& name) {
  return !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
}

int make_one(const GoldenOptions& options) {
  if (options.run.stills.empty())
    return tell({kBadInput, "golden make: which moments? for example --stills 0.3,0.5"});
  const std::string name = options.name.empty() ? fs::path(options.run.scene).stem().string() : options.name;
  if (!is_plain(name))
    return tell({kBadInput, fmt::format("\"{}\" is no name for a golden: letters, digits, _ - .", name)});
  const fs::path folder = fs::path(options.folder) / name;
  Json golden{{"golden_version", kGoldenVersion}, {"scene", seen_from(folder, options.run.scene)}};
  if (!options.run.script.empty()) golden["script"] = seen_from(folder, options.run.script);
  golden["arguments"] = arguments_of(options.run);
  golden["reasons"] = Json::array();
  Refusal refusal;
  if (fs::exists(folder / "golden.json")) {  // what was said before stays
    const auto old = read_golden(folder, refusal);
    if (!old) return tell(refusal);
    golden["reasons"] = (*old)["reasons"];
  }
  if (!keep(std::move(golden), folder, options.reason, refusal)) return tell(refusal);
  fmt::print("made {}\n", folder.string());
  return kDone;
}

}  // namespace

int make_goldens(const GoldenOptions& options) {
  catch_interrupts();
  if (options.reason.empty())
    return tell({kBadInput, "golden make: why? --reason \"...\" is kept with the golden"});
  if (!options.run.scene.empty()) return make_one(options);
  Refusal refusal;
  const auto names = find_goldens(
      options.folder, options.name.empty() ? std::vector<std::string>{} : std::vector{options.name}, refusal);
  if (!names) return tell(refusal);
  for (const std::string& name : *names) {
    if (is_interrupted()) return kFailed;
    const fs::path folder = fs::path(options.folder) / name;
    auto golden = read_golden(folder, refusal);
    if (!golden || !keep(std::move(*golden), folder, options.reason, refusal)) return tell(refusal);
    fmt::print("made {} again\n", folder.string());
    std::fflush(stdout);
  }
  return kDone;
}

int check_goldens(const GoldenOptions& options) {
  catch_interrupts();
  Refusal refusal;
  const auto tolerance = compare::parse_tolerance(options.findings.tolerance, refusal.words);
  if (!tolerance) return tell({kBadInput, "--tolerance: " + refusal.words});
  scene::Problems problems;
  prepare_findings(options.findings, problems);
  if (!problems.empty()) return tell({kBadInput, scene::describe(problems)});
  const auto names = find_goldens(options.folder, options.names, refusal);
  if (!names) return tell(refusal);
  std::vector<Checked> all;
  for (const std::string& name : *names) {
    if (is_interrupted()) return kFailed;
    auto checked = check(name, options, *tolerance, refusal);
    if (!checked) return tell({refusal.status, fmt::format("{}: {}", name, refusal.words)});
    fmt::print("{}: {}", name, checked->words);
    std::fflush(stdout);
    all.push_back(std::move(*checked));
  }
  const std::string fault = tell_findings(options, all);
  if (!fault.empty()) return tell({kFailed, "failed: " + fault});
  const auto failures =
      std::count_if(all.begin(), all.end(), [](const Checked& one) { return !one.failure.empty(); });
  if (failures > 0)
    fmt::print("{} of {} differ. If that is meant: shatterbox golden make {} --reason \"...\"\n", failures,
               all.size(), options.folder);
  std::fflush(stdout);
  return failures > 0 ? kDiffers : kDone;
}

}  // namespace shatterbox::sandbox::run
