// Work is not lost: runs that are killed, and what --resume makes of what they leave.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <random>

#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox::run;

namespace {

constexpr const char* kRun = "run pane.toml --size 320x180 --quality full ";
constexpr int kFrames = 120;

/// Kills runs at random moments, each of which then goes on to its end as if nothing had been.
void kill_runs(int count, unsigned seed) {
  const Folder folder;
  folder.write("pane.toml", kBreakingScene);
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(program(folder, std::string(kRun) + "-o whole.mp4 --report whole.json").status == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto whole = read_json(folder / "whole.json");
  REQUIRE(whole["pieces"] > 0);
  std::mt19937 random(seed);
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const std::string video = i % 3 == 0 ? "v.mkv" : "v.mp4";
    const double moment = seconds * static_cast<double>(random()) / 4294967296.0;
    const std::string arguments = std::string(kRun) + "-o " + video + " --report r.json --export m.glb";
    (void)shell(folder, std::string(SHATTERBOX_PROGRAM " ") + arguments + " & p=$!; sleep " +
                            std::to_string(moment) + "; kill -9 $p; wait $p");
    INFO(i << ": killed after " << moment << " of " << seconds << " s, " << video);
    // It plays as far as it was written: not at all before the first half second of film is encoded.
    const fs::path part = folder / (video + ".part");
    const std::string there = fs::exists(part) ? video + ".part" : video;
    if (fs::exists(folder / there) && fs::file_size(folder / there) > 2000)
      CHECK(count_frames(folder, there) > 0);
    INFO(i << " " << there);
    CHECK((!fs::exists(folder / "r.json") || read_json(folder / "r.json")["interrupted"] == false));
    const Outcome resumed = program(folder, arguments + " --resume");
    INFO(resumed.out << resumed.err);
    REQUIRE(resumed.status == 0);
    const auto json = read_json(folder / "r.json");
    CHECK(json["state_hash"] == whole["state_hash"]);
    CHECK(json["frame_hashes"] == whole["frame_hashes"]);
    CHECK(count_frames(folder, video) == kFrames);
    CHECK(program(folder, "diff whole.mp4 " + video + " --tolerance video").status == 0);
    kept += json.value("kept_frames", 0);
    for (const char* rest : {".part", ".checkpoint", ".next", ".lock"})
      CHECK_FALSE(fs::exists(folder / (video + rest)));
    for (const std::string& name : {video, std::string("r.json"), std::string("m.glb")})
      fs::remove(folder / name);
  }
  // A checkpoint is written each second: a run of two has one at half of the moments.
  CHECK((count < 10 || seconds < 2.0 || kept > 0));
}

/// Runs until that is true in the shell, then sends a signal.
void cut_short(const Folder& folder, const std::string& arguments, const std::string& condition,
               const char* signal) {
  (void)shell(folder, std::string(SHATTERBOX_PROGRAM " ") + arguments + " & p=$!; for i in $(seq 600); do " +
                          condition + " && break; sleep 0.05; done; kill " + signal + " $p; wait $p");
}

/// Of a file: it has been written.
std::string is_there(const std::string& file) {
  return "[ -s " + file + " ]";
}

}  // namespace

TEST_CASE("runs that are killed at random moments go on to the same end") {
  kill_runs(3, 1);
}

TEST_CASE("a hundred runs that are killed at random moments go on to the same end", "[.]") {
  kill_runs(100, 2);
}

TEST_CASE("a run that is killed again and again gets to its end") {
  const Folder folder;
  folder.write("pane.toml", kBreakingScene);
  REQUIRE(program(folder, std::string(kRun) + "--frames whole --report whole.json").status == 0);
  const std::string arguments = std::string(kRun) + "--frames f -o v.mp4 --report r.json --resume";
  for (int i = 0; i < 3; ++i)
    cut_short(folder, arguments, is_there("f/frame_0000" + std::to_string(25 * (i + 1)) + ".png"), "-9");
  CHECK(count_frames(folder, "v.mp4.part") >= 30);
  REQUIRE(program(folder, arguments).status == 0);
  CHECK(read_json(folder / "r.json")["frame_hashes"] == read_json(folder / "whole.json")["frame_hashes"]);
  CHECK(count_frames(folder, "v.mp4") == kFrames);
  CHECK(program(folder, "diff whole f --tolerance exact").status == 0);
}

TEST_CASE("the bar of a run that goes on tells how far the film is, from its start to its end") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string arguments =
      "run good.toml --seconds 30 --size 160x90 -o v.mp4 --set scene.sleep=false --report r.json --resume";
  // The first groups of the film are in it by then, and known to the checkpoint.
  cut_short(folder, arguments, "[ $(cat v.mp4.checkpoint 2>/dev/null | grep -c '^   \"') -ge 200 ]", "-9");
  const Outcome resumed = shell(folder, "script -qec '" SHATTERBOX_PROGRAM " " + arguments + "' /dev/null");
  INFO(resumed.out);
  CHECK(resumed.status == 0);
  CHECK(read_json(folder / "r.json").value("kept_frames", 0) > 0);
  int percent = 0, told = 0;
  for (std::size_t at = resumed.out.find("] "); at != std::string::npos;
       at = resumed.out.find("] ", at + 1), ++told) {
    const int next = std::atoi(resumed.out.c_str() + at + 2);
    CHECK(next >= percent);
    percent = next;
  }
  CHECK(told > 0);
  CHECK(percent <= 100);
}

TEST_CASE("what was interrupted with Ctrl-C goes on too") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string arguments = "run good.toml --seconds 8 --size 64x48 -o v.mp4 --frames f --report r.json";
  REQUIRE(program(folder, arguments).status == 0);
  const auto whole = read_json(folder / "r.json");
  fs::remove(folder / "v.mp4");
  fs::remove_all(folder / "f");
  // What a terminal or timeout sends to a process and to its group comes twice, and is no second one.
  // Only whole groups of 30 frames of the video are taken up again: the first is there by then.
  cut_short(folder, arguments, is_there("f/frame_000060.png"), "-TERM $p; kill -INT");
  REQUIRE(read_json(folder / "r.json")["interrupted"] == true);
  CHECK(fs::exists(folder / "v.mp4.checkpoint"));
  const int frames = count_frames(folder, "v.mp4");
  REQUIRE(frames > 0);
  REQUIRE(program(folder, arguments + " --resume").status == 0);
  const auto resumed = read_json(folder / "r.json");
  CHECK(resumed["state_hash"] == whole["state_hash"]);
  CHECK(resumed["frame_hashes"] == whole["frame_hashes"]);
  CHECK(resumed.value("kept_frames", 0) > 0);
  CHECK(resumed.value("kept_frames", 0) <= frames);
  CHECK(count_frames(folder, "v.mp4") == 480);
}

TEST_CASE("only what --resume takes up again says that it does") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const auto cut = [&folder](const std::string& arguments) {
    return shell(folder, "timeout -s INT 2 " SHATTERBOX_PROGRAM
                         " run good.toml --seconds 60000 --set scene.sleep=false " +
                             arguments)
        .out;
  };
  const std::string words = "; with --resume it goes on";
  CHECK(cut("--no-render --report r.json").find(words) != std::string::npos);
  for (const char* arguments : {"--no-render", "--size 64x48 --compare balls.radius=0.05,0.04 -o c.mp4"}) {
    const std::string said = cut(arguments);
    INFO(said);
    CHECK(said.find("interrupted at") != std::string::npos);
    CHECK(said.find(words) == std::string::npos);
  }
}

TEST_CASE("Ctrl-C breaks off a step that takes seconds and the run goes on to the same end", "[.]") {
  const Folder folder;
  std::string scene = kBreakingScene;
  scene.replace(scene.find("edge_length = 0.03"), 18, "edge_length = 0.0015");
  folder.write("pane.toml", scene);
  const std::string arguments = "run pane.toml --seconds 0.25 --size 64x48 -o v.mp4 --report r.json";
  REQUIRE(program(folder, arguments).status == 0);
  const auto whole = read_json(folder / "r.json");
  REQUIRE(whole["breaks"].size() > 0);
  const long step = std::lround(whole["breaks"][0]["time"].get<double>() * 240.0);
  int broken_off = 0;
  for (const double share : {0.15, 0.35, 0.55}) {  // of the time that all of it takes
    const std::string later = std::to_string(share * whole["wall_seconds"].get<double>());
    fs::remove(folder / "v.mp4");
    // A run that does not heed the signal within a minute is killed.
    const Outcome cut =
        shell(folder, "timeout -s KILL 60 " SHATTERBOX_PROGRAM " " + arguments +
                          " & p=$!; for i in $(seq 600); do [ -s v.mp4.part ] && break; sleep "
                          "0.05; done; sleep " +
                          later + "; kill -INT $(pgrep -P $p); wait $p");
    INFO(later << "\n" << cut.out << cut.err);
    REQUIRE(cut.status == 3);
    const auto json = read_json(folder / "r.json");
    CHECK(json["interrupted"] == true);
    CHECK(count_frames(folder, "v.mp4") > 0);
    broken_off += json["steps"] == step - 1 && json["breaks"].empty() ? 1 : 0;
    REQUIRE(program(folder, arguments + " --resume").status == 0);
    const auto resumed = read_json(folder / "r.json");
    CHECK(resumed["state_hash"] == whole["state_hash"]);
    CHECK(resumed["frame_hashes"] == whole["frame_hashes"]);
  }
  CHECK(broken_off > 0);
}

TEST_CASE("a checkpoint is of one run only: another one is refused in words") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string run = "run good.toml --seconds 600 --frames f ";
  cut_short(folder, run + "--size 64x48", is_there("f/checkpoint"), "-9");
  REQUIRE(fs::exists(folder / "f/checkpoint"));
  const auto refused = [&folder](const std::string& arguments, const std::string& part) {
    const Outcome outcome = program(folder, arguments + " --resume");
    INFO(outcome.out << outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(part) != std::string::npos);
  };
  refused(run + "--size 64x64", "had --size \"64x48\", this one \"64x64\"");
  refused(run + "--size 64x48 --seed 7", "--seed");
  refused("run good.toml --no-render", "no output");
  std::string changed = kSmallScene;
  changed.replace(changed.find("radius = 0.05"), 13, "radius = 0.04");
  folder.write("good.toml", changed);
  refused(run + "--size 64x48", "the scene and its meshes changed");
  folder.write("good.toml", kSmallScene);
  const std::string checkpoint = read_text(folder / "f/checkpoint");
  for (const std::string& damaged : {std::string("{"), std::string("[]"), checkpoint.substr(0, 200)}) {
    folder.write("f/checkpoint", damaged);
    refused(run + "--size 64x48", "f/checkpoint: is no checkpoint");
  }
  // A state that this run does not pass through is no state of its own.
  auto json = nlohmann::json::parse(checkpoint);
  json["steps"] = 4;
  folder.write("f/checkpoint", json.dump());
  const Outcome other = program(folder, run + "--size 64x48 --resume");
  CHECK(other.status == 3);
  CHECK(other.err.find("this is not that run") != std::string::npos);
}
