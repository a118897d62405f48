#include "sandbox/run/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "sandbox/run/batch.h"
#include "sandbox/run/bench.h"
#include "sandbox/run/diff.h"
#include "sandbox/run/golden.h"
#include "sandbox/run/plan.h"
#include "sandbox/run/rendering.h"
#include "sandbox/run/run.h"
#include "sandbox/run/study.h"
#include "sandbox/scene/find_scene.h"
#include "sandbox/scene/nearest_name.h"

namespace shatterbox::sandbox::run {

namespace {

void add_scene_options(CLI::App& command, Options& options) {
  command.add_option("--set", options.overrides, "change a value: NAME.key=value, the value as in TOML")
      ->type_name("NAME.key=value")
      ->allow_extra_args(false);
  command.add_option("--script", options.script, "a file of [[event]] to play on the scene")
      ->type_name("FILE");
  command.add_option("--seconds", options.seconds, "how long to simulate, s");
  command.add_option("--seed", options.seed, "seed of flaws, grains and jitter");
}

/// A sentence if it is none of these names.
CLI::Validator one_of(std::vector<std::string> names) {
  return CLI::Validator(
      [names](std::string& text) {
        if (std::find(names.begin(), names.end(), text) != names.end()) return std::string();
        return "there is no \"" + text + "\"\n    " + scene::hint_for_name(text, names, "it takes");
      },
      "");
}

bool is_whole(const std::string& text, int least, int most) {
  if (text.empty() || text.size() > 4 || text.find_first_not_of("0123456789") != std::string::npos)
    return false;
  const int number = std::stoi(text);
  return number >= least && number <= most;
}

/// A sentence if there cannot be so many threads, or runs at a time.
std::string count_of_threads(const std::string& text) {
  if (is_whole(text, 0, 256)) return {};
  return "\"" + text + "\" is no count: from 0 to 256; 0 is one a core";
}

/// A sentence if it is no number of frames a second.
std::string whole_rate(const std::string& text) {
  if (is_whole(text, 1, 1000)) return {};
  return "\"" + text + "\" is no rate: whole frames a second, 1 to 1000; 24 for 23.976, 30 for 29.97";
}

void add_picture_options(CLI::App& command, Options& options) {
  command.add_option("--stills", options.stills, "draw these moments only, s")
      ->delimiter(',')
      ->type_name("TIME,..");
  command.add_option("--size", options.size, "picture size")
      ->capture_default_str()
      ->type_name("WIDTHxHEIGHT");
  command.add_option("--fps", options.frames_per_second, "frames a second")
      ->capture_default_str()
      ->check(whole_rate);
  command.add_option("--quality", options.quality, "preview or full")
      ->capture_default_str()
      ->check(one_of({"preview", "full"}));
}

void add_gl_option(CLI::App& command, std::string& name) {
  command.add_option("--gl", name, "who draws: osmesa (the usual one) or egl; the pictures are the same")
      ->type_name("NAME")
      ->check(one_of({"osmesa", "egl"}));
}

void add_run_options(CLI::App& command, Options& options) {
  command.add_option("-o", options.video, "video: .mp4 .mkv .webm .gif")->type_name("FILE");
  command.add_option("--frames", options.frames_folder, "folder for one PNG a frame")->type_name("DIR");
  command.add_option("--meshes", options.meshes_folder, "folder for one OBJ a frame")->type_name("DIR");
  command.add_option("--export", options.model, "animated model: glTF 2.0, .glb")->type_name("FILE");
  command
      .add_option("--tables", options.tables_folder,
                  "folder for bodies, trajectories, impacts, breaks: CSV, JSON")
      ->type_name("DIR");
  command
      .add_option("--truth", options.truth_folder,
                  "folder for depth, normals, ids and camera of each picture")
      ->type_name("DIR");
  command
      .add_option("--record", options.recording, "the pictures before they are drawn, for the verb render")
      ->type_name("FILE");
  command.add_option("--report", options.report, "report in JSON")->type_name("FILE");
  add_picture_options(command, options);
  add_gl_option(command, options.gl);
  command.add_option("--compare", options.compare, "two to four values of a setting, beside each other")
      ->type_name("NAME.key=a,b");
  command.add_option("--threads", options.threads, "threads of the simulation; 0: one a core")
      ->capture_default_str()
      ->check(count_of_threads);
  command.add_flag("--audit", options.has_audit,
                   "check after every step that nothing crosses; status 1 if it does");
  command.add_flag("--trace", options.has_trace,
                   "hashes behind every stage in the report: diff of two tells where they part");
  command.add_flag("--resume", options.resumes, "go on from where a run with these options was cut short");
  command.add_flag("!--no-render", options.has_pictures, "simulate only");
}

void add_render_options(CLI::App& command, RenderOptions& options) {
  command.add_option("RECORDING", options.recording, "what run --record has written")->required();
  command.add_option("--frames", options.frames, "these only, from 0: the first and the one behind the last")
      ->type_name("FIRST:END");
  command.add_option("-o", options.video, "video: .mp4 .mkv .webm .gif")->type_name("FILE");
  command.add_option("--pictures", options.pictures_folder, "folder for one PNG a frame")->type_name("DIR");
  command
      .add_option("--truth", options.truth_folder,
                  "folder for depth, normals, ids and camera of each picture")
      ->type_name("DIR");
  command.add_option("--report", options.report, "hashes and times of the frames in JSON")->type_name("FILE");
  command.add_option("--size", options.size, "picture size; as recorded without it")
      ->type_name("WIDTHxHEIGHT");
  command.add_option("--set", options.changes, "another camera: its position, target, up and fov")
      ->type_name("camera.key=value")
      ->allow_extra_args(false);
  command.add_option("--quality", options.quality, "preview or full; as recorded without it")
      ->check(one_of({"preview", "full"}));
  add_gl_option(command, options.gl);
  command.footer("For example: render film.rec --frames 100:200 -o part.mp4");
}

void add_bench_options(CLI::App& command, BenchOptions& options) {
  command.add_option("NAME", options.names, "benchmarks, or how their names begin; none: all");
  command
      .add_option("--threads", options.threads, "threads of the simulation; give several for one run each")
      ->capture_default_str()
      ->delimiter(',')
      ->check(count_of_threads);
  command.add_option("--report", options.report, "the table in JSON")->type_name("FILE");
  command.add_flag("--audit", options.has_audit, "count crossings and passages, in time of their own");
  command.add_flag("--brief", options.is_brief, "a tenth of a second each: does everything run?");
}

void add_batch_options(CLI::App& command, BatchOptions& options) {
  command.add_option("SCENE", options.scenes, "files, names, or folders of scenes")->required();
  command.add_option("-o", options.folder, "folder for the runs and the table")
      ->capture_default_str()
      ->type_name("DIR");
  command.add_option("--jobs", options.jobs, "runs at a time; 0: one a core")
      ->capture_default_str()
      ->check(count_of_threads);
  command.add_option("--sweep", options.sweeps, "values to run with in turn; several: all combinations")
      ->type_name("NAME.key=a,b,..")
      ->allow_extra_args(false);
  command
      .add_option("--with", options.with, "scenes of a folder that take long and are left out without this")
      ->type_name("NAME")
      ->delimiter(',');
  command.add_flag("--resume", options.resumes, "what is done is not done again, what was cut short goes on");
  command.add_flag("--gallery", options.has_gallery, "a page of the films: index.html");
  command.footer(
      "What stands behind -- are options of every run: batch scenes --jobs 2 -- --no-render --seconds 1");
}

void add_finding_options(CLI::App& command, FindingOptions& options) {
  command
      .add_option("--tolerance", options.tolerance,
                  "of pictures: default, exact, video, or levels=2,share=0.0001,..; of reports: exact, 0.01")
      ->capture_default_str();
  command.add_option("--report", options.report, "what was found, in JSON")->type_name("FILE");
  command.add_option("--junit", options.junit, "the same as JUnit XML, for test farms")->type_name("FILE");
  command
      .add_option("--pictures", options.pictures_folder, "folder for pictures of every frame that differs")
      ->type_name("DIR");
}

void add_diff_options(CLI::App& command, DiffOptions& options) {
  command.add_option("EXPECTED", options.expected, "a PNG, a folder of PNGs, a video or a report")
      ->required();
  command.add_option("ACTUAL", options.actual, "another one of the kind")->required();
  add_finding_options(command, options.findings);
  command.add_option("--picture", options.picture, "the worst frame's difference as a PNG")
      ->type_name("FILE");
}

void add_golden_options(CLI::App& make, CLI::App& check, GoldenOptions& options) {
  make.add_option("DIR", options.folder, "the folder of the goldens")->required();
  make.add_option("SCENE", options.run.scene, "a .toml file, or a scene's name; none: all again");
  make.add_option("--name", options.name, "instead of the scene's; without SCENE: this one again");
  make.add_option("--reason", options.reason, "why it is made, or made again; kept with it");
  add_scene_options(make, options.run);
  add_picture_options(make, options.run);
  check.add_option("DIR", options.folder, "the folder of the goldens")->required();
  check.add_option("NAME", options.names, "goldens; none: all");
  add_finding_options(check, options.findings);
}

void add_study_options(CLI::App& command, StudyOptions& options) {
  command.add_option("NAME", options.what, "a study, or a scene to be compared with itself at a finer step");
  command.add_option("-o", options.folder, "folder for the files; study_NAME without it")->type_name("DIR");
  command.add_flag("--quick", options.is_quick, "fewer settings, smaller cases, one repeat");
}

/// A mistyped verb gets the nearest one named.
bool is_known_verb(const std::string& verb) {
  const std::vector<std::string> verbs{"run",  "render", "batch", "check", "plan",
                                       "diff", "golden", "study", "bench", "list"};
  if (verb.empty() || verb[0] == '-' || std::find(verbs.begin(), verbs.end(), verb) != verbs.end())
    return true;
  scene::Problems ignored;
  const bool is_scene = !scene::find_scene(verb, ignored).empty();
  std::fprintf(stderr, "there is no verb \"%s\"\n    %s\n", verb.c_str(),
               is_scene ? ("it is a scene: shatterbox run " + verb).c_str()
                        : scene::hint_for_name(verb, verbs, "verbs").c_str());
  return false;
}

/// "golden make", as it is called.
std::string words_of(const CLI::App& verb) {
  const CLI::App* above = verb.get_parent();
  return above == nullptr || above->get_parent() == nullptr ? verb.get_name()
                                                            : words_of(*above) + " " + verb.get_name();
}

/// An option of a file or a folder that is given an empty name would be as if it were not there.
void refuse_empty_names(CLI::App& app) {
  const CLI::Validator has_name(
      [](std::string& name) { return name.empty() ? std::string("an empty name is none") : std::string(); },
      "");
  for (CLI::Option* option : app.get_options())
    if (option->get_type_name() == "FILE" || option->get_type_name() == "DIR") option->check(has_name);
  for (CLI::App* verb : app.get_subcommands({})) refuse_empty_names(*verb);
}

/// The verb, or the verb of a verb; the program itself where there is none.
const CLI::App* called_verb(const CLI::App& app) {
  const CLI::App* verb = &app;
  while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().front();
  return verb;
}

/// What is left over on the command line, in words, with the nearest option that there is.
int refuse_rest(const CLI::App& app, const std::vector<std::string>& rest) {
  const CLI::App* verb = called_verb(app);
  std::vector<std::string> known;
  for (const CLI::Option* option : verb->get_options())
    if (!option->get_positional())
      known.push_back(option->get_single_name().size() > 1 ? "--" + option->get_single_name()
                                                           : "-" + option->get_single_name());
  const auto stranger =
      std::find_if(rest.begin(), rest.end(), [](const std::string& word) { return word[0] == '-'; });
  if (stranger != rest.end())
    std::fprintf(
        stderr, "%s has no option %s\n    %s\n", words_of(*verb).c_str(), stranger->c_str(),
        scene::hint_for_name(stranger->substr(0, stranger->find('=')), known, "its options").c_str());
  else
    std::fprintf(stderr, "%s is one word too many for %s\n    shatterbox %s --help tells what it takes\n",
                 rest.front().c_str(), words_of(*verb).c_str(), words_of(*verb).c_str());
  return kBadInput;
}

/// The option of which CLI11 speaks, if it does.
const CLI::Option* find_told(const CLI::App& verb, const std::string& told) {
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_name();
    const std::size_t place = told.find(name);
    if (place == std::string::npos || name[0] != '-') continue;
    const std::size_t end = place + name.size();
    if (end == told.size() || told.find_first_of(": =", end) == end) return option;
  }
  return nullptr;
}

/// What cannot be read, in words, and what the option is for.
int refuse_value(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* verb = called_verb(app);
  std::string told = error.what();
  const CLI::Option* option = find_told(*verb, told);
  if (option != nullptr && dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    const std::string type = option->get_type_name();
    const std::size_t value = told.find(" = ");
    if (value != std::string::npos)
      told = option->get_name() + ": \"" + told.substr(value + 3) + "\" is no " +
             (type == "INT" || type == "UINT" ? "whole " : "") + "number";
  } else if (option != nullptr && dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    told = option->get_name() + " takes a value";
  }
  std::fprintf(stderr, "%s\n", told.c_str());
  if (option != nullptr)
    std::fprintf(stderr, "    %s: %s\n", option->get_name().c_str(), option->get_description().c_str());
  else
    std::fprintf(stderr, "    %s --help tells what it takes\n",
                 verb == &app ? "shatterbox" : ("shatterbox " + words_of(*verb)).c_str());
  return kBadInput;
}

/// The verbs of a verb.
bool is_known_second(const std::string& verb, const std::string& second) {
  const std::vector<std::string> seconds{"make", "check"};
  if (verb != "golden" || second[0] == '-' || second == seconds[0] || second == seconds[1]) return true;
  std::fprintf(stderr, "golden does not \"%s\"\n    %s\n", second.c_str(),
               scene::hint_for_name(second, seconds, "it does").c_str());
  return false;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  if (argc > 1 && !is_known_verb(argv[1])) return kBadInput;
  if (argc > 2 && argv[2][0] != '\0' && !is_known_second(argv[1], argv[2])) return kBadInput;
  Options options;
  CLI::App app("Shatterbox: throw things, watch them break, keep the video and the numbers.", "shatterbox");
  app.require_subcommand(1);
  app.set_version_flag("--version", SHATTERBOX_VERSION);
  CLI::App* run_command = app.add_subcommand("run", "simulate, draw and encode a scene");
  CLI::App* check_command =
      app.add_subcommand("check", "say what is wrong with a scene, where, and how to mend it");
  CLI::App* plan_command = app.add_subcommand(
      "plan", "say which parts a run needs and why, what it leaves out, and what that takes");
  bool is_lean = false;
  plan_command->add_flag("--lean", is_lean, "list what could still be switched off, and what that saves");
  RenderOptions rendering;
  CLI::App* render_command =
      app.add_subcommand("render", "draw and encode a recorded run, or a range of its frames");
  add_render_options(*render_command, rendering);
  BenchOptions bench;
  CLI::App* bench_command = app.add_subcommand("bench", "time the benchmark scenes, one after the other");
  add_bench_options(*bench_command, bench);
  BatchOptions batch;
  add_batch_options(*app.add_subcommand("batch", "run many scenes, or one with many values"), batch);
  DiffOptions diff;
  CLI::App* diff_command =
      app.add_subcommand("diff", "compare pictures, folders of pictures, videos or reports");
  add_diff_options(*diff_command, diff);
  GoldenOptions golden;
  CLI::App* golden_command =
      app.add_subcommand("golden", "keep scenes' pictures and states, and check that they come out again");
  golden_command->require_subcommand(1);
  CLI::App* make_command = golden_command->add_subcommand("make", "keep what a scene shows, or keep it anew");
  CLI::App* golden_check = golden_command->add_subcommand("check", "run the scenes again and compare");
  add_golden_options(*make_command, *golden_check, golden);
  StudyOptions study;
  add_study_options(*app.add_subcommand("study", "error against run time: tables, plots and words"), study);
  app.add_subcommand("list", "scenes, materials, looks, events and studies");
  run_command->add_option("SCENE", options.scene, "a .toml file, or the name of a scene that came along");
  check_command->add_option("SCENE", options.scene, "a .toml file, or a scene's name")->required();
  plan_command->add_option("SCENE", options.scene, "a .toml file, or a scene's name")->required();
  for (CLI::App* command : {run_command, check_command, plan_command}) add_scene_options(*command, options);
  for (CLI::App* command : {run_command, plan_command}) add_run_options(*command, options);
  refuse_empty_names(app);
  // What stands behind -- is for the runs of a batch.
  int own = argc;
  if (argc > 1 && std::string(argv[1]) == "batch") {
    own = static_cast<int>(std::find(argv, argv + argc, std::string("--")) - argv);
    if (own < argc) batch.run_words.assign(argv + own + 1, argv + argc);
  }
  try {
    app.parse(own, argv);
  } catch (const CLI::ExtrasError&) {
    return refuse_rest(app, app.remaining(true));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // it is help that is asked for
    return refuse_value(app, error);
  }
  if (app.got_subcommand("run")) return run_scene(options);
  if (app.got_subcommand("plan")) return plan_scene(options, is_lean);
  if (app.got_subcommand("render")) return render_recording(rendering);
  if (app.got_subcommand("batch")) return run_batch(batch);
  if (app.got_subcommand("bench")) return run_bench(bench);
  if (app.got_subcommand("diff")) return run_diff(diff);
  if (app.got_subcommand("study")) return run_study(study);
  if (app.got_subcommand("golden"))
    return make_command->parsed() ? make_goldens(golden) : check_goldens(golden);
  return app.got_subcommand("check") ? check_scene(options) : list_all();
}

}  // namespace shatterbox::sandbox::run
