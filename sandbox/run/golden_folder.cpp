#include "sandbox/run/golden_folder.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "sandbox/report/text_file.h"
#include "sandbox/run/again.h"
#include "sandbox/run/interrupt.h"
#include "sandbox/run/job.h"
#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_golden(const fs::path& folder) {
  std::error_code code;
  if (fs::exists(folder / "golden.json", code)) return true;
  if (folder.extension() == ".part") return false;  // one that was never whole
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    const fs::path file = entry.path().filename();
    if (file.string().starts_with("frame_") && file.extension() == ".png") return true;
  }
  return false;
}

/// Of a run that said nothing: its words may have found no room.
std::string silence_of(int status, const fs::path& work) {
  const std::string fault = report::write_text((work / "words.txt").string(), std::string(4096, '.'));
  return fmt::format("its run ended with status {} and {}", status,
                     fault.empty() ? "did not say why" : "could not say why: " + fault);
}

}  // namespace

int refuse(const Refusal& refusal) {
  fmt::print(stderr, "{}\n", refusal.words);
  return refusal.status;
}

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

std::optional<Json> read_golden(const fs::path& folder, Refusal& refusal) {
  const fs::path file = folder / "golden.json";
  std::error_code code;
  if (!fs::exists(file, code)) {
    refusal = {kBadInput, fmt::format("{}: is missing, and its pictures are there", file.string())};
    return std::nullopt;
  }
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

std::optional<std::vector<std::string>> find_goldens(const std::string& folder,
                                                     const std::vector<std::string>& wanted,
                                                     Refusal& refusal) {
  std::vector<std::string> known;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code))
    if (is_golden(entry.path())) known.push_back(entry.path().filename().string());
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

void add_inputs(const Json& golden, const fs::path& folder, const std::string& who, Outputs& outputs) {
  scene::Problems ignored;
  for (const std::string& shot : scene::shots_or_scene(file_of(folder, golden["scene"]))) {
    const std::string file = scene::find_scene(shot, ignored);
    if (!file.empty()) add_scene(who, file, scene::read_scene_file(file, {}, ignored), outputs);
  }
  if (golden.contains("script")) outputs.read_file("the script of " + who, file_of(folder, golden["script"]));
}

std::optional<nlohmann::json> play_golden(const Json& golden, const fs::path& folder, const fs::path& work,
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
  if (is_interrupted()) {
    refusal = {kFailed, "interrupted"};
    return std::nullopt;
  }
  if (status != kDone) {
    std::string said = report::read_text((work / "log.txt").string());
    said.erase(said.find_last_not_of('\n') + 1);
    if (said.empty()) said = silence_of(status, work);
    refusal = {status, std::move(said)};
    return std::nullopt;
  }
  auto json = nlohmann::json::parse(report::read_text(report), nullptr, false);
  if (json.is_object()) return json;
  refusal = {kFailed, fmt::format("{}: the report of its run cannot be read", report)};
  return std::nullopt;
}

std::string state_of(const nlohmann::json& report) {
  if (!report.contains("shots")) return report.at("state_hash");
  std::string states;
  for (const auto& shot : report.at("shots")) {
    if (!states.empty()) states += ' ';
    states += shot.at("state_hash").get<std::string>();
  }
  return states;
}

}  // namespace shatterbox::sandbox::run
