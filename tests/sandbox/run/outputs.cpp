// Outputs take the place of no input, of no other output, and of no other run's.
#include <catch2/catch.hpp>

#include "sandbox/run/outputs.h"
#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox;
using namespace shatterbox::sandbox::run;

namespace {

/// Refused with status 2 and these words, before anything is done: the folder holds what it held.
void check_refused(const Folder& folder, const std::string& arguments,
                   const std::vector<std::string>& words) {
  const auto listing = [&folder] {
    return shell(folder, "find . -type f -not -name '???.txt' | xargs md5sum").out;
  };
  const std::string before = listing();
  const Outcome outcome = program(folder, arguments);
  INFO(arguments << "\n" << outcome.out << outcome.err);
  CHECK(outcome.status == 2);
  for (const std::string& word : words) CHECK(outcome.err.find(word) != std::string::npos);
  CHECK(listing() == before);
}

constexpr const char* kOneTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

}  // namespace

TEST_CASE("no output takes the place of what a verb reads") {
  const Folder folder;
  folder.write("ball.toml", kSmallScene);
  folder.write("ev.toml", "[[event]]\ntime = 0.1\ndo = \"gravity\"\nvalue = [0, -1, 0]\n");
  fs::create_directories(folder / "m");
  folder.write("m/frame_000001.obj", kOneTriangle);
  folder.write("meshed.toml",
               "[[body]]\nname = \"sheet\"\nkind = \"shell\"\nmesh = \"m/frame_000001.obj\"\n");
  fs::create_symlink("ball.toml", folder / "link.toml");
  check_refused(folder, "run ball.toml --report ball.toml", {"--report: ball.toml", "SCENE"});
  check_refused(folder, "run ball.toml --report ./m/../ball.toml", {"--report", "SCENE"});
  check_refused(folder, "run link.toml --report ball.toml", {"--report", "SCENE"});
  check_refused(folder, "run ball.toml --script ev.toml --report ev.toml", {"--report: ev.toml", "--script"});
  check_refused(folder, "run meshed.toml --meshes m", {"--meshes: m", "body \"sheet\" of SCENE"});
  check_refused(folder, "run meshed.toml --report m/frame_000001.obj", {"--report", "\"sheet\""});
  REQUIRE(
      program(folder,
              "run ball.toml --seconds 0.1 --record k.rec --report a.json --frames f --size 64x48 --fps 20")
          .status == 0);
  check_refused(folder, "render k.rec --report k.rec", {"--report: k.rec", "RECORDING"});
  fs::copy(folder / "f", folder / "g");
  check_refused(folder, "diff f g --pictures f", {"--pictures: f", "EXPECTED"});
  check_refused(folder, "diff f g --pictures g/deeper", {"--pictures", "ACTUAL"});
  check_refused(folder, "diff f g --picture g/worst.png", {"--picture", "ACTUAL"});
  check_refused(folder, "diff f/frame_000000.png g/frame_000001.png --picture f/frame_000000.png",
                {"--picture", "EXPECTED"});
  check_refused(folder, "diff f/frame_000000.png g/frame_000001.png --pictures f",
                {"--pictures", "EXPECTED"});
  check_refused(folder, "diff a.json a.json --report a.json", {"--report: a.json", "EXPECTED", "ACTUAL"});
  CHECK(program(folder, "diff f g --report f/r.json").status == 0);  // no picture, so it harms none
}

TEST_CASE("no two outputs of a run are one file") {
  const Folder folder;
  folder.write("ball.toml", kSmallScene);
  check_refused(folder, "run ball.toml --record q.rec --report q.rec", {"--record", "--report"});
  check_refused(folder, "run ball.toml -o x1.mp4 --record x1.mp4", {"-o", "--record"});
  check_refused(folder, "run ball.toml -o x1.mp4 --record ./x1.mp4.part", {"-o", "--record"});
  check_refused(folder, "run ball.toml --truth mix --frames mix --tables mix", {"--truth", "--tables"});
  check_refused(folder, "run ball.toml --tables t --report t/bodies.json", {"--tables", "--report"});
  check_refused(folder, "run ball.toml --frames f --report f", {"--frames", "--report"});
  check_refused(folder, "run ball.toml --frames f/deep --report f", {"--frames", "--report"});
  CHECK_FALSE(fs::exists(folder / "mix"));
  // What has names of its own may lie together.
  const Outcome together = program(
      folder,
      "run ball.toml --frames mix --meshes mix --tables mix --report mix/r.json --seconds 0.1 --size 64x48");
  INFO(together.err);
  CHECK(together.status == 0);
  CHECK(fs::exists(folder / "mix/r.json"));
}

TEST_CASE("what is refused has made no folder") {
  const Folder folder;
  folder.write("ball.toml", kSmallScene);
  CHECK(program(folder, "run ball.toml --frames f --report no/r.json").status == 2);
  CHECK(program(folder, "diff none.png none.png --pictures f").status == 2);
  CHECK(program(folder, "golden check f --pictures f").status == 2);
  CHECK(program(folder, "plan ball.toml --frames f").status == 0);
  CHECK_FALSE(fs::exists(folder / "f"));
  CHECK(program(folder, "run ball.toml --frames ball.toml/f").status == 2);
}

TEST_CASE("an empty name of a file is refused") {
  const Folder folder;
  folder.write("ball.toml", kSmallScene);
  for (const char* option : {"-o", "--report", "--frames", "--script"}) {
    const Outcome outcome = program(folder, std::string("run ball.toml ") + option + " ''");
    CHECK(outcome.status == 2);
    CHECK(outcome.err.find(std::string(option) + ": an empty name is none") == 0);
  }
  CHECK_FALSE(fs::exists(folder / "ball.mp4"));
}

TEST_CASE("two runs at once do not write one file") {
  const Folder folder;
  folder.write("ball.toml", kSmallScene);
  for (const std::string output : {"-o v.mp4", "--record v.rec", "--frames v"}) {
    const std::string run = SHATTERBOX_PROGRAM " run ball.toml --size 64x48 " + output;
    const Outcome both = shell(
        folder, run + " --seconds 3600 --report a.json & p=$!; for i in $(seq 300); do sleep 0.05; [ -s " +
                    "v.mp4.part ] || [ -s v.rec.part ] || [ -e v/frame_000003.png ] && break; done; " + run +
                    " --seconds 0.2 --report b.json; second=$?; " + run +
                    " --seconds 0.2 --resume; third=$?; kill -INT $p; wait $p; "
                    "echo $second $third $?");
    INFO(output << "\n" << both.out << both.err);
    CHECK(both.out.find("2 2 3") != std::string::npos);
    CHECK(both.err.find("another run is writing v") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "b.json"));
    CHECK(read_json(folder / "a.json")["interrupted"] == true);
    for (const char* lock : {"v.mp4.lock", "v.rec.lock", "a.json.lock", "b.json.lock"})
      CHECK_FALSE(fs::exists(folder / lock));
    if (output == "-o v.mp4") CHECK(count_frames(folder, "v.mp4") > 0);
    CHECK(shell(folder, run + " --seconds 0.2").status == 0);  // nobody is there any more
    fs::remove_all(folder / "v");
    fs::remove(folder / "v.mp4");
    fs::remove(folder / "v.rec");
  }
}

TEST_CASE("a claim is refused while another one holds it and what a killed run left is none") {
  const Folder folder;
  const std::string file = (folder / "f").string();
  folder.write("f.lock", "");
  {
    const Claim held = Claim::on_file(file), other = Claim::on_file(file);
    CHECK_FALSE(held.is_refused());
    CHECK(other.is_refused());
  }
  CHECK_FALSE(fs::exists(folder / "f.lock"));
  CHECK_FALSE(Claim::on_file(file).is_refused());
  const Claim whole = Claim::on_folder(folder.path().string());
  CHECK_FALSE(whole.is_refused());
  CHECK(Claim::on_folder(folder.path().string()).is_refused());
}
