// What must be true of each scene: it breaks as its first line says, keeps mass and momenta, and holds when
// spared.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/scenes/play.h"

using namespace shatterbox::sandbox::run;

namespace {

double worst_ratio(const nlohmann::json& report) {
  double worst = 0.0;
  for (const auto& row : report["impacts"]) worst = std::max(worst, row["ratio"].get<double>());
  return worst;
}

/// m, mean height along z of the vertices of an object in an OBJ file.
double mean_z(const std::filesystem::path& path, const std::string& object) {
  std::ifstream file(path);
  std::string line;
  bool is_inside = false;
  double sum = 0.0;
  int count = 0;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string word, name;
    words >> word;
    if (word == "o" && words >> name) is_inside = name.rfind(object + "#", 0) == 0;
    double x = 0.0, y = 0.0, z = 0.0;
    if (word != "v" || !is_inside || !(words >> x >> y >> z)) continue;
    sum += z;
    ++count;
  }
  REQUIRE(count > 0);
  return sum / count;
}

/// What an OBJ file of a frame tells of all that can move.
struct FrameSums {
  double mass = 0.0, volume = 0.0;   // kg, m3; without the ball
  std::array<double, 3> momentum{};  // kg m/s, with the ball
  int bodies = 0;
};

FrameSums sums_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  REQUIRE(file.good());
  FrameSums sums;
  std::vector<std::array<double, 3>> points;
  std::string line, name;
  while (std::getline(file, line)) {
    double m = 0.0, x[3], v[3], w[3];
    int t[3];
    if (line.rfind("o ", 0) == 0) name = line.substr(2);
    const bool is_ball = name.rfind("ball", 0) == 0;
    if (std::sscanf(
            line.c_str(),
            "# mass %lf kg, centre %lf %lf %lf m, velocity %lf %lf %lf m/s, angular velocity %lf %lf %lf", &m,
            x, x + 1, x + 2, v, v + 1, v + 2, w, w + 1, w + 2) == 10) {
      ++sums.bodies;
      if (!is_ball) sums.mass += m;
      for (std::size_t k = 0; k < 3; ++k) sums.momentum[k] += m * v[k];
    } else if (std::sscanf(line.c_str(), "v %lf %lf %lf", x, x + 1, x + 2) == 3) {
      points.push_back({x[0], x[1], x[2]});
    } else if (!is_ball && std::sscanf(line.c_str(), "f %d %d %d", t, t + 1, t + 2) == 3) {
      const auto &a = points[static_cast<std::size_t>(t[0] - 1)],
                 &b = points[static_cast<std::size_t>(t[1] - 1)],
                 &c = points[static_cast<std::size_t>(t[2] - 1)];
      sums.volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                      a[2] * (b[0] * c[1] - b[1] * c[0])) /
                     6.0;
    }
  }
  return sums;
}

}  // namespace

TEST_CASE(
    "a break in free flight keeps mass, momentum and, but for the kerf, volume: from the meshes alone") {
  const Folder folder;
  folder.write("free.toml", R"(# a block is hit where nothing else is
[scene]
seconds = 0.06
gravity = [0, 0, 0]
[[body]]
name = "block"
kind = "solid"
shape = "slab"
size = [0.2, 0.16, 0.12]
material = "plaster"
element_size = 0.02
[[body]]
name = "ball"
kind = "sphere"
radius = 0.03
material = "steel"
position = [0.02, 0.01, 0.3]
velocity = [0, 0, -40]
)");
  const nlohmann::json report = play(folder, "free.toml --meshes m --fps 240");
  REQUIRE(report["breaks"].size() > 0);
  const FrameSums first = sums_of(folder / "m/frame_000000.obj");
  CHECK(first.bodies == 2);
  CHECK(first.volume == Approx(0.2 * 0.16 * 0.12).epsilon(1e-12));
  int most = 0;
  for (int frame = 1; frame < 14; ++frame) {
    char name[32];
    std::snprintf(name, sizeof name, "m/frame_%06d.obj", frame);
    const FrameSums sums = sums_of(folder / name);
    INFO(name << ", " << sums.bodies << " bodies");
    CHECK(std::abs(sums.mass / first.mass - 1.0) < 1e-10);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(std::abs(sums.momentum[k] - first.momentum[k]) < 1e-10 * std::abs(first.momentum[2]));
    CHECK(sums.volume <= first.volume * (1.0 + 1e-12));
    CHECK(sums.volume > first.volume * (1.0 - 5e-3));
    most = std::max(most, sums.bodies);
  }
  CHECK(most > 5);
}

TEST_CASE("armadillo: whatever mesh takes the figure's place is hit") {
  const Folder folder;
  // A block whose frame begins far from it.
  folder.write("block.obj",
               "v 3 5 -9\nv 4 5 -9\nv 4 5 -8\nv 3 5 -8\nv 3 7 -9\nv 4 7 -9\nv 4 7 -8\nv 3 7 -8\n"
               "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n");
  const nlohmann::json report = play(
      folder, "armadillo --seconds 0.14 --set figure.mesh='\"block.obj\"' --set figure.element_size=0.06");
  double hardest = 0.0, time = 0.0;  // N s
  for (const auto& row : report["impacts"]) {
    if (row["body"] != "figure" || row["impulse_ns"].get<double>() < hardest) continue;
    hardest = row["impulse_ns"].get<double>();
    time = row["time"].get<double>();
  }
  CHECK(hardest > 0.5 * 0.35 * 70.0);  // of what the ball has
  CHECK(time > 0.12);
}

TEST_CASE("solids break where they are hit, more if harder, and without grains as well") {
  const Folder folder;
  const std::string crater = "crater --set block.element_size=0.035 ";
  const auto report = play(folder, crater + "--seconds 0.155");
  const auto moved = play(
      folder,
      crater + "--seconds 0.155 --set 'throw.at_point=[-0.09,0.35,0.2]' --set 'throw.from=[0.46,0.9,3]'");
  const auto fast = play(folder, crater + "--seconds 0.14 --set throw.speed=120");
  for (const auto& one : {report, moved, fast}) {
    REQUIRE(one["breaks"].size() > 0);
    check_breaks(one);
  }
  const auto place_of = [](const nlohmann::json& one, int axis) {
    return one["breaks"][0]["place"][static_cast<std::size_t>(axis)].get<double>();
  };
  CHECK(place_of(moved, 0) - place_of(report, 0) == Approx(-0.14).margin(0.005));
  CHECK(place_of(moved, 1) == Approx(place_of(report, 1)).margin(0.005));
  CHECK(fast["pieces"].get<int>() > 1.3 * report["pieces"].get<int>());
  const auto plain = play(folder, "lintel --seconds 0.42 --set stone.grain_size=0");
  REQUIRE(plain["breaks"].size() > 0);
  CHECK(plain["breaks"][0]["body"] == "lintel");
  CHECK(plain["breaks"][0]["grain_share"] == 0.0);
  check_breaks(plain);
}

TEST_CASE("every scene that comes along passes its check and says what must be seen") {
  const Folder folder;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SHATTERBOX_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml" && entry.path().stem() != "reel") continue;
    const std::string scene = entry.path().stem().string();
    const Outcome outcome = program(folder, "check " + scene);
    INFO(scene << "\n" << outcome.err);
    ++count;
    // The mesh of this one comes with a package that nothing else needs.
    if (scene == "bunny" && !std::filesystem::exists("/usr/share/glmark2/models/bunny.obj")) {
      CHECK(outcome.err.find("apt install glmark2-data") != std::string::npos);
      CHECK(outcome.status == 2);
      continue;
    }
    CHECK(outcome.status == 0);
  }
  CHECK(count >= 33);
}

TEST_CASE("arch: twenty-five stones stand by friction alone, and come down without their crown") {
  const Folder folder;
  const auto standing = play(folder, "arch --seconds 1.1");
  CHECK(standing["conservation"]["kinetic_energy_j"].get<double>() < 1e-6);
  const auto fallen = play(folder, "arch --seconds 3.5");
  CHECK(fallen["conservation"]["potential_energy_j"].get<double>() <
        0.7 * standing["conservation"]["potential_energy_j"].get<double>());
}

namespace {

void check_nobody_hangs(const nlohmann::json& report) {
  CHECK(report["contact"]["longest_cut"].get<int>() <= 4);
  CHECK(report["contact"]["frozen_share"].get<double>() < 0.01);
  CHECK(report["contact"]["crossing_pairs_at_start"] == 0);
  CHECK(report["audit"]["crossings"] == 0);
  CHECK(report["audit"]["passages"] == 0);
}

}  // namespace

TEST_CASE("dominoes and blast: nobody hangs where he is, boxes that fall or splinters wedged in what flies") {
  const Folder folder;
  check_nobody_hangs(play(folder, "dominoes --set scene.steps_per_second=60 --audit"));
  // The lower six courses of it, and the explosion as far from their top.
  const auto report = play(folder,
                           "blast --seed 2 --seconds 0.6 --audit --set brick.repeat.count=[8,6,1] --set "
                           "half_left.repeat.count=[1,3,1] "
                           "--set half_right.repeat.count=[1,3,1] --set blast.centre=[0.12,0.2,-0.3] "
                           "--set blast.energy=22000000");
  check_nobody_hangs(report);
  CHECK(report["pieces"].get<int>() > 100);
}

TEST_CASE("blast: nobody hangs where he is in all of it", "[.][long]") {
  const Folder folder;
  check_nobody_hangs(play(folder, "blast --seconds 0.8 --audit"));
}

TEST_CASE("crater: the block is crushed where it is hit and nowhere else, and crumbs fall out") {
  const Folder folder;
  const auto report = play(folder, "crater --seconds 1 --audit");
  check_breaks(report);
  check_nobody_hangs(report);
  REQUIRE(!report["breaks"].empty());
  CHECK(report["breaks"][0]["pieces"].get<int>() > 30);
  CHECK(report["pieces"].get<int>() < 90);
  // Hit half as hard it is cracked at most.
  CHECK(play(folder, "crater --seconds 0.3 --set throw.speed=15")["pieces"].get<int>() < 10);
}

TEST_CASE("slab: one ball dents it one goes through and what stands is one piece with a dent and a hole") {
  const Folder folder;
  const auto report = play(folder, "slab --seconds 0.31 --audit");
  check_breaks(report);
  REQUIRE(report["dents"].size() == 2);  // one about the hole
  const auto& mesh = report["tetrahedra"]["meshes"][0];
  CHECK(mesh["body"] == "slab");
  CHECK(mesh["count"] == report["tetrahedra"]["start"]);
  CHECK(mesh["dihedral_degrees"]["least"].get<double>() > 20.0);
  CHECK(mesh["dihedral_degrees"]["greatest"].get<double>() < 145.0);
  CHECK(mesh["aspect"]["worst"].get<double>() < 6.0);
  for (const auto& dent : report["dents"]) CHECK(dent["depth_m"].get<double>() > 0.03);
  REQUIRE(report["breaks"].size() == 1);
  CHECK(report["breaks"][0]["pieces"] == 2);
  // The hole's comes when the ball is out, and that is soon.
  const double late = report["dents"][1]["time"].get<double>() - report["breaks"][0]["time"].get<double>();
  CHECK(late > 0.0);
  CHECK(late < 1e-3);
  CHECK(report["audit"]["crossings"] == 0);
  CHECK(report["audit"]["passages"] == 0);
  std::vector<std::string> verdicts;
  for (const auto& row : report["impacts"])
    if (row.contains("perforation_ratio")) verdicts.push_back(row["verdict"].get<std::string>());
  REQUIRE(verdicts.size() == 2);
  CHECK(verdicts[0].starts_with("held: "));
  CHECK(verdicts[0].find("of the energy that perforates") != std::string::npos);
  CHECK(verdicts[1].starts_with("perforated: "));
  // Slower, the second one dents it too.
  const auto held = play(folder, "slab --seconds 0.31 --set shoot.speed=250");
  CHECK(held["breaks"].empty());
  CHECK(held["dents"].size() == 2);
}

TEST_CASE("slab: the third ball is held and the slab tears and stays one piece") {
  const Folder folder;
  const auto report = play(folder, "slab --seconds 0.54 --audit");
  check_breaks(report);
  CHECK(report["breaks"].size() == 1);
  REQUIRE(report["dents"].size() == 3);
  CHECK(report["dents"][1]["torn_m2"] == 0.0);
  CHECK(report["dents"][2]["torn_m2"].get<double>() > 1e-3);
  CHECK(report["dents"][2]["depth_m"].get<double>() > 0.05);
  bool has_torn = false;
  for (const auto& row : report["impacts"])
    has_torn = has_torn || row["verdict"].get<std::string>().starts_with("torn, in one piece: ");
  CHECK(has_torn);
  CHECK(report["audit"]["crossings"] == 0);
  CHECK(report["audit"]["passages"] == 0);
}

TEST_CASE("panel: three balls dent a sheet and the last goes through with a plug, at any rate") {
  const Folder folder;
  for (const char* rate : {"240", "960"}) {
    const auto report =
        play(folder, std::string("panel --audit --seconds 1.8 --set scene.steps_per_second=") + rate);
    check_breaks(report);
    REQUIRE(report["dents"].size() == 4);
    for (const auto& dent : report["dents"]) CHECK(dent["depth_m"].get<double>() > 0.004);
    REQUIRE(report["breaks"].size() == 1);
    CHECK(report["breaks"][0]["pieces"] == 2);
    CHECK(report["audit"]["crossings"] == 0);
    CHECK(report["audit"]["passages"] == 0);
  }
}

TEST_CASE("pots: stoneware breaks, steel and aluminium are dented") {
  const Folder folder;
  const auto report = play(folder, "pots --audit --seconds 1");
  check_breaks(report);
  for (const auto& row : report["breaks"]) CHECK(row["body"].get<std::string>().starts_with("stoneware"));
  CHECK(report["breaks"].size() > 3);
  std::vector<std::string> dented;
  for (const auto& dent : report["dents"]) dented.push_back(dent["body"].get<std::string>());
  CHECK(std::count(dented.begin(), dented.end(), "steel") >= 1);
  CHECK(std::count(dented.begin(), dented.end(), "aluminium") >= 1);
  CHECK(report["audit"]["passages"] == 0);
}

TEST_CASE("egg: shatters on a worktop, and from a finger's breadth it only cracks into few") {
  const Folder folder;
  const auto high = play(folder, "egg --seconds 0.3");
  check_breaks(high);
  CHECK(high["pieces"].get<int>() >= 60);
  const auto low = play(folder, "egg --seconds 0.3 --set egg.position=[0,0.04,0]");
  CHECK(low["pieces"].get<int>() < high["pieces"].get<int>() / 3);
}

TEST_CASE("ornament: shatters into at least 20 pieces, a low drop is held, with the verdict in the report") {
  const Folder folder;
  const auto broken = play(folder, "ornament --seconds 1");
  CHECK(broken["pieces"].get<int>() >= 20);
  check_breaks(broken);
  CHECK(broken["breaks"][0]["place"][1].get<double>() < 0.005);  // where it touched the floor
  const auto held = play(folder, "ornament --seconds 1 --set ornament.position=[0,0.06,0]");
  CHECK(held["breaks"].empty());
  CHECK(worst_ratio(held) < 1.0);
  CHECK((held["impacts"].empty() || held["impacts"][0]["verdict"].get<std::string>().rfind("held", 0) == 0));
}

TEST_CASE("tempered: breaks into dice all over, and as common glass where less stress is stored") {
  const Folder folder;
  const auto dice = play(folder, "tempered --seconds 0.025");
  check_breaks(dice);
  CHECK(dice["pieces"].get<int>() > 300);
  const auto shards =
      play(folder, "tempered --seconds 0.025 --set toughened.surface_compression=4e7 --set throw.speed=25");
  check_breaks(shards);
  CHECK(shards["pieces"].get<int>() < 100);
}

TEST_CASE("window: breaks where the ball hits, and the ball goes on, a slow ball is held") {
  const Folder folder;
  const auto broken = play(folder, "window --seconds 0.6 --meshes m --fps 20");
  CHECK(broken["pieces"].get<int>() >= 20);
  CHECK(mean_z(folder / "m" / "frame_000011.obj", "ball") < -0.5);
  check_breaks(broken);
  const auto place = broken["breaks"][0]["place"];
  CHECK(std::hypot(place[0].get<double>() - 0.06, place[1].get<double>() - 0.05) < 0.03);
  const auto held =
      play(folder, "window --seconds 0.6 --set throw.from=[0.06,0.05,0.3] --set throw.speed=1.8");
  CHECK(held["breaks"].empty());
  CHECK(worst_ratio(held) < 1.0);
}

TEST_CASE("window: shards that jam between held ones are not pressed against them without end") {
  const auto report = play(Folder(), "window --seed 1 --seconds 1.1");
  double after = 0.0;
  for (const auto& row : report["impacts"])
    if (row["time"].get<double>() > 0.5) after = std::max(after, row["impulse_ns"].get<double>());
  CHECK(after > 0.01);
  // N s: a few times the ball's blow. Where a wedge is pressed that hard it breaks, and lets go; it was 4760.
  CHECK(after < 75.0);
}

TEST_CASE("bowl: breaks into a few large pieces, a low drop is held") {
  const Folder folder;
  const auto broken = play(folder, "bowl --seconds 1");
  CHECK(broken["pieces"].get<int>() >= 3);
  check_breaks(broken);
  const auto held = play(folder, "bowl --seconds 1 --set bowl.position=[0,0.09,0]");
  CHECK(held["breaks"].empty());
}

TEST_CASE("how near a hit comes to breaking does not depend on the step") {
  const Folder folder;
  const std::vector<std::string> hits{
      "ornament --seconds 0.2 --set ornament.position=[0,0.1,0]",
      "window --seconds 0.6 --set throw.from=[0.06,0.05,0.3] --set throw.speed=1.7",
      "bowl --seconds 0.25 --set bowl.position=[0,0.11,0]"};
  for (const std::string& hit : hits) {
    double least = 1e9, most = 0.0;
    for (const char* rate : {"120", "240", "480", "960"}) {
      const auto report = play(folder, hit + " --set scene.steps_per_second=" + rate);
      CHECK(report["breaks"].empty());
      least = std::min(least, worst_ratio(report));
      most = std::max(most, worst_ratio(report));
    }
    INFO(hit << ": " << least << " to " << most);
    CHECK(least > 0.3);
    // The ratio goes as the speed, so the height that breaks moves by twice as much.
    CHECK(most < 1.025 * least);
  }
}

TEST_CASE("step_size: as many pieces at any step, but by snapshots of a penalty dust at long ones") {
  const Folder folder;
  const auto first_pieces = [&](const std::string& criterion, const char* rate) {
    const auto report = play(folder, "step_size --set scene.criterion=" + criterion +
                                         " --set scene.seconds=0.35 --set scene.steps_per_second=" + rate);
    return report["breaks"][0]["pieces"].get<double>();
  };
  for (const char* criterion : {"event", "paper"})
    CHECK(first_pieces(criterion, "30") == Approx(first_pieces(criterion, "960")).epsilon(0.35));
  CHECK(first_pieces("penalty", "240") > 2.0 * first_pieces("penalty", "3840"));
}

TEST_CASE("what breaks after the first break is as much at 60 steps a second as at 240") {
  const Folder folder;
  const auto crack_area = [&](const std::string& rate) {
    double area = 0.0;
    for (const char* seed : {"1", "2", "3", "4", "5", "6", "14", "15"}) {
      const auto report = play(folder, "ornament --seconds 0.5 --seed " + std::string(seed) +
                                           " --set scene.steps_per_second=" + rate);
      for (const auto& row : report["breaks"]) area += row["new_area_m2"].get<double>();
    }
    return area;
  };
  const double coarse = crack_area("60"), fine = crack_area("240");
  INFO(coarse << " and " << fine << " m2");
  // One run differs from the next by a third, eight together by an eighth. It was thrice as much.
  CHECK(coarse < 1.5 * fine);
  CHECK(fine < 1.5 * coarse);
}

TEST_CASE(
    "mortar_wall: bricks break at 60 steps a second too, after more rounds of joints than a step is taken "
    "again") {
  const Folder folder;
  const auto report = play(folder, "mortar_wall --audit --seconds 0.34 --set scene.steps_per_second=60");
  CHECK(report["audit"]["crossings"] == 0);
  CHECK(report["audit"]["passages"] == 0);
  CHECK(report["breaks"].size() >= 5);
  for (const auto& impact : report["impacts"])
    CHECK(impact["verdict"].get<std::string>().find("so much has broken") == std::string::npos);
}

TEST_CASE("nothing passes through anything while things break") {
  const Folder folder;
  for (const char* scene : {"ornament --seconds 0.5", "window --seconds 0.55", "bowl --seconds 0.5",
                            "ornament --seconds 0.48 --set ornament.position=[0,1.06,0]"}) {
    const auto report = play(folder, std::string(scene) + " --audit");
    INFO(scene);
    CHECK(report["pieces"].get<int>() > 5);
    CHECK(report["audit"]["crossings"] == 0);
    CHECK(report["audit"]["passages"] == 0);
  }
}

TEST_CASE("a broken scene gives the same bits with one thread and two") {
  const Folder folder;
  const auto one = play(folder, "window --seconds 0.5 --threads 1");
  const auto two = play(folder, "window --seconds 0.5 --threads 2");
  CHECK(one["pieces"].get<int>() > 0);
  CHECK(one["state_hash"] == two["state_hash"]);
}

TEST_CASE("pieces that inherit the motion of what broke are followed on its way until then") {
  const Folder folder;
  folder.write("inherit.toml",
               "[scene]\n"
               "seconds = 0.42\n"
               "after_break = \"inherit\"\n"
               "[[body]]\n"
               "name = \"floor\"\n"
               "kind = \"plane\"\n"
               "material = \"eggshell\"\n"
               "[[body]]\n"
               "name = \"bauble\"\n"
               "shape = \"ornament\"\n"
               "radius = 0.0575\n"
               "thickness = 0.0018\n"
               "material = \"eggshell\"\n"
               "position = [0.1865, 0.105, 0]\n"
               "[[event]]\n"
               "do = \"projectile\"\n"
               "at = 0.354\n"
               "from = [-0.1, 0.23, 0.58]\n"
               "at_body = \"bauble\"\n"
               "speed = 13.7\n"
               "body = { kind = \"solid\", material = \"concrete\", shape = \"slab\", size = [0.032, 0.016, "
               "0.0225], element_size = 0.008 }\n");
  for (const char* seed : {"1", "8"}) {
    const auto report = play(folder, std::string("inherit.toml --audit --seed ") + seed);
    CHECK(report["breaks"].size() > 3);
    CHECK(report["audit"]["crossings"] == 0);
    CHECK(report["audit"]["passages"] == 0);
  }
}
