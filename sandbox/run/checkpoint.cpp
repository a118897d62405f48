#include "sandbox/run/checkpoint.h"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/hash.h"
#include "render/output/video_file.h"
#include "sandbox/recording/bytes.h"
#include "sandbox/report/json_report.h"
#include "sandbox/report/text_file.h"
#include "sandbox/run/exports.h"

namespace shatterbox::sandbox::run {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kCheckpointVersion = 1;
constexpr std::chrono::seconds kBetweenSaves{1};

void add_text(core::Hash& hash, const std::string& text) {
  hash.add(static_cast<std::uint64_t>(text.size()));
  recording::add_bytes(hash, text.data(), text.size());
}

/// Of the texts and of all that stands in the world at its start, meshes with it.
void add_job(core::Hash& hash, const Job& job) {
  add_text(hash, report::read_text(job.scene->file));
  if (!job.options.script.empty()) add_text(hash, report::read_text(job.options.script));
  for (const body::Body& body : job.built->world.bodies()) {
    hash.add(body.pose.translation).add(body.pose.rotation).add(body.shape->mass);
    for (const Vec3& p : body.shape->surface.positions) hash.add(p);
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string file_beside(const Options& options) {
  if (!options.video.empty()) return options.video + ".checkpoint";
  if (!options.frames_folder.empty()) return (fs::path(options.frames_folder) / "checkpoint").string();
  const std::vector<std::string> exports = export_outputs(options);
  const std::string first = exports.empty() ? options.report : exports.front();
  if (first.empty()) return {};
  return fs::is_directory(first) ? (fs::path(first) / "checkpoint").string() : first + ".checkpoint";
}

}  // namespace

Checkpoint::Checkpoint(const std::vector<const Job*>& jobs) : saved_(Clock::now()) {
  const Options& options = jobs.front()->options;
  file_ = file_beside(options);
  if (file_.empty()) return;  // nothing to keep, nothing to compare
  video_ = options.video;
  frames_folder_ = options.frames_folder;
  truth_folder_ = options.truth_folder;
  core::Hash scene;
  for (const Job* job : jobs) add_job(scene, *job);
  std::string stills;
  for (const double time : options.stills) stills += fmt::format("{} ", time);
  settings_ = {{"program", SHATTERBOX_VERSION},
               {"scene and its meshes", report::hex_digits(scene.value())},
               {"--set", joined(options.overrides)},
               {"--seconds", options.seconds ? fmt::format("{}", *options.seconds) : ""},
               {"--seed", options.seed ? fmt::format("{}", *options.seed) : ""},
               {"--size", options.size},
               {"--fps", fmt::format("{}", options.frames_per_second)},
               {"--quality", options.quality},
               {"--stills", stills},
               {"-o", options.video},
               {"--frames", options.frames_folder},
               {"--truth", options.truth_folder}};
}

void Checkpoint::load(scene::Problems& problems) {
  const scene::Place place{"--resume", 0, 0};
  if (file_.empty())
    return scene::book(problems, place, "this run has no output that a checkpoint could lie beside",
                       "ask for one: -o, --frames, --export, --tables, --meshes or --report");
  if (!fs::exists(file_)) {
    fmt::print(stderr, "there is no {}: the run begins at its start\n", file_);
    return;
  }
  try {
    const auto json = nlohmann::json::parse(report::read_text(file_));
    if (json.at("checkpoint_version") != kCheckpointVersion) throw std::runtime_error("of another version");
    for (const auto& [name, value] : settings_) {
      const std::string earlier = json.at("settings").at(name);
      if (earlier == value) continue;
      const bool is_option = name[0] == '-';
      scene::book(problems, place,
                  is_option ? fmt::format("the run that {} is of had {} \"{}\", this one \"{}\"", file_, name,
                                          earlier, value)
                            : fmt::format("the {} changed since the run that {} is of", name, file_),
                  "leave --resume out to begin at the start");
    }
    left_ = {json.at("shot"), json.at("steps"), json.at("state_hash")};
    keep_pictures(json.at("pictures"));
  } catch (const std::exception& error) {
    scene::book(problems, scene::Place{file_, 0, 0}, fmt::format("is no checkpoint: {}", error.what()),
                "leave --resume out to begin at the start");
  }
}

void Checkpoint::keep_pictures(const nlohmann::json& pictures) {
  for (const auto& entry : pictures) {
    const Picture picture{entry.at(0), std::stoull(entry.at(1).get<std::string>(), nullptr, 16)};
    if (!frames_folder_.empty() && !fs::exists(picture_file(frames_folder_, picture.number))) break;
    if (!truth_folder_.empty() && !fs::exists(truth_file(truth_folder_, picture.number))) break;
    kept_.push_back(picture);
  }
  if (video_.empty() || kept_.empty()) return;
  // The film may be ahead of what is known.
  const long encoded = render::count_kept_frames(video_, kept_.back().number + 1);
  while (!kept_.empty() && kept_.back().number >= encoded) kept_.pop_back();
}

void Checkpoint::discard() const {
  std::error_code ignored;
  if (!file_.empty()) fs::remove(file_, ignored);
}

std::string Checkpoint::pass(int shot, const world::World& world, const Painter* painter) {
  now_ = {shot, world.steps(), report::hex_digits(world.state_hash())};
  if (now_.shot == left_.shot && now_.steps == left_.steps && now_.hash != left_.hash)
    return fmt::format(
        "after {} steps the state is {}, and was {} in the run that {} is of: this is not that run; leave "
        "--resume out to begin at the start",
        now_.steps, now_.hash, left_.hash, file_);
  if (file_.empty() || Clock::now() - saved_ < kBetweenSaves) return {};
  return save(painter);
}

std::string Checkpoint::save(const Painter* painter) {
  if (file_.empty() || now_.shot < 0) return {};
  saved_ = Clock::now();
  nlohmann::ordered_json json = {{"checkpoint_version", kCheckpointVersion}};
  for (const auto& [name, value] : settings_) json["settings"][name] = value;
  json["shot"] = now_.shot;
  json["steps"] = now_.steps;
  json["state_hash"] = now_.hash;
  json["pictures"] = nlohmann::ordered_json::array();
  if (painter != nullptr)
    for (const Picture& picture : painter->pictures())
      json["pictures"].push_back({picture.number, report::hex_digits(picture.hash)});
  return report::write_text(file_, json.dump(1) + "\n");
}

}  // namespace shatterbox::sandbox::run
