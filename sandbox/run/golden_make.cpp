#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "sandbox/report/text_file.h"
#include "sandbox/run/again.h"
#include "sandbox/run/golden.h"
#include "sandbox/run/golden_folder.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/scene/find_scene.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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

/// The whole golden beside its name, then in its place: one that is there already stays until then. A
/// sentence if that fails.
std::string put_in_place(const Json& golden, const fs::path& frames, const fs::path& folder) {
  const fs::path part = folder.string() + ".part";
  std::error_code code;
  fs::remove_all(part, code);
  fs::create_directories(part, code);
  if (!code) fs::copy(frames, part, code);
  std::string fault = code ? fmt::format("{}: {}", part.string(), code.message())
                           : report::write_text((part / "golden.json").string(), golden.dump(2) + "\n");
  if (fault.empty()) {
    fs::remove_all(folder, code);
    fs::rename(part, folder, code);
    if (code) return fmt::format("{}: {}", folder.string(), code.message());
  }
  if (!fault.empty()) fs::remove_all(part, code);
  return fault;
}

/// Plays `golden` and puts it, with its pictures, in place of what is in `folder`.
bool keep(Json golden, const fs::path& folder, const std::string& reason, Refusal& refusal) {
  Outputs outputs;
  scene::Problems problems;
  add_inputs(golden, folder, "SCENE", outputs);  // they must not lie where the golden will be put
  outputs.replace_folder("DIR", folder.string());
  outputs.check(problems);
  const WorkFolder work;
  if (!work.fault().empty()) refusal = {kFailed, work.fault()};
  if (!problems.empty()) refusal = {kBadInput, scene::describe(problems)};
  if (!problems.empty() || !work.fault().empty()) return false;
  const auto report = play_golden(golden, folder, work.path(), refusal);
  if (!report) return false;
  const nlohmann::json& first = report->contains("shots") ? report->at("shots").at(0) : *report;
  golden["state_hash"] = state_of(*report);
  golden["made_with"] = {{"version", first.at("version")},
                         {"compiler", first.at("compiler")},
                         {"gl_renderer", first.at("gl_renderer")}};
  golden["reasons"].push_back(
      {{"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::now()))},
       {"reason", reason},
       {"state_hash", golden["state_hash"]}});
  outputs.take(problems);
  if (!problems.empty()) refusal = {kBadInput, scene::describe(problems)};
  if (!problems.empty()) return false;
  const std::string fault = put_in_place(golden, work.path() / "frames", folder);
  if (!fault.empty()) refusal = {kFailed, "failed: " + fault};
  return fault.empty();
}

bool is_plain(const std::string& name) {
  return !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  });
}

std::string name_of(const std::string& scene) {
  return (fs::path(scene) / "").parent_path().stem().string();  // a folder may end in a slash
}

/// Where a scene, named or a file or a folder, is; empty if it is nowhere.
fs::path whereabouts_of(const std::string& scene) {
  scene::Problems ignored;
  std::error_code code;
  if (const auto shots = scene::find_shots(scene); !shots.empty())
    return fs::weakly_canonical(fs::path(shots.front()).parent_path(), code);
  const std::string file = scene::find_scene(scene, ignored);
  return file.empty() ? fs::path() : fs::weakly_canonical(file, code);
}

/// A golden that is there already keeps what was said before, and is not another scene's.
bool take_over(const fs::path& folder, const std::string& scene, Json& golden, Refusal& refusal) {
  const auto old = read_golden(folder, refusal);
  if (!old) return false;
  const std::string kept = file_of(folder, (*old)["scene"]);
  const fs::path former = whereabouts_of(kept);
  if (former.empty() || former == whereabouts_of(scene)) {
    golden["reasons"] = (*old)["reasons"];
    return true;
  }
  refusal = {kBadInput, fmt::format("{} is the golden of another scene, {}\n    give this one another name: "
                                    "--name NAME; or remove that one first",
                                    folder.string(), kept)};
  return false;
}

int make_one(const GoldenOptions& options) {
  if (options.run.stills.empty())
    return refuse({kBadInput, "golden make: which moments? for example --stills 0.3,0.5"});
  const std::string name = options.name.empty() ? name_of(options.run.scene) : options.name;
  if (!is_plain(name))
    return refuse(
        {kBadInput,
         fmt::format("\"{}\" is no name for a golden, which has letters a to z, digits, _ - . alone{}", name,
                     options.name.empty() ? "\n    give it one: --name NAME" : "")});
  const fs::path folder = fs::path(options.folder) / name;
  Json golden{{"golden_version", kGoldenVersion}, {"scene", seen_from(folder, options.run.scene)}};
  if (!options.run.script.empty()) golden["script"] = seen_from(folder, options.run.script);
  golden["arguments"] = arguments_of(options.run);
  golden["reasons"] = Json::array();
  Refusal refusal;
  if (fs::exists(folder / "golden.json") && !take_over(folder, options.run.scene, golden, refusal))
    return refuse(refusal);
  if (!keep(std::move(golden), folder, options.reason, refusal)) {
    if (is_interrupted()) refusal.words = "interrupted: " + folder.string() + " is as it was";
    return refuse(refusal);
  }
  fmt::print("made {}\n", folder.string());
  return kDone;
}

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

/// One that cannot be made again does not keep the others from it.
int make_again(const GoldenOptions& options) {
  Refusal refusal;
  const auto names = find_goldens(
      options.folder, options.name.empty() ? std::vector<std::string>{} : std::vector{options.name}, refusal);
  if (!names) return refuse(refusal);
  std::vector<std::string> made, left;
  int status = kDone;
  for (const std::string& name : *names) {
    const fs::path folder = fs::path(options.folder) / name;
    auto golden = is_interrupted() ? std::nullopt : read_golden(folder, refusal);
    if (golden && keep(std::move(*golden), folder, options.reason, refusal)) {
      fmt::print("made {} again\n", folder.string());
      std::fflush(stdout);
      made.push_back(name);
      continue;
    }
    left.push_back(name);
    if (is_interrupted()) continue;
    status = std::max(status, refuse({refusal.status, fmt::format("{}: {}", name, refusal.words)}));
  }
  if (is_interrupted() && !left.empty()) status = kFailed;
  if (!left.empty())
    fmt::print(stderr, "{}made again: {}; as before: {}\n", is_interrupted() ? "interrupted; " : "",
               joined_names(made), joined_names(left));
  return status;
}

}  // namespace

int make_goldens(const GoldenOptions& options) {
  catch_interrupts();
  if (options.reason.empty())
    return refuse({kBadInput, "golden make: why? --reason \"...\" is kept with the golden"});
  return options.run.scene.empty() ? make_again(options) : make_one(options);
}

}  // namespace shatterbox::sandbox::run
