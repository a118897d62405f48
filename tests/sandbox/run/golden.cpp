// Goldens that are broken, of several shots, of other scenes, or interrupted.
#include <catch2/catch.hpp>

#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox::run;

namespace {

const std::string kStill = " --size 64x48 --seconds 0.3 --stills 0.1 --reason first";

/// Goldens a, b and c of scenes of their own.
void make_three(const Folder& folder) {
  for (const char* name : {"a", "b", "c"}) {
    folder.write(std::string(name) + ".toml", kSmallScene);
    REQUIRE(program(folder, std::string("golden make g ") + name + ".toml" + kStill).status == 0);
  }
}

/// A golden whose run takes minutes.
void make_slow(const Folder& folder, const std::string& name) {
  nlohmann::json golden = read_json(folder / "g/a/golden.json");
  golden["arguments"] = {"--size",   "64x48", "--seconds", "3600", "--set", "scene.sleep=false",
                         "--stills", "0.1"};
  fs::create_directories(folder / ("g/" + name));
  fs::copy_file(folder / "g/a/frame_000006.png", folder / ("g/" + name + "/frame_000006.png"));
  folder.write("g/" + name + "/golden.json", golden.dump());
}

}  // namespace

TEST_CASE("one golden that is broken does not keep the others from being checked or made again") {
  const Folder folder;
  make_three(folder);
  const std::string golden = read_text(folder / "g/b/golden.json"),
                    picture = read_text(folder / "g/b/frame_000006.png");
  const auto breaks = [&](const std::string& how, const std::string& words) {
    INFO(how);
    REQUIRE(shell(folder, how).status == 0);
    const Outcome outcome = program(folder, "golden check g --report r.json --junit j.xml");
    INFO(outcome.out << outcome.err);
    CHECK(outcome.status == 2);
    CHECK(outcome.out.find("c: state equal") != std::string::npos);
    CHECK(outcome.err.find(words) != std::string::npos);
    CHECK(outcome.err.find("could not be checked: b") != std::string::npos);
    const std::string junit = read_text(folder / "j.xml");
    CHECK(junit.find("tests=\"3\" failures=\"0\" errors=\"1\"") != std::string::npos);
    CHECK(junit.find("<error message=\"") != std::string::npos);
    const auto report = read_json(folder / "r.json");
    REQUIRE(report.size() == 3);
    CHECK(report[1]["same"] == false);
    CHECK(report[1]["error"].get<std::string>().find(words) != std::string::npos);
    CHECK(report[2]["same"] == true);
    folder.write("b.toml", kSmallScene);
    folder.write("g/b/golden.json", golden);
    folder.write("g/b/frame_000006.png", picture);
  };
  breaks("echo '[scene' > b.toml", "b.toml:1");
  breaks("echo '{' > g/b/golden.json", "g/b/golden.json: is no golden");
  breaks("rm g/b/golden.json", "g/b/golden.json: is missing");
  breaks("rm g/b/frame_000006.png", "holds no PNG");
  breaks("head -c 100 g/b/frame_000006.png > cut && mv cut g/b/frame_000006.png", "frame_000006.png");
  CHECK(program(folder, "golden check g").status == 0);

  folder.write("b.toml", "[scene\n");
  const Outcome again = program(folder, "golden make g --reason second");
  INFO(again.out << again.err);
  CHECK(again.status == 2);
  CHECK(again.err.find("made again: a, c; as before: b") != std::string::npos);
  CHECK(read_json(folder / "g/b/golden.json")["reasons"].size() == 1);
  CHECK(read_json(folder / "g/c/golden.json")["reasons"].size() == 2);
}

TEST_CASE("a golden is not made in place of another scene's and not over its own scene") {
  const Folder folder;
  make_three(folder);
  fs::create_directories(folder / "other");
  folder.write("other/a.toml", kSmallScene);
  const Outcome other = program(folder, "golden make g other/a.toml" + kStill);
  CHECK(other.status == 2);
  CHECK(other.err.find("golden of another scene, a.toml") != std::string::npos);
  CHECK(other.err.find("--name NAME") != std::string::npos);
  CHECK(read_json(folder / "g/a/golden.json")["scene"] == "../../a.toml");
  CHECK(program(folder, "golden make g other/a.toml --name other_a" + kStill).status == 0);
  CHECK(program(folder, "golden make g ./other/../a.toml" + kStill).status == 0);
  CHECK(read_json(folder / "g/a/golden.json")["reasons"].size() == 2);
  fs::rename(folder / "b.toml", folder / "other/b.toml");  // the scene has moved
  CHECK(program(folder, "golden make g other/b.toml" + kStill).status == 0);
  CHECK(read_json(folder / "g/b/golden.json")["reasons"].size() == 2);
  const Outcome over = program(folder, "golden make . other/a.toml --name other" + kStill);
  CHECK(over.status == 2);
  CHECK(over.err.find("SCENE") != std::string::npos);
  CHECK(fs::exists(folder / "other/a.toml"));
  folder.write("b\xC3\xA4ll.toml", kSmallScene);
  const Outcome named = program(folder, "golden make g b\xC3\xA4ll.toml" + kStill);
  CHECK(named.status == 2);
  CHECK(named.err.find("--name NAME") != std::string::npos);
  CHECK(program(folder, "golden make g a b c").err.find("shatterbox golden make --help") !=
        std::string::npos);
}

TEST_CASE("goldens lose nothing to what is written of their check") {
  const Folder folder;
  make_three(folder);
  const std::string golden = read_text(folder / "g/a/golden.json"),
                    picture = read_text(folder / "g/a/frame_000006.png");
  const Outcome report = program(folder, "golden check g a --report g/a/golden.json");
  CHECK(report.status == 2);
  CHECK(report.err.find("--report: g/a/golden.json would be written among what DIR reads") == 0);
  const Outcome pictures = program(folder, "golden check g --pictures g");
  CHECK(pictures.status == 2);
  CHECK(pictures.err.find("--pictures: g/a") == 0);
  const Outcome scene = program(folder, "golden check g --junit b.toml");
  CHECK(scene.status == 2);
  CHECK(scene.err.find("the golden b reads") != std::string::npos);
  CHECK(read_text(folder / "b.toml") == kSmallScene);
  CHECK(read_text(folder / "g/a/golden.json") == golden);
  CHECK(read_text(folder / "g/a/frame_000006.png") == picture);
  // A folder is made for all that goes in it, or not at all.
  CHECK(program(folder, "golden check g --report out/r.json --pictures out/p").status == 0);
  CHECK(fs::exists(folder / "out/r.json"));
  CHECK(program(folder, "golden check g --report none/r.json --pictures new").status == 2);
  CHECK_FALSE(fs::exists(folder / "new"));
}

TEST_CASE("a golden of several shots has the states of all") {
  const Folder folder;
  fs::create_directories(folder / "shots");
  folder.write("shots/1.toml", kSmallScene);
  folder.write("shots/2.toml", kSmallScene);
  REQUIRE(program(folder, "golden make g shots/" + kStill).status == 0);
  CHECK(read_json(folder / "g/shots/golden.json")["state_hash"].get<std::string>().size() == 33);
  CHECK(program(folder, "golden check g").status == 0);
  std::string changed = kSmallScene;
  changed.replace(changed.find("radius = 0.05"), 13, "radius = 0.04");
  folder.write("shots/2.toml", changed);
  CHECK(program(folder, "golden check g").status == 1);
}

TEST_CASE("Ctrl-C ends a check in order and leaves goldens as they are") {
  const Folder folder;
  folder.write("a.toml", kSmallScene);
  REQUIRE(program(folder, "golden make g a.toml" + kStill).status == 0);
  make_slow(folder, "slow");
  const auto interrupted = [&folder](const std::string& arguments) {
    return shell(folder, SHATTERBOX_PROGRAM " " + arguments +
                             " > said & p=$!; for i in $(seq 300); do grep -q 'a' said && break; sleep 0.05; "
                             "done; sleep 0.5; kill -INT $p; wait $p");
  };
  const Outcome check = interrupted("golden check g --junit j.xml");
  INFO(check.err);
  CHECK(check.status == 3);
  CHECK(check.err.find("interrupted: 1 of 2 were checked") != std::string::npos);
  CHECK(read_text(folder / "j.xml").find("tests=\"1\" failures=\"0\" errors=\"0\"") != std::string::npos);
  const Outcome make = interrupted("golden make g --reason again");
  INFO(make.err);
  CHECK(make.status == 3);
  CHECK(make.err == "interrupted; made again: a; as before: slow\n");
  CHECK(read_json(folder / "g/slow/golden.json")["reasons"].size() == 1);
  CHECK(fs::exists(folder / "g/slow/frame_000006.png"));
}

TEST_CASE("a folder for what is written meanwhile that cannot be had is told by its name") {
  const Folder folder;
  folder.write("a.toml", kSmallScene);
  REQUIRE(program(folder, "golden make g a.toml" + kStill).status == 0);
  for (const std::string verb : {"golden check g", "golden make g --reason x", "bench boats_10 --brief"}) {
    const Outcome outcome = shell(folder, "TMPDIR=/none/such " SHATTERBOX_PROGRAM " " + verb);
    INFO(verb << "\n" << outcome.err);
    CHECK(outcome.status == 3);
    CHECK(outcome.err.find("/none/such: No such file or directory") != std::string::npos);
  }
}

TEST_CASE("a golden whose run finds no room for its words says so") {
  const Folder folder;
  folder.write("a.toml", kSmallScene);
  REQUIRE(program(folder, "golden make g a.toml" + kStill).status == 0);
  const Outcome outcome = shell(folder, "( trap '' XFSZ; ulimit -f 0; " SHATTERBOX_PROGRAM
                                        " golden check g 2>&1; echo status $? ) | cat");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.out.find("words.txt cannot be written: File too large") != std::string::npos);
  CHECK(outcome.out.find("status 3") != std::string::npos);
}
