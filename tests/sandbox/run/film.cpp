// What scripts do to films, seen from outside.
#include <catch2/catch.hpp>

#include <iomanip>
#include <sstream>

#include "tests/sandbox/run/running.h"

using namespace shatterbox::sandbox::run;

namespace {

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

}  // namespace

TEST_CASE("slow motion makes the film longer, not the world, and gives the same pictures twice") {
  const Folder folder;
  write_text(folder / "small.toml", kSmallScene);
  write_text(folder / "slow.toml",
             "[[event]]\nat = 0.1\ndo = \"speed\"\nfactor = 0.25\n"
             "[[event]]\nat = 0.2\ndo = \"speed\"\nfactor = 1\n");
  const std::string picture = "run small.toml --size 64x48 --frames ";
  REQUIRE(program(folder, picture + "a --report a.json").status == 0);
  REQUIRE(program(folder, picture + "b --script slow.toml --report b.json --meshes m").status == 0);
  REQUIRE(program(folder, picture + "c --script slow.toml --report c.json --stills 0.15").status == 0);
  const auto plain = read_json(folder / "a.json"), slow = read_json(folder / "b.json"),
             still = read_json(folder / "c.json");
  CHECK(slow["state_hash"] == plain["state_hash"]);
  CHECK(slow["simulated_seconds"] == plain["simulated_seconds"]);
  CHECK(plain["video_seconds"].get<double>() == Approx(0.5));
  CHECK(slow["video_seconds"].get<double>() == Approx(0.1 + 4 * 0.1 + 0.3));
  REQUIRE(slow["frame_hashes"].size() == 48);
  // Before the change the films are the same; after it they are again, 0.3 s later.
  for (std::size_t i = 0; i <= 6; ++i) CHECK(slow["frame_hashes"][i] == plain["frame_hashes"][i]);
  for (std::size_t i = 30; i < 48; ++i) CHECK(slow["frame_hashes"][i] == plain["frame_hashes"][i - 18]);
  for (std::size_t i = 7; i <= 30; ++i) CHECK(slow["frame_hashes"][i] != slow["frame_hashes"][i - 1]);
  REQUIRE(still["frame_hashes"].size() == 1);
  CHECK(still["frame_hashes"][0] == slow["frame_hashes"][18]);
  CHECK(fs::exists(folder / "m" / "frame_000047.obj"));
}

TEST_CASE("slow motion that begins in the last frame of a short scene is shown to its end") {
  const Folder folder;
  write_text(folder / "short.toml",
             "[scene]\nseconds = 0.04\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.1\n"
             "[[event]]\nat = 0.02\ndo = \"speed\"\nfactor = 0.01\n");
  for (const std::string rate : {"30", "60", "120"}) {
    REQUIRE(program(folder, "run short.toml --no-render --report r.json --fps " + rate).status == 0);
    const auto report = read_json(folder / "r.json");
    CAPTURE(rate);
    // From the step at or behind 0.02 s on a hundredth of the speed.
    CHECK(report["video_seconds"].get<double>() == Approx(0.0208 + 100.0 * (0.04 - 0.0208)).margin(0.05));
    CHECK(report["simulated_seconds"].get<double>() == Approx(10.0 / 240.0));
  }
}

TEST_CASE("plan tells what a scene needs and why, and the report what of it was used") {
  const Folder folder;
  write_text(folder / "small.toml", kSmallScene);
  write_text(
      folder / "glass.toml",
      "[scene]\nseconds = 0.1\n[[body]]\nkind = \"plane\"\n[[body]]\nname = \"ball\"\nshape = \"sphere\"\n"
      "radius = 0.05\nthickness = 0.0006\nedge_length = 0.012\nmaterial = \"glass\"\nposition = "
      "[0,0.1,0]\nvelocity = [0,-6,0]\n");
  const Outcome small = program(folder, "plan small.toml --no-render");
  INFO(small.err << small.out);
  REQUIRE(small.status == 0);
  const auto line_of = [](const std::string& text, const std::string& word) {
    const std::size_t at = text.find(word);
    return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
  };
  const std::size_t left_out = small.out.find("leaves out");
  REQUIRE(left_out != std::string::npos);
  for (const char* part : {"shell_stress", "fracture", "grains", "render", "shadow", "video", "hands"})
    CHECK(small.out.find(part) > left_out);
  CHECK(small.out.find("contact") < left_out);
  CHECK(line_of(small.out, "contact").find("\"balls\"") != std::string::npos);
  const Outcome glass = program(folder, "plan glass.toml --size 64x48 --lean");
  INFO(glass.err << glass.out);
  REQUIRE(glass.status == 0);
  CHECK(glass.out.find("shell_stress") < glass.out.find("leaves out"));
  CHECK(line_of(glass.out, "shell_stress").find("\"ball\" can break") != std::string::npos);
  CHECK(glass.out.find("light.shadow=false") != std::string::npos);
  CHECK(!fs::exists(folder / "glass.mp4"));
  CHECK(glass.out.find("tetrahedra of what can break") == std::string::npos);
  write_text(folder / "brick.toml",
             "[scene]\nseconds = 0.1\n[[body]]\nname = \"brick\"\nkind = \"solid\"\nshape = \"slab\"\n"
             "size = [0.2, 0.06, 0.1]\nelement_size = 0.04\nmaterial = \"brick\"\nrepeat = {count = 2, "
             "spacing = [0.3, 0, 0]}\n");
  const Outcome brick = program(folder, "plan brick.toml --no-render");
  INFO(brick.err << brick.out);
  const std::size_t told = brick.out.find("tetrahedra of what can break\n    brick ");
  REQUIRE(told != std::string::npos);
  CHECK(brick.out.find("    brick ", told + 40) == std::string::npos);  // once for both
  double least = 0.0, most = 0.0, least_median = 0.0, aspect = 0.0, worst = 0.0;
  const std::size_t angles = brick.out.find("dihedral angles", told);
  REQUIRE(angles != std::string::npos);
  REQUIRE(
      std::sscanf(brick.out.c_str() + angles,
                  "dihedral angles %lf to %lf degrees, half have none below %lf; aspect %lf, at worst %lf",
                  &least, &most, &least_median, &aspect, &worst) == 5);
  CHECK(least > 5.0);
  CHECK(least <= least_median);
  CHECK(least_median < 71.0);  // a regular one has 70.5
  CHECK(most < 175.0);
  CHECK(aspect > 1.2);
  CHECK(worst >= aspect);

  const auto has = [](const nlohmann::json& list, const char* name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  REQUIRE(program(folder, "run small.toml --no-render --report s.json").status == 0);
  REQUIRE(program(folder, "run glass.toml --no-render --report g.json").status == 0);
  REQUIRE(program(folder,
                  "run glass.toml --no-render --report h.json --set ball.velocity=[0,0,0] "
                  "--set ball.position=[0,0.2,0]")
              .status == 0);
  const auto s = read_json(folder / "s.json"), g = read_json(folder / "g.json"),
             h = read_json(folder / "h.json");
  for (const char* part : {"shell_stress", "fracture"}) {
    CHECK(has(s["left_out"], part));
    CHECK(has(g["used"], part));
    CHECK(has(h["idle"], part));  // it has not come down yet
  }
  CHECK(s["parts"]["factors"]["bytes"] == 0);
  CHECK(g["parts"]["factors"]["bytes"] > 0);
  CHECK_FALSE(s["time_ms"]["stages"].contains("stress"));
  CHECK(g["time_ms"]["stages"].contains("stress"));
}

TEST_CASE("of a picture's parts only those are made that are asked for, and asking for one makes it") {
  const Folder folder;
  write_text(folder / "small.toml", kSmallScene);
  struct Case {
    const char *options, *made;  // names of parts
  };
  const std::vector<Case> cases{
      {"--no-render", ""},
      {"--frames f --set light.shadow=false", ""},
      {"--frames f", "shadow"},
      {"--frames f --set light.shadow=false --set render.overlay=velocity", "overlays"},
      {"-o v.mp4", "shadow encoder"},
  };
  for (const Case& one : cases) {
    const Outcome run = program(
        folder, "run small.toml --seconds 0.1 --size 64x48 --report r.json " + std::string(one.options));
    INFO(one.options << run.err);
    REQUIRE(run.status == 0);
    const auto parts = read_json(folder / "r.json")["parts"];
    for (const char* name : {"level_sets", "overlays", "shadow", "encoder"}) {
      INFO(name);
      const bool is_made = std::string(one.made).find(name) != std::string::npos;
      CHECK((parts[name]["count"].get<long>() > 0) == is_made);
      CHECK((parts[name]["bytes"].get<double>() > 0.0) == is_made);
    }
  }
}

TEST_CASE("plan foresees what breaks and what holds by trying") {
  const Folder folder;
  const std::string floor = "[scene]\nseconds = 0.4\n[[body]]\nname = \"floor\"\nkind = \"plane\"\n";
  const auto ball = [](const std::string& name, const std::string& more) {
    return "[[body]]\nname = \"" + name +
           "\"\nshape = \"sphere\"\nradius = 0.05\nthickness = 0.0006\nedge_length = 0.012\nmaterial = "
           "\"glass\"\n" +
           more + "\n";
  };
  const std::string thrown =
      "[[event]]\nat = 0.05\ndo = \"projectile\"\nfrom = [1, 0.06, 0]\nat_body = \"still\"\nspeed = 12\n";
  const std::string pane =
      "[[body]]\nname = \"still\"\nshape = \"pane\"\nwidth = 0.6\nheight = 0.6\nthickness = "
      "0.002\nedge_length = 0.05\nmaterial = \"glass\"\nsupport = \"edge\"\nposition = [0, 0.5, 0]\n"
      "[[event]]\nat = 0.05\ndo = \"explosion\"\ncentre = [0, 0.5, 0.5]\nenergy = 60000\n";
  // So near that it is thrown and meets in one step.
  const std::string shot =
      "[[event]]\nat = 0.05\ndo = \"projectile\"\nfrom = [0.1, 0.06, 0]\nat_body = \"still\"\nspeed = 15\n"
      "body = { name = \"shot\", kind = \"sphere\", radius = 0.01, material = \"steel\" }\n";
  struct Case {
    std::string name, text, words;
    bool breaks;
  };
  const std::vector<Case> cases{
      {"shot", floor + ball("still", "position = [0, 0.0505, 0]") + shot, "meets \"shot\" with 15 m/s", true},
      {"blown", floor + pane, "is struck by", true},
      {"falls", floor + ball("still", "position = [0, 0.1, 0]\nvelocity = [0, -6, 0]"), "meets \"floor\"",
       true},
      {"lies", floor + ball("still", "position = [0, 0.0505, 0]"), "holds", false},
      {"struck", floor + ball("still", "position = [0, 0.0505, 0]") + thrown, "breaks", true},
      {"flies", floor + ball("still", "position = [0, 9, 0]"), "meets nothing", false},
  };
  for (const Case& one : cases) {
    write_text(folder / "s.toml", one.text);
    const Outcome plan = program(folder, "plan s.toml --no-render");
    INFO(one.name << plan.err << plan.out);
    REQUIRE(plan.status == 0);
    const std::string line = plan.out.substr(plan.out.find("foreseen"));
    CHECK(line.find("\"still\"") != std::string::npos);
    CHECK(line.find(one.words) != std::string::npos);
    CHECK((line.find("and breaks") != std::string::npos) == one.breaks);
    CHECK((line.find("of those foreseen") != std::string::npos) == one.breaks);
    // What is foreseen of a body that alone can break is what comes.
    REQUIRE(program(folder, "run s.toml --no-render --report r.json").status == 0);
    const auto report = read_json(folder / "r.json");
    REQUIRE(report["breaks"].empty() == !one.breaks);
    if (!one.breaks) continue;
    std::ostringstream when;
    when << std::fixed << std::setprecision(3) << report["breaks"][0]["time"].get<double>();
    CHECK(line.find("at " + when.str() + " s") != std::string::npos);
  }
  // Of two, one falls onto the other: neither is said to hold for sure.
  write_text(folder / "two.toml",
             floor + ball("under", "position = [0, 0.0505, 0]") + ball("over", "position = [0, 0.16, 0]"));
  const Outcome two = program(folder, "plan two.toml --no-render");
  REQUIRE(two.status == 0);
  CHECK(two.out.find("as if nothing else could break") != std::string::npos);
  CHECK(two.out.find(": holds,") == std::string::npos);
  CHECK(two.out.find(": holds;") == std::string::npos);
  // Nothing to foresee where nothing can break.
  write_text(folder / "small.toml", kSmallScene);
  CHECK(program(folder, "plan small.toml --no-render").out.find("foreseen") == std::string::npos);
}

TEST_CASE("hands and explosions are used or idle each by itself") {
  const Folder folder;
  write_text(folder / "small.toml", kSmallScene);
  const std::string grab = "[[event]]\nat = 0.1\ndo = \"grab\"\nbody = \"crate\"\n";
  const std::string blast = "[[event]]\nat = 0.1\ndo = \"explosion\"\ncentre = [1, 0.2, 0]\nenergy = 1\n";
  const std::string late = "at = 9";  // after the end
  const auto put_off = [&late](std::string event) { return event.replace(event.find("at = 0.1"), 8, late); };
  const auto row_of = [&folder](const std::string& script, const char* part) -> std::string {
    write_text(folder / "s.toml", script);
    const Outcome outcome = program(folder, "run small.toml --no-render --script s.toml --report r.json");
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    const auto report = read_json(folder / "r.json");
    for (const char* row : {"used", "idle", "left_out"})
      if (std::count(report[row].begin(), report[row].end(), part) > 0) return row;
    return "none";
  };
  CHECK(row_of(grab, "hands") == "used");
  CHECK(row_of(grab, "explosions") == "left_out");
  CHECK(row_of(blast, "hands") == "left_out");
  CHECK(row_of(blast, "explosions") == "used");
  CHECK(row_of(put_off(grab) + blast, "hands") == "idle");
  CHECK(row_of(grab + put_off(blast), "explosions") == "idle");
}

TEST_CASE("a folder of scenes is a film of several shots with one report, and each shot is as by itself") {
  const Folder folder;
  fs::create_directories(folder / "reel");
  write_text(folder / "reel" / "1.toml", kSmallScene);
  write_text(folder / "reel" / "2.toml",
             std::string(kSmallScene) + "[camera]\nposition = [1,1,1]\ntarget = [0,0,0]\n");
  REQUIRE(
      program(folder, "run reel --size 64x48 --fps 30 --seconds 0.2 -o film.mp4 --report r.json").status ==
      0);
  CHECK(count_frames(folder, "film.mp4") == 12);
  const auto report = read_json(folder / "r.json");
  REQUIRE(report["shots"].size() == 2);
  for (int shot = 0; shot < 2; ++shot) {
    const std::string name = std::to_string(shot + 1);
    REQUIRE(program(folder, "run reel/" + name + ".toml --size 64x48 --fps 30 --seconds 0.2 -o " + name +
                                ".mp4 --report " + name + ".json")
                .status == 0);
    const auto alone = read_json(folder / (name + ".json"));
    CHECK(report["shots"][shot]["state_hash"] == alone["state_hash"]);
    CHECK(report["shots"][shot]["frame_hashes"] == alone["frame_hashes"]);
  }
  CHECK(program(folder, "run real --no-render").status == 2);
}
