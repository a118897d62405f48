// Ranges of a recorded run, drawn by processes of their own, are the frames of the run.
#include "sandbox/run/rendering.h"

#include <catch2/catch.hpp>

#include "tests/sandbox/run/running.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::run;

namespace {

/// Everything that scripts do to pictures while a pane breaks.
constexpr const char* kDirected = R"([[event]]
at = 0.1
do = "speed"
factor = 0.5
[[event]]
at = 0.14
do = "overlay"
show = "stress"
[[event]]
at = 0.2
do = "overlay"
show = "velocity"
[[event]]
at = 0.23
do = "overlay"
show = "impacts"
[[event]]
at = 0.26
do = "overlay"
show = "pieces"
[[event]]
at = 0.2
do = "caption"
text = "crack"
duration = 0.2
[[event]]
at = 0.25
do = "camera"
move = "follow"
body = "ball"
[[event]]
when = "first break"
do = "remove"
body = "ball"
after = 0.1
)";

/// The hashes of a run and those of ranges of its recording, in processes of their own, must be the same.
void check_ranges(const std::string& arguments) {
  const Folder folder;
  folder.write("pane.toml", kBreakingScene);
  folder.write("directed.toml", kDirected);
  fs::create_directories(folder / "reel");
  folder.write("reel/1.toml", kSmallScene);
  folder.write("reel/2.toml", kBreakingScene);
  INFO(arguments);
  const Outcome outcome =
      program(folder, "run " + arguments + " --frames direct --report r.json --record film.rec");
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  const auto report = read_json(folder / "r.json");
  const auto count = static_cast<int>(std::distance(fs::directory_iterator(folder / "direct"), {}));
  REQUIRE(count > 20);
  std::vector<std::string> hashes;
  const std::vector<int> ends{0, count / 3, count - 5, count};
  for (std::size_t i = 3; i > 0; --i) {  // the last range first: it knows nothing of the others
    const std::string range = std::to_string(ends[i - 1]) + ":" + std::to_string(ends[i]);
    const Outcome part =
        program(folder, "render film.rec --frames " + range + " --pictures parts --report part.json");
    INFO(part.err);
    REQUIRE(part.status == 0);
    const auto json = read_json(folder / "part.json");
    REQUIRE(json["frames"].size() == static_cast<std::size_t>(ends[i] - ends[i - 1]));
    CHECK(json["frames"].front() == ends[i - 1]);
    CHECK(json["recorded_frames"] == count);
    const auto part_hashes = json["frame_hashes"].get<std::vector<std::string>>();
    hashes.insert(hashes.begin(), part_hashes.begin(), part_hashes.end());
  }
  CHECK(program(folder, "diff direct parts --tolerance exact").status == 0);
  if (report.contains("frame_hashes"))
    CHECK(report["frame_hashes"].get<std::vector<std::string>>() == hashes);
}

}  // namespace

TEST_CASE("ranges of a recording give the frames of the run to the bit") {
  check_ranges("pane.toml --seconds 0.4 --size 160x90");
  check_ranges("pane.toml --seconds 0.4 --size 96x64 --quality full --script directed.toml");
}

TEST_CASE("ranges of a recording give the frames of shutter and lens to the bit") {
  check_ranges(
      "pane.toml --seconds 0.4 --size 64x48 --set camera.shutter=0.5 --set camera.samples=3 "
      "--set camera.aperture=0.05 --script directed.toml");
}

TEST_CASE("ranges of a recording give the frames of several worlds and shots to the bit") {
  check_ranges("pane.toml --seconds 0.4 --size 64x48 --compare ball.radius=0.03,0.01");
  check_ranges("reel --seconds 0.3 --size 64x48 --set render.overlay='\"grains\"'");
}

TEST_CASE("a recording is drawn in another size and quality as the run would have been") {
  const Folder folder;
  folder.write("pane.toml", kBreakingScene);
  REQUIRE(program(folder, "run pane.toml --seconds 0.3 --record film.rec").status == 0);
  CHECK_FALSE(fs::exists(folder / "pane.mp4"));  // nothing is drawn
  REQUIRE(program(folder, "run pane.toml --seconds 0.3 --size 96x64 --quality full --truth t --frames direct")
              .status == 0);
  REQUIRE(program(folder,
                  "render film.rec --size 96x64 --quality full --truth u --pictures late -o late.mp4 "
                  "--frames 5:")
              .status == 0);
  CHECK(count_frames(folder, "late.mp4") == 13);
  for (int i = 0; i < 18; ++i) {
    const std::string number = (i < 10 ? "00000" : "0000") + std::to_string(i);
    for (const auto& [direct, late] :
         {std::pair("direct/frame_" + number + ".png", "late/frame_" + number + ".png"),
          std::pair("t/truth_" + number + ".npz", "u/truth_" + number + ".npz")}) {
      INFO(direct);
      CHECK(fs::exists(folder / late) == (i >= 5));
      if (i >= 5) CHECK(read_text(folder / direct) == read_text(folder / late));
    }
  }
}

TEST_CASE("a recording is seen from another place as the run would have been") {
  const Folder folder;
  std::string scene = kBreakingScene;
  const std::size_t camera = scene.find("[camera]");
  folder.write("pane.toml", scene.erase(camera, scene.find("[render]") - camera));  // no path
  const std::string eye =
      " --set camera.position=[0.5,0.4,0.9] --set camera.target=[0,0.1,0] --set camera.fov=40";
  const std::string run = "run pane.toml --size 160x90 --seconds 0.15";
  REQUIRE(program(folder, run + " --report r.json --record film.rec").status == 0);
  REQUIRE(program(folder, run + eye + " --frames other --report other.json").status == 0);
  const Outcome outcome = program(folder, "render film.rec --report drawn.json" + eye);
  INFO(outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(read_json(folder / "drawn.json")["frame_hashes"] == read_json(folder / "other.json")["frame_hashes"]);
  for (const char* wrong : {"camera.position=[0,1,2]", "camera.fov=400", "camera.follow=pane", "pane.mass=3",
                            "camera.position"}) {
    const Outcome refused = program(folder, std::string("render film.rec --report no.json --set ") + wrong);
    CAPTURE(wrong, refused.err);
    CHECK(refused.status == 2);
    CHECK(refused.err.find("--set") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "no.json"));
  }
}

TEST_CASE("a recording does not depend on what else the run does nor on how it came about") {
  const Folder folder;
  folder.write("pane.toml", kBreakingScene);
  const std::string run = "run pane.toml --size 640x360 --quality full -o v.mp4 --record film.rec";
  REQUIRE(program(folder, run).status == 0);
  const std::string whole = read_text(folder / "film.rec");
  CHECK(fs::file_size(folder / "film.rec") > 10000);
  fs::remove(folder / "film.rec");
  fs::remove(folder / "v.mp4");
  // Killed, then taken up again: pictures are kept, the recording is written anew.
  (void)shell(folder, std::string(SHATTERBOX_PROGRAM " ") + run +
                          " & p=$!; for i in $(seq 600); do [ -s v.mp4.checkpoint ] && break; sleep 0.05; "
                          "done; kill -9 $p; wait $p");
  CHECK_FALSE(fs::exists(folder / "film.rec"));
  CHECK(program(folder, "render film.rec.part -o x.mp4").status == 2);
  REQUIRE(program(folder, run + " --resume").status == 0);
  CHECK(read_text(folder / "film.rec") == whole);
  CHECK_FALSE(fs::exists(folder / "film.rec.part"));
  REQUIRE(
      program(folder, "run pane.toml --size 640x360 --quality full --record film.rec --threads 1 --no-render")
          .status == 0);
  CHECK(read_text(folder / "film.rec") == whole);
}

TEST_CASE("Ctrl-C leaves a recording of the frames so far") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const Outcome outcome = shell(
      folder, std::string(SHATTERBOX_PROGRAM) +
                  " run good.toml --seconds 6000 --record film.rec --set scene.sleep=false & "
                  "p=$!; for i in $(seq 300); do sleep 0.1; [ -s film.rec.part ] && break; done; sleep 0.5; "
                  "kill -INT $p; wait $p");
  CHECK(outcome.status == 3);
  CHECK(program(folder, "render film.rec --frames :3 --size 64x48 -o v.mp4").status == 0);
  CHECK(count_frames(folder, "v.mp4") == 3);
}

TEST_CASE("ranges of frames are read as they are written") {
  sandbox::scene::Problems problems;
  using Range = std::pair<int, int>;
  CHECK(parse_frames("", 240, problems) == Range(0, 240));
  CHECK(parse_frames("100:200", 240, problems) == Range(100, 200));
  CHECK(parse_frames("200:300", 240, problems) == Range(200, 240));
  CHECK(parse_frames("239:", 240, problems) == Range(239, 240));
  CHECK(parse_frames(":5", 240, problems) == Range(0, 5));
  CHECK(problems.empty());
  for (const char* wrong : {"5", "5:5", "6:5", "a:b", "-1:5", "1:2:3", "240:250", "99999999999:", "1 :2"}) {
    problems.clear();
    INFO(wrong);
    CHECK_FALSE(parse_frames(wrong, 240, problems));
    CHECK(problems.size() == 1);
  }
  problems.clear();
  CHECK_FALSE(parse_frames("", 0, problems));
}

TEST_CASE("what is no recording is refused before anything is written") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const auto complaint = [&](const std::string& arguments) {
    const Outcome outcome = program(folder, arguments);
    INFO(arguments << ": " << outcome.out);
    CHECK(outcome.status == 2);
    CHECK_FALSE(fs::exists(folder / "v.mp4"));
    CHECK_FALSE(fs::exists(folder / "v.mp4.part"));
    return outcome.err;
  };
  REQUIRE(program(folder, "run good.toml --record film.rec").status == 0);
  const std::string whole = read_text(folder / "film.rec");
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] + 1);
  std::ofstream(folder / "damaged.rec", std::ios::binary) << damaged;
  std::ofstream(folder / "cut.rec", std::ios::binary) << whole.substr(0, whole.size() - 1);
  CHECK(complaint("render damaged.rec -o v.mp4").find("damaged at byte") != std::string::npos);
  CHECK(complaint("render cut.rec -o v.mp4").find("its end is missing") != std::string::npos);
  CHECK(complaint("render good.toml -o v.mp4").find("--record") != std::string::npos);
  CHECK(complaint("render nowhere.rec -o v.mp4").find("nowhere.rec") != std::string::npos);
  CHECK(complaint("render film.rec --frames 30:60 -o v.mp4").find("number 29") != std::string::npos);
  CHECK(complaint("render film.rec --frames 30 -o v.mp4").find("100:200") != std::string::npos);
  CHECK(complaint("render film.rec").find("--pictures") != std::string::npos);
  CHECK(complaint("render film.rec --size 3x3 -o v.mp4").find("--size") != std::string::npos);
  CHECK(complaint("run good.toml --stills 0.1 --frames f --record film.rec").find("whole film") !=
        std::string::npos);
  CHECK(complaint("run good.toml --record nowhere/film.rec").find("no folder nowhere") != std::string::npos);
  const Outcome full = shell(folder, std::string("trap '' XFSZ; ulimit -f 8; ") + SHATTERBOX_PROGRAM +
                                         " run good.toml --seconds 20 --record full.rec");
  CHECK(full.status == 3);
  CHECK(full.err.find("full.rec cannot be written") != std::string::npos);
  CHECK_FALSE(fs::exists(folder / "full.rec"));
}
