// Events land on step borders, projectiles fly through their target.
#include "sandbox/script/script.h"

#include <catch2/catch.hpp>

#include "sandbox/scene/parts.h"
#include "tests/sandbox/script/building.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

/// Plays so many steps. How many bodies there were in each.
std::vector<std::size_t> count_bodies(script::Script& script, scene::BuiltScene& built, int steps) {
  std::vector<std::size_t> counts;
  for (int step = 0; step < steps; ++step) {
    CHECK(script.play(built).empty());
    counts.push_back(built.world.bodies().size());
    built.world.step();
  }
  return counts;
}

/// Plays up to a time of the world, s, and collects what the script says.
void play_until(double time, script::Script& script, scene::BuiltScene& built,
                std::vector<std::string>& words) {
  while (built.world.time() < time - 1e-9) {
    for (std::string& word : script.play(built)) words.push_back(word);
    built.world.step();
  }
}

}  // namespace

TEST_CASE("a thrown body passes through its target, whatever pulls at it") {
  for (const Vec3& gravity : {Vec3(0, -9.81, 0), Vec3(0, 0, 0), Vec3(3, -1, 2)}) {
    const Vec3 from(-1, 0.5, 2), target(0.3, 1.2, 0);
    const auto aimed = script::aim(from, target, 10.0, gravity);
    REQUIRE(aimed.has_value());
    const Vec3 velocity = *aimed;
    CHECK(velocity.norm() == Approx(10.0).epsilon(1e-12));
    double least = 1e9;
    for (int i = 0; i <= 100000; ++i) {
      const double t = i * 1e-5;
      least = std::min(least, (from + t * velocity + 0.5 * t * t * gravity - target).norm());
    }
    CHECK(least < 1e-4);
  }
}

TEST_CASE(
    "a moving target is led, whether it falls or rolls, and one that runs away is aimed at where it is") {
  const Vec3 gravity(0, -9.81, 0), from(-2, 0.5, 1);
  for (const bool is_falling : {false, true}) {
    const script::MovingTarget target{Vec3(0.3, 1.2, 0), Vec3(1.5, -2.0, 0.7), is_falling};
    const Vec3 place = script::lead(from, target, 10.0, gravity);
    const Vec3 velocity = script::aim(from, place, 10.0, gravity).value();
    double least = 1e9;
    for (int i = 0; i <= 100000; ++i) {
      const double t = i * 1e-5;
      const Vec3 thrown = from + t * velocity + 0.5 * t * t * gravity;
      const Vec3 there = target.place + t * target.velocity + (is_falling ? 0.5 : 0.0) * t * t * gravity;
      least = std::min(least, (thrown - there).norm());
    }
    CHECK(least < 2e-4);
  }
  const script::MovingTarget gone{Vec3(1, 0, 0), Vec3(20, 0, 0), false};
  CHECK(script::lead(Vec3::Zero(), gone, 10.0, Vec3::Zero()) == gone.place);
}

TEST_CASE("a target out of reach is told") {
  CHECK_FALSE(script::aim(Vec3::Zero(), Vec3(1000, 0, 0), 1.0, Vec3(0, -9.81, 0)).has_value());
  CHECK_FALSE(script::aim(Vec3::Zero(), Vec3(0, 1, 0), 4.42, Vec3(0, -9.81, 0)).has_value());  // v2 < 2 g h
  CHECK(script::aim(Vec3::Zero(), Vec3(0, 1, 0), 4.43, Vec3(0, -9.81, 0)).has_value());
}

TEST_CASE("events land on the first step border at or after their time") {
  const auto reading = scene::read(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"a\"\nkind = \"sphere\"\nposition = [5,0,0]\n"
      "[[event]]\nat = 0.1\ndo = \"projectile\"\nfrom = [0,3,0]\nat_point = [0,4,0]\nspeed = 1\n"
      "[[event]]\nat = 0.1001\ndo = \"drop\"\nbody = {kind = \"box\", size = 0.1}\nposition = [0,9,0]\n");
  auto built = build(reading);
  CHECK(built->world.bodies().size() == 1);  // what events bring in waits
  script::Script script(*reading.scene);
  const std::vector<std::size_t> counts = count_bodies(script, *built, 26);
  CHECK(counts[23] == 1);
  CHECK(counts[24] == 2);  // 0.1 s at 240 steps a second
  CHECK(counts[25] == 3);
  CHECK(script.is_over());
}

TEST_CASE(
    "a push moves what it names by impulse over mass, its copies as one, and turns what it meets beside") {
  const auto reading = scene::read(
      "[scene]\ngravity = [0,0,0]\n"
      "[[body]]\nname = \"box\"\nkind = \"box\"\nsize = [0.2, 0.4, 0.6]\ndensity = 1000\n"
      "[[body]]\nname = \"row\"\nkind = \"box\"\nsize = 0.1\ndensity = 1000\nposition = [5,0,0]\n"
      "repeat = {count = 3, spacing = [1,0,0]}\n"
      "[[event]]\nat = 0\ndo = \"push\"\nbody = \"row\"\nimpulse = [0,6,0]\n"
      "[[event]]\nat = 0\ndo = \"push\"\nbody = \"box\"\nimpulse = [0,0,12]\npoint = [0.1,0,0.3]\n"
      "[[event]]\nat = 0.1\ndo = \"remove\"\nbody = \"row\"\n"
      "[[event]]\nat = 0.2\ndo = \"push\"\nbody = \"row\"\nimpulse = [1,0,0]\n");
  auto built = build(reading);
  script::Script script(*reading.scene);
  CHECK(script.play(*built).empty());
  const auto bodies = built->world.bodies();
  REQUIRE(bodies.size() == 4);
  CHECK(bodies[0].velocity.isApprox(Vec3(0, 0, 12.0 / 48.0), 1e-12));
  // r x J = (0.1, 0, 0.3) x (0, 0, 12) = (0, -1.2, 0); I_y = m (0.2^2 + 0.6^2) / 12.
  CHECK(bodies[0].angular_velocity.isApprox(Vec3(0, -1.2 / (48.0 * 0.4 / 12.0), 0), 1e-12));
  for (std::size_t i = 1; i < 4; ++i) CHECK(bodies[i].velocity.isApprox(Vec3(0, 2, 0), 1e-12));
  while (built->world.time() < 0.15) {
    built->world.step();
    CHECK(script.play(*built).empty());
  }
  CHECK(built->world.bodies().size() == 1);
  std::vector<std::string> faults;
  while (built->world.time() < 0.25) {
    built->world.step();
    for (const std::string& fault : script.play(*built)) faults.push_back(fault);
  }
  REQUIRE(faults.size() == 1);
  CHECK(faults[0].find("its body is not there") != std::string::npos);
}

TEST_CASE("copies with a time between them come in one after another, named and placed by their numbers") {
  const auto reading = scene::read(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"drops\"\nkind = \"sphere\"\n"
      "repeat = {count = 3, spacing = [1, 0, 0], every = 0.1}\n");
  auto built = build(reading);
  script::Script script(*reading.scene);
  const std::vector<std::size_t> counts = count_bodies(script, *built, 50);
  CHECK(counts[0] == 1);
  CHECK(counts[23] == 1);
  CHECK(counts[24] == 2);
  CHECK(counts[47] == 2);
  CHECK(counts[48] == 3);
  CHECK(script.is_over());
  CHECK(built->world.bodies()[2].name == "drops[3]");
  CHECK(built->world.bodies()[2].pose.translation == Vec3(2, 0, 0));
  CHECK(built->origins.at(built->world.bodies()[2].id).copy == 2);
}

TEST_CASE("a copy waits until there is room for it, an event into another body is refused, both in words") {
  const auto reading = scene::read(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"drops\"\nkind = \"shell\"\nshape = \"sphere\"\nradius "
      "= 0.1\n"
      "edge_length = 0.05\nbreakable = false\nvelocity = [1, 0, 0]\nrepeat = {count = 2, every = 0.1}\n"
      "[[event]]\nname = \"late\"\nat = 0.12\ndo = \"drop\"\nbody = {kind = \"box\", size = 0.1}\n"
      "position = [0.15, 0, 0]\n");
  auto built = build(reading);
  script::Script script(*reading.scene);
  std::vector<std::string> words;
  int second_step = -1;
  for (int step = 0; step < 60; ++step) {
    for (std::string& word : script.play(*built)) words.push_back(word);
    if (second_step < 0 && built->world.bodies().size() == 2) second_step = step;
    built->world.step();
  }
  // Two spheres of 0.1 m at 1 m/s: clear of each other after 0.2 s, about step 48 (their meshes are inside).
  CHECK(second_step > 40);
  CHECK(second_step <= 49);
  REQUIRE(words.size() == 2);
  CHECK(words[0].find("drops[2] waits at 0.1 s: drops[1]") == 0);
  CHECK(words[1].find("\"late\"") != std::string::npos);
  CHECK(script.is_over());
}

TEST_CASE("hands grab, carry and release, explosions and gravity come on time, and what cannot be is told") {
  const auto reading = scene::read(
      "[[body]]\nname = \"a\"\nkind = \"box\"\nsize = 0.1\nposition = [0,2,0]\n"
      "[[body]]\nname = \"b\"\nkind = \"box\"\nsize = 0.1\nposition = [9,2,0]\n"
      "[[event]]\nat = 0\ndo = \"grab\"\nbody = \"a\"\n"
      "[[event]]\nat = 0.5\ndo = \"move\"\nbody = \"a\"\nto = [0,3,0]\nduration = 0.5\n"
      "[[event]]\nat = 1\ndo = \"gravity\"\ngravity = [0,0,0]\nramp = 0.2\n"
      "[[event]]\nat = 1.5\ndo = \"release\"\nbody = \"a\"\n"
      "[[event]]\nat = 1.6\ndo = \"move\"\nbody = \"a\"\nto = [0,0,0]\n"
      "[[event]]\nat = 2\ndo = \"explosion\"\ncentre = [-1,3,0]\nenergy = 1e5\n");
  auto built = build(reading);
  script::Script script(*reading.scene);
  std::vector<std::string> words;
  const auto play_to = [&](double time) {
    play_until(time, script, *built, words);
    return built->world.bodies()[0];
  };
  CHECK((play_to(0.5).pose.translation - Vec3(0, 2, 0)).norm() < 1e-3);
  CHECK((play_to(0.75).pose.translation - Vec3(0, 2.5, 0)).norm() < 0.02);
  CHECK((play_to(1.0).pose.translation - Vec3(0, 3, 0)).norm() < 0.02);
  const body::Body fallen = built->world.bodies()[1];
  CHECK(fallen.pose.translation.y() == Approx(2 - 0.5 * 9.81).epsilon(1e-6));
  CHECK(play_to(1.2).id == 1);
  // Over the smooth ramp gravity acts for half its time.
  CHECK(built->world.bodies()[1].velocity.y() == Approx(-9.81 * 1.1).epsilon(0.01));
  CHECK(built->world.settings().gravity == Vec3(0, 0, 0));
  CHECK(play_to(1.9).velocity.norm() < 1e-3);
  REQUIRE(words.size() == 1);
  CHECK(words[0].find("no hand holds its body") != std::string::npos);
  CHECK(play_to(2.1).velocity.x() > 0.01);
  CHECK(script.is_over());
}

TEST_CASE("an event means one copy where it names one, and all of them where it names their body") {
  const auto reading = scene::read(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.1\n"
      "repeat = {count = 4, spacing = [1, 0, 0]}\n"
      "[[event]]\nat = 0\ndo = \"push\"\nbody = \"ball[2]\"\nimpulse = [0,3,0]\n"
      "[[event]]\nat = 0\ndo = \"remove\"\nbody = \"ball[4]\"\n"
      "[[event]]\nat = 0\ndo = \"grab\"\nbody = \"ball[1]\"\n"
      "[[event]]\nat = 0\ndo = \"move\"\nbody = \"ball[1]\"\nto = [0,0,1]\nduration = 0.1\n"
      "[[event]]\nat = 0\ndo = \"move\"\nbody = \"ball\"\nto = [0,0,1]\n"
      "[[event]]\nat = 0.5\ndo = \"projectile\"\nfrom = [2,5,0]\nat_body = \"ball[3]\"\nspeed = 50\n"
      "[[event]]\nat = 1\ndo = \"remove\"\nbody = \"ball\"\n");
  REQUIRE(reading.scene);
  auto built = build(reading);
  script::Script script(*reading.scene);
  std::vector<std::string> words;
  const auto play_to = [&](double time) { play_until(time, script, *built, words); };
  const auto find = [&](const std::string& name) -> const body::Body* {
    for (const body::Body& body : built->world.bodies())
      if (body.name == name) return &body;
    return nullptr;
  };
  play_to(0.4);
  CHECK(find("ball[4]") == nullptr);
  REQUIRE(find("ball[2]"));
  CHECK(find("ball[2]")->velocity.y() > 0.0);
  CHECK(find("ball[3]")->velocity == Vec3(0, 0, 0));
  CHECK((find("ball[1]")->pose.translation - Vec3(0, 0, 1)).norm() < 0.02);
  REQUIRE(words.size() == 1);  // all of them are held by no hand
  CHECK(words[0].find("no hand holds its body") != std::string::npos);
  play_to(0.7);
  CHECK(find("ball[3]")->velocity.y() < -0.1);
  play_to(1.1);
  CHECK(built->world.bodies().size() == 1);  // what was thrown
  const scene::BodyRef second{0, 1};
  CHECK(!scene::centre_of(*built, built->world.bodies(), second));
}

TEST_CASE("what is thrown at a place of the picture meets what is seen there") {
  const auto reading = scene::read(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"wall\"\nkind = \"box\"\nsize = [3,3,0.2]\nmotion = "
      "\"static\"\n"
      "[[event]]\nat = 0\ndo = \"projectile\"\nat_screen = [0.25, -0.5]\nspeed = 10\n"
      "[[event]]\nat = 0.1\ndo = \"projectile\"\nfrom = [0,3,3]\nat_screen = [2, 0]\nspeed = 10\n");
  auto built = build(reading);
  script::Script script(*reading.scene);
  script::Sight sight;  // a metre of picture height at the target
  sight.eye = Vec3(0, 0, 5);
  const auto look = [&sight] { return sight; };
  CHECK(script.play(*built, look).empty());
  REQUIRE(built->world.bodies().size() == 2);
  // From the eye through (0.25, -0.5, 0) onto the wall's face at z = 0.1.
  const Vec3 way = Vec3(0.25, -0.5, -5);
  CHECK(built->world.bodies()[1].pose.translation == sight.eye);
  CHECK(built->world.bodies()[1].velocity.isApprox(10.0 * way.normalized(), 1e-9));
  while (built->world.time() < 0.1) built->world.step();
  CHECK(script.play(*built, look).empty());
  REQUIRE(built->world.bodies().size() == 3);
  // 2 m aside of the target there is the wall's edge no more: as far as the camera looks.
  CHECK(built->world.bodies()[2].velocity.isApprox(10.0 * Vec3(2, -3, -3).normalized(), 1e-9));
}

TEST_CASE("a drop brings in all copies of its body, one after another where it says so") {
  const auto reading = scene::read(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nkind = \"plane\"\nposition = [0,-9,0]\n"
      "[[event]]\nat = 0.1\ndo = \"drop\"\nposition = [5,1,0]\n"
      "body = {kind = \"sphere\", radius = 0.1, position = [1,0,0], repeat = {count = [3,1,2], spacing = "
      "0.5}}\n"
      "[[event]]\nat = 0.2\ndo = \"drop\"\n"
      "body = {kind = \"sphere\", radius = 0.1, repeat = {count = 3, spacing = [1,0,0], every = 0.05}}\n");
  auto built = build(reading);
  script::Script script(*reading.scene);
  const std::vector<std::size_t> counts = count_bodies(script, *built, 80);
  CHECK(counts[23] == 1);
  CHECK(counts[24] == 7);
  CHECK(built->world.bodies()[1].pose.translation == Vec3(5, 1, 0));
  CHECK(built->world.bodies()[6].pose.translation == Vec3(6, 1, 0.5));
  CHECK(counts[48] == 8);
  CHECK(counts[59] == 8);
  CHECK(counts[60] == 9);
  CHECK(counts[72] == 10);
  CHECK(script.is_over());
}
