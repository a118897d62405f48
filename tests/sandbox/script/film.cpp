// The film's time against the world's, and the world between two steps.
#include <catch2/catch.hpp>

#include "sandbox/scene/build_world.h"
#include "sandbox/script/between.h"
#include "sandbox/script/film_clock.h"
#include "sandbox/script/script.h"
#include "tests/sandbox/script/building.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

TEST_CASE("the film's time is the world's until it is slowed down, and stretches smoothly from then on") {
  script::FilmClock clock;
  CHECK(clock.simulated_at(1.7) == 1.7);
  CHECK(clock.film_at(1.7) == 1.7);
  clock.change(1.0, 0.1, 0.5);
  // Over a smooth ramp of half a second the mean factor is (1 + 0.1) / 2.
  CHECK(clock.simulated_at(1.0) == Approx(1.0).epsilon(1e-14));
  CHECK(clock.simulated_at(1.5) == Approx(1.0 + 0.5 * 0.55).epsilon(1e-12));
  CHECK(clock.simulated_at(2.5) == Approx(1.275 + 0.1).epsilon(1e-12));
  CHECK(clock.factor_at(1.25) == Approx(0.55).epsilon(1e-12));
  double sum = 1.0;
  for (int i = 0; i < 10000; ++i) {
    const double film = 1.0 + (i + 0.5) * 1e-4;
    sum += 1e-4 * clock.factor_at(film);
    CHECK(clock.simulated_at(film + 0.5e-4) == Approx(sum).epsilon(1e-7));
    CHECK(clock.film_at(clock.simulated_at(film)) == Approx(film).epsilon(1e-12));
  }
  clock.change(2.5, 2.0, 0.0);  // at once, from where it is
  CHECK(clock.simulated_at(2.5) == Approx(1.375).epsilon(1e-12));
  CHECK(clock.simulated_at(3.5) == Approx(3.375).epsilon(1e-12));
  CHECK(clock.film_at(3.375) == Approx(3.5).epsilon(1e-12));
}

TEST_CASE("an event changes the film's speed at its step, and no state of the world") {
  const std::string balls =
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"a\"\nkind = \"sphere\"\nposition = [0,0.5,0]\n";
  const auto plain = scene::read(balls);
  const auto slow = scene::read(balls + "[[event]]\nat = 0.1\ndo = \"speed\"\nfactor = 0.25\n");
  auto built = build(plain), slowed = build(slow);
  script::Script script(*slow.scene);
  for (int step = 0; step < 60; ++step) {
    CHECK(script.play(*slowed).empty());
    slowed->world.step();
    built->world.step();
  }
  CHECK(built->world.state_hash() == slowed->world.state_hash());
  CHECK(script.clock().simulated_at(0.1) == Approx(0.1).epsilon(1e-12));
  CHECK(script.clock().simulated_at(0.5) == Approx(0.2).epsilon(1e-12));
}

TEST_CASE("between two steps bodies go straight on and turn evenly") {
  auto built =
      build(scene::read("[scene]\ngravity = [0,0,0]\nsteps_per_second = 100\n[[body]]\nname = \"a\"\n"
                        "kind = \"box\"\nsize = 0.1\nvelocity = [3,0,0]\nangular_velocity = [0,0,20]\n"));
  const std::vector<body::Body> before(built->world.bodies().begin(), built->world.bodies().end());
  built->world.step();
  const auto between = script::bodies_between(before, built->world, 0.25);
  REQUIRE(between.size() == 1);
  CHECK(between[0].pose.translation.isApprox(Vec3(0.0075, 0, 0), 1e-12));
  const Vec3 turned = between[0].pose.rotation * Vec3::UnitX();
  CHECK(turned.isApprox(Vec3(std::cos(0.05), std::sin(0.05), 0), 1e-9));
  const auto start = script::bodies_between(before, built->world, 0.0);
  CHECK(start[0].pose.translation == before[0].pose.translation);
}

TEST_CASE(
    "a body that breaks within a step is shown whole until its end, where its heaviest piece takes it") {
  auto built = build(scene::read(
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"ball\"\nkind = \"shell\"\nshape = \"sphere\"\n"
      "radius = 0.05\nthickness = 0.0006\nedge_length = 0.012\nmaterial = \"glass\"\nposition = [0,0.1,0]\n"
      "velocity = [0,-6,0]\n"));
  std::vector<body::Body> before;
  while (built->world.report().breaks.empty() && built->world.steps() < 100) {
    before.assign(built->world.bodies().begin(), built->world.bodies().end());
    built->world.step();
  }
  REQUIRE(built->world.report().breaks.size() > 0);
  REQUIRE(built->world.bodies().size() > 3);
  const auto between = script::bodies_between(before, built->world, 0.5);
  REQUIRE(between.size() == before.size());
  const body::Body* heaviest = nullptr;
  for (const body::Body& body : built->world.bodies())
    if (body.shape->kind == body::ShapeKind::shell && (!heaviest || body.shape->mass > heaviest->shape->mass))
      heaviest = &body;
  // The whole's centre, in the material that it shares with the piece, is half way.
  const Vec3 centre = before[1].shape->material_from_body - heaviest->shape->material_from_body;
  const Vec3 start = before[1].pose.translation, end = heaviest->pose.apply(centre);
  CHECK((between[1].pose.translation - 0.5 * (start + end)).norm() < 1e-9 * (end - start).norm());
}
