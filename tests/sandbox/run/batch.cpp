// Batches: what they run, and what they tell of it.
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <cstddef>

#include "sandbox/run/batch_plan.h"
#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox;
using namespace shatterbox::sandbox::run;

namespace {

/// From now on this process starts threads but no other process, as at the limit of their number (which root
/// does not have). False where the system lets nobody ask for that.
bool forbid_processes() {
  const auto jump = [](std::uint16_t code, std::uint32_t value, std::uint8_t yes, std::uint8_t no) {
    return sock_filter{code, yes, no, value};
  };
  const auto load = [&](std::size_t offset) {
    return jump(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset), 0, 0);
  };
  const auto answer = [&](std::uint32_t value) { return jump(BPF_RET | BPF_K, value, 0, 0); };
  sock_filter rules[] = {load(offsetof(seccomp_data, nr)),
                         jump(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone3, 0, 1),
                         answer(SECCOMP_RET_ERRNO | ENOSYS),  // its flags are out of sight: clone instead
                         jump(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone, 0, 3),
                         load(offsetof(seccomp_data, args)),
                         jump(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 1, 0),
                         answer(SECCOMP_RET_ERRNO | EAGAIN),
                         answer(SECCOMP_RET_ALLOW)};
  const sock_fprog program{static_cast<unsigned short>(std::size(rules)), rules};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Runs the program with these arguments where it cannot start any other; status 77 if that cannot be.
Outcome program_alone(const Folder& folder, const std::string& arguments) {
  const std::string command = "cd '" + folder.path().string() + "' && exec " SHATTERBOX_PROGRAM " " +
                              arguments + " >out.txt 2>err.txt </dev/null";
  const pid_t child = fork();
  if (child == 0) {
    if (forbid_processes()) execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(77);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(folder / "out.txt"),
          read_text(folder / "err.txt")};
}

}  // namespace

TEST_CASE("values of a sweep are parted by commas, but not within brackets and quotes") {
  scene::Problems problems;
  const Sweep plain = parse_sweep("ball.speed=5,1e1,-3", problems);
  CHECK(plain.key == "ball.speed");
  CHECK(plain.values == std::vector<std::string>{"5", "1e1", "-3"});
  const Sweep nested = parse_sweep("a.b=[1, 2],{x = [3,4]},\"c,d\"", problems);
  CHECK(nested.values == std::vector<std::string>{"[1, 2]", "{x = [3,4]}", "\"c,d\""});
  CHECK(problems.empty());
  for (const char* wrong : {"", "ball.speed", "speed=1,2", "a.b=1,,2", "a.b=[1,2", "a.b=\"x"}) {
    scene::Problems told;
    (void)parse_sweep(wrong, told);
    INFO(wrong);
    CHECK(told.size() == 1);
  }
}

TEST_CASE("a batch runs all scenes with all combinations, each in a folder of its own") {
  const Folder folder;
  fs::create_directories(folder / "scenes");
  folder.write("scenes/b.toml", kSmallScene);
  folder.write("scenes/a.toml", kSmallScene);
  folder.write("scenes/notes.txt", "no scene");
  scene::Problems problems;
  const Sweep sweep = parse_sweep("scene.gravity=[0, -1, 0],[0, -2, 0]", problems);
  const Sweep seeds = parse_sweep("scene.seed=1,2", problems);
  const std::string where = (folder / "scenes").string();
  const auto runs = plan_batch({where, where + "/a.toml"}, {sweep, seeds}, {}, problems).runs;
  CHECK(problems.empty());
  REQUIRE(runs.size() == 12);
  CHECK(runs[0].name == "a_scene.gravity=0--1-0_scene.seed=1");
  CHECK(runs[1].values[1].second == "2");
  CHECK(runs[4].name.rfind("b_", 0) == 0);
  CHECK(runs[8].name == runs[0].name + "_2");  // the same scene once more
}

TEST_CASE("what says that it takes long is left out of a folder, unless it is named") {
  const Folder folder;
  fs::create_directories(folder / "scenes");
  folder.write("scenes/quick.toml", kSmallScene);
  std::string slow = kSmallScene;
  slow.insert(slow.find("[scene]\n") + 8, "takes = \"a night\"\n");
  folder.write("scenes/slow.toml", slow);
  const std::string where = (folder / "scenes").string();
  scene::Problems problems;
  const BatchPlan without = plan_batch({where}, {}, {}, problems);
  REQUIRE(without.runs.size() == 1);
  CHECK(without.runs[0].name == "quick");
  REQUIRE(without.left_out.size() == 1);
  CHECK(without.left_out[0].name == "slow");
  CHECK(without.left_out[0].takes == "a night");
  CHECK(plan_batch({where}, {}, {"slow"}, problems).runs.size() == 2);
  CHECK(plan_batch({where + "/slow.toml"}, {}, {}, problems).runs.size() == 1);
  CHECK(problems.empty());
  (void)plan_batch({where}, {}, {"slwo"}, problems);
  CHECK(problems.size() == 1);
}

TEST_CASE("batch: one table of all runs, and what was cut short goes on") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  folder.write("bad.toml", "[scene]\nsecond = 1\n");
  const std::string batch = "batch good.toml -o out --jobs 2 --sweep balls.radius=0.05,0.04 ";
  const std::string rest = " -- --no-render --seconds 0.2";
  const Outcome outcome = program(folder, batch + rest);
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  const auto table = read_json(folder / "out/summary.json");
  REQUIRE(table["rows"].size() == 2);
  CHECK(table["columns"][1]["name"] == "balls.radius");
  CHECK(table["rows"][1][1] == "0.04");
  // A run of the batch is the run by itself.
  REQUIRE(program(folder, "run good.toml --set balls.radius=0.04 --no-render --seconds 0.2 --report r.json")
              .status == 0);
  CHECK(table["rows"][1].back() == read_json(folder / "r.json")["state_hash"]);
  CHECK(outcome.out.find(table["rows"][1].back().get<std::string>()) != std::string::npos);

  // What is done is not done again; what is not, is.
  const fs::path first = folder / "out/good_balls.radius=0.05",
                 second = folder / "out/good_balls.radius=0.04";
  fs::remove(second / "done.json");
  const auto before = fs::last_write_time(first / "report.json"),
             later = fs::last_write_time(second / "report.json");
  REQUIRE(program(folder, batch + "--resume" + rest).status == 0);
  CHECK(fs::last_write_time(first / "report.json") == before);
  CHECK(fs::last_write_time(second / "report.json") != later);
  CHECK(read_json(folder / "out/summary.json")["rows"][1].back() == table["rows"][1].back());

  // Two runs beside each other are no one run, of which there would be results.
  REQUIRE(
      program(folder, "batch good.toml -o two -- --no-render --seconds 0.1 --compare balls.radius=0.05,0.04")
          .status == 0);
  CHECK(read_json(folder / "two/summary.json")["rows"][0].back().is_null());

  const Outcome failed = program(folder, "batch bad.toml good.toml -o mixed -- --no-render --seconds 0.1");
  CHECK(failed.status == 2);
  CHECK(failed.err.find("mixed/bad/log.txt") != std::string::npos);
  CHECK(read_text(folder / "mixed/bad/log.txt").find("did you mean") != std::string::npos);
  CHECK(read_json(folder / "mixed/summary.json")["rows"][1][1] == 0);
  CHECK(program(folder, "batch none.toml").status == 2);
  CHECK(program(folder, "batch none").err.find("no such scene") != std::string::npos);
  CHECK(program(folder, "batch mixed").err.find("no scene (.toml) in this folder") != std::string::npos);
  CHECK(program(folder, "batch reel --sweep reel=1").err.find("no such scene") == std::string::npos);
  CHECK(program(folder, "batch good.toml --sweep radius=1").status == 2);
  CHECK(program(folder, "batch good.toml -o good.toml").status == 2);
}

TEST_CASE("a batch reads the words of its runs as they do: --threads=2, -oFILE") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  folder.write("throws.toml", "[[event]]\nat = 0.05\ndo = \"nothing_known\"\n");
  const Outcome outcome =
      program(folder, "batch good.toml -o out -- --seconds=0.1 --size=64x48 --threads=1 -ofilm.mkv");
  INFO(outcome.err << read_text(folder / "out/good/log.txt"));
  CHECK(outcome.status == 0);
  CHECK(fs::exists(folder / "out/good/film.mkv"));
  CHECK_FALSE(fs::exists(folder / "out/good/film.mp4"));
  CHECK(read_json(folder / "out/good/report.json")["threads"] == 1);
  // The script is found, and read: it is the one that is wrong.
  CHECK(program(folder, "batch good.toml -o two -- --no-render --script=throws.toml").status == 2);
  CHECK(read_text(folder / "two/good/log.txt").find("throws.toml:3") != std::string::npos);
}

TEST_CASE("what a batch cannot start is told at once, and is not done") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string batch =
      "batch good.toml -o out --jobs 2 --sweep scene.seed=1,2 --resume -- --no-render --seconds 0.1";
  const Outcome outcome = program_alone(folder, batch);
  if (outcome.status == 77) {
    WARN("no process can be forbidden to start others here");
    return;
  }
  INFO(outcome.err);
  CHECK(outcome.status == 3);
  for (const char* words :
       {"1 of 2: good_scene.seed=1 cannot be started: ", "2 of 2: good_scene.seed=2 cannot be started: "})
    CHECK(outcome.err.find(words) != std::string::npos);
  const auto table = read_json(folder / "out/summary.json");
  REQUIRE(table["rows"].size() == 2);
  CHECK(table["rows"][0][2] == 3);
  CHECK(table["rows"][1][2] == 3);
  const Outcome again = program(folder, batch);
  INFO(again.err);
  CHECK(again.status == 0);
}

TEST_CASE("a batch says what is wrong with its words, and with which") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const Outcome outcome = program(folder, "batch good.toml --sweep scene.secnds=1,2 -o out");
  INFO(outcome.err);
  CHECK(outcome.status != 0);
  CHECK(outcome.err.find("--set scene.secnds=1: ") != std::string::npos);
  CHECK(outcome.err.find("did you mean \"seconds\"?") != std::string::npos);
}

TEST_CASE("Ctrl-C ends a batch in order, and it goes on where it was") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string batch = "batch good.toml -o out --jobs 2 --sweep scene.seed=1,2,3 ";
  const std::string rest = " -- --seconds 5 --size 64x48";
  const Outcome cut =
      shell(folder, std::string(SHATTERBOX_PROGRAM " ") + batch + rest +
                        " & p=$!; for i in $(seq 300); do [ -s out/good_scene.seed=1/film.mp4.part ] "
                        "&& break; sleep 0.05; done; kill -INT $p; wait $p");
  INFO(cut.out << cut.err);
  CHECK(cut.status == 3);
  CHECK(read_json(folder / "out/good_scene.seed=1/report.json")["interrupted"] == true);
  CHECK_FALSE(fs::exists(folder / "out/good_scene.seed=3/report.json"));
  REQUIRE(program(folder, batch + "--resume" + rest).status == 0);
  for (const char* seed : {"1", "2", "3"})
    CHECK(count_frames(folder, std::string("out/good_scene.seed=") + seed + "/film.mp4") == 300);
}

TEST_CASE("Ctrl-C ends what a gallery draws again in order, and it is drawn the next time") {
  const Folder folder;
  folder.write("good.toml", kSmallScene);
  const std::string batch =
      "batch good.toml -o out --gallery --resume -- --seconds 2 --size 640x360 --set scene.sleep=false";
  const Outcome cut =
      shell(folder, std::string(SHATTERBOX_PROGRAM " ") + batch +
                        " & p=$!; for i in $(seq 1200); do [ -e out/good/drawing.txt ] && break; sleep 0.05; "
                        "done; kill -INT $p; wait $p");
  INFO(cut.out << cut.err);
  CHECK(cut.status == 3);
  const fs::path drawn = folder / "out/good/drawing_preview.json";
  CHECK((!fs::exists(drawn) || read_json(drawn)["interrupted"] == true));
  CHECK(fs::exists(folder / "out/good/film.rec"));
  REQUIRE(program(folder, batch).status == 0);
  CHECK_FALSE(fs::exists(folder / "out/good/film.rec"));
  CHECK(read_json(drawn)["interrupted"] == false);
  CHECK(read_text(folder / "out/index.html").find("drawn in full") != std::string::npos);
}

TEST_CASE("a gallery shows three pictures of each film, its goal and its numbers") {
  const Folder folder;
  folder.write("balls.toml", kSmallScene);
  folder.write("odd & ends.toml", kSmallScene);
  REQUIRE(program(folder, "batch balls.toml 'odd & ends.toml' -o b --gallery -- --seconds 0.2 --size 64x48")
              .status == 0);
  const std::string page = read_text(folder / "b/index.html");
  CHECK(page.find("things fall") != std::string::npos);
  CHECK(page.find("0 pieces of 0 breaks") != std::string::npos);
  int pictures = 0;
  for (std::size_t at = page.find("src=\""); at != std::string::npos; at = page.find("src=\"", at + 1)) {
    const std::string file = page.substr(at + 5, page.find('"', at + 5) - at - 5);
    INFO(file);
    CHECK(fs::exists(folder / "b" / file));
    ++pictures;
  }
  CHECK(pictures == 6);
  for (const char* quality : {"preview", "full"}) {
    const std::size_t first = page.find(std::string("drawn in ") + quality);
    REQUIRE(first != std::string::npos);
    CHECK(page.find(std::string("drawn in ") + quality, first + 1) != std::string::npos);
    const std::string line = page.substr(first, page.find('<', first) - first);
    INFO(line);
    CHECK(line.find("frames a second, worst frame ") != std::string::npos);
    CHECK(line.find("shadow ") != std::string::npos);
    CHECK(std::stod(line.substr(line.find(": ") + 2)) > 0.0);
  }
  CHECK_FALSE(fs::exists(folder / "b/balls/film.rec"));
  // What makes no film is told without pictures.
  REQUIRE(program(folder, "batch balls.toml -o c --gallery -- --seconds 0.1 --no-render").status == 0);
  CHECK(read_text(folder / "c/index.html").find("no pictures") != std::string::npos);
}
