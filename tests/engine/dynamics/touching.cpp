// Bodies that are placed closer than the usual gap: never blown open, not cut short, and at rest where they
// are.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "tests/engine/dynamics/piles.h"
#include "tests/support/sanitized.h"

namespace shatterbox {
namespace {

constexpr double kWidth = 0.2;  // m, of all of them

struct Kind {
  const char* name;
  std::function<body::Body(double)> make;  // its lowest point at this height, m
  double height;                           // m, of what lies on it
};

body::Body make_lifted(geometry::TriangleMesh mesh, double height) {
  for (Vec3& p : mesh.positions) p.y() += height;
  return test::make_shell(mesh);
}

const Kind kBox{"box", [](double y) { return test::make_box(Vec3::Constant(0.1), Vec3(0, y + 0.1, 0)); },
                kWidth};
const Kind kSphere{"sphere", [](double y) { return test::make_sphere(0.1, Vec3(0, y + 0.1, 0)); }, kWidth};
const Kind kPlate{"plate", [](double y) { return make_lifted(test::square_mesh(0.1, 3), y); }, 0.0};
const Kind kBowl{"bowl", [](double y) { return make_lifted(test::bowl_mesh(0.1, 4, 12, 0.0), y + 0.1); },
                 0.0};

struct Touched {
  int cut = 0, exempt = 0;
  double fastest = 0.0;  // m/s, of any point of any body
};

Touched watch_touching(test::Scene& scene, int steps) {
  Touched outcome;
  for (int i = 0; i < steps; ++i) {
    scene.step();
    outcome.cut += scene.report.failsafe_steps;
    outcome.exempt += scene.report.crossing_pairs;
    for (const auto& b : scene.bodies) {
      if (!b.is_dynamic()) continue;
      const double speed = b.velocity.norm() + b.shape->bounding_radius * b.angular_velocity.norm();
      outcome.fastest = std::max(outcome.fastest, speed);
    }
  }
  return outcome;
}

void check_pair(const Kind& upper, const Kind& lower, double gap, bool has_gravity) {
  test::Scene scene;
  if (has_gravity)
    scene.add(test::make_plane());
  else
    scene.settings.gravity.setZero();
  scene.add(lower.make(gap));
  scene.add(upper.make(2.0 * gap + lower.height));
  const Touched outcome = watch_touching(scene, 24);
  INFO(upper.name << " on " << lower.name << ", gap " << gap / kWidth << " of their size, "
                  << (has_gravity ? "with" : "without") << " gravity: fastest " << outcome.fastest << " m/s");
  CHECK(outcome.cut == 0);
  CHECK(outcome.exempt == 0);
  // A gap of 1e-4 m that opens within a step would be 0.024 m/s.
  CHECK(outcome.fastest < (has_gravity ? 2e-3 : 1e-7));
}

}  // namespace

TEST_CASE("what is placed within 1e-5 of its size is not blown open, nor cut short") {
  for (const double gap : {1e-5 * kWidth, 1e-6 * kWidth}) {
    for (const bool has_gravity : {false, true}) {
      for (const Kind& lower : {kBox, kSphere, kPlate})
        for (const Kind& upper : {kBox, kSphere, kPlate, kBowl}) check_pair(upper, lower, gap, has_gravity);
    }
  }
}

TEST_CASE("what is placed touching is not blown open, nor cut short") {
  for (const bool has_gravity : {false, true}) {
    check_pair(kBox, kBox, 0.0, has_gravity);
    for (const Kind& kind : {kBox, kSphere, kPlate}) check_pair(kSphere, kind, 0.0, has_gravity);
    for (const Kind& kind : {kBox, kPlate}) check_pair(kBowl, kind, 0.0, has_gravity);
    for (const Kind& kind : {kBox, kPlate, kBowl}) check_pair(kind, kSphere, 0.0, has_gravity);
  }
}

TEST_CASE("bowls nested within 1e-5 of their size stay so, and leave each other freely") {
  for (const double gap : {1e-5 * kWidth, 5e-6 * kWidth}) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    // At the rim the walls lean by a sixteenth of a turn: there the gap is the least.
    const double shift = gap / core::sin(core::kPi / 16.0);
    scene.add(kBowl.make(0.0));
    scene.add(kBowl.make(shift));
    const Touched still = watch_touching(scene, 24);
    INFO("gap " << gap / kWidth << " of their size: fastest " << still.fastest << " m/s");
    CHECK(still.cut == 0);
    CHECK(still.exempt == 0);
    CHECK(still.fastest < 1e-7);
    scene.bodies[1].velocity = Vec3(0, 1.0, 0);
    const Touched leaving = watch_touching(scene, 120);
    CHECK(leaving.cut == 0);
    CHECK(scene.bodies[0].velocity.norm() < 1e-6);
    CHECK(scene.bodies[1].velocity.y() == Approx(1.0).epsilon(1e-6));
  }
}

TEST_CASE("plates edge to edge in one plane within 1e-5 of their size stay so, and slide apart freely") {
  test::Scene scene;
  scene.settings.gravity.setZero();
  for (int k = 0; k < 3; ++k) {
    auto plate = kPlate.make(0.0);
    plate.pose.translation.x() = (1.0 + 1e-5) * kWidth * k;
    scene.add(plate);
  }
  const Touched still = watch_touching(scene, 24);
  CHECK(still.cut == 0);
  CHECK(still.fastest < 1e-7);
  scene.bodies[2].velocity = Vec3(0.5, 0.2, 0.3);
  scene.bodies[0].velocity = Vec3(-0.5, 0.2, 0.3);
  const Touched leaving = watch_touching(scene, 120);
  CHECK(leaving.cut == 0);
  CHECK(scene.bodies[1].velocity.norm() < 1e-6);
  CHECK(scene.bodies[2].velocity.x() == Approx(0.5).epsilon(1e-6));
}

TEST_CASE("ten boxes placed exactly touching stand from the first step on") {
  // A stack is solved on one thread: of more the sanitizers would see the same again.
  for (const int rate : test::kIsSanitized ? std::vector{60} : std::vector{60, 240, 960}) {
    for (const double height : test::kIsSanitized ? std::vector{0.1} : std::vector{0.2, 0.1, 0.3333}) {
      test::Scene scene;
      scene.settings.time_step = 1.0 / rate;
      scene.add(test::make_plane());
      std::vector<double> places;
      for (int k = 0; k < 10; ++k) {
        places.push_back(0.5 * height + k * height);
        scene.add(test::make_box(Vec3(0.1, 0.5 * height, 0.15), Vec3(0, places.back(), 0)));
      }
      const double usual = scene.settings.kept_gap * 2.0 * scene.bodies[1].shape->bounding_radius;
      const double energy = scene.energy();
      double most_energy = energy, lowest = 0.0, highest = 0.0;
      int cut = 0;
      for (int i = 0; i < 2 * rate; ++i) {
        scene.step();
        cut += scene.report.failsafe_steps;
        most_energy = std::max(most_energy, scene.energy());
        for (std::size_t k = 0; k < 10; ++k) {
          const double sunk = scene.bodies[k + 1].pose.translation.y() - places[k];
          lowest = std::min(lowest, sunk);
          highest = std::max(highest, sunk);
        }
      }
      INFO(rate << " steps a second, height " << height << ": sank by " << lowest << ", rose by " << highest
                << " m");
      CHECK(cut == 0);
      CHECK(scene.report.crossing_pairs == 0);
      CHECK(lowest > -usual);
      CHECK(highest < 10.01 * usual);
      double mass = 0.0;
      for (const auto& b : scene.bodies) mass += b.is_dynamic() ? b.shape->mass : 0.0;
      CHECK(most_energy - energy < mass * 9.81 * 10.0 * usual);
      CHECK(std::abs(scene.bodies[10].pose.translation.x()) < 2e-3);  // a hundredth of its width
    }
  }
}

TEST_CASE(
    "a box placed touching on a table with its middle beyond the edge tips over it as one with a gap does") {
  const auto tip = [](int rate, double gap, double speed) {
    test::Scene scene;
    scene.settings.time_step = 1.0 / rate;
    auto table = test::make_box(Vec3(0.5, 0.05, 0.5), Vec3(-0.5, 0, 0));
    table.motion = body::Motion::fixed;
    table.inverse_mass = 0.0;
    table.inverse_inertia.setZero();
    scene.add(table);
    scene.add(test::make_box(Vec3(0.05, 0.01, 0.025), Vec3(0.02, 0.06 + gap, 0)));
    scene.bodies[1].velocity = Vec3(speed, 0, 0);
    int cut = 0;
    for (int i = 0; i < rate / 4; ++i) {
      scene.step();
      cut += scene.report.failsafe_steps;
    }
    CHECK(cut <= 1);
    CHECK(scene.report.crossing_pairs == 0);
    return scene.bodies[1];
  };
  for (const int rate : {60, 240, 960})
    for (const double speed : {0.0, 0.3}) {
      const body::Body usual = tip(rate, 5e-5, speed);
      REQUIRE(usual.angular_velocity.z() < -5.0);
      for (const double gap : {0.0, 1e-7, 1e-6, 5e-6}) {
        CAPTURE(rate, speed, gap);
        const body::Body touching = tip(rate, gap, speed);
        CHECK(touching.angular_velocity.z() == Approx(usual.angular_velocity.z()).epsilon(0.1));
        CHECK((touching.pose.translation - usual.pose.translation).norm() < 0.03);  // a step's fall
      }
    }
}

TEST_CASE("surfaces placed exactly in each other part without a push, and none hangs on the other") {
  struct Case {
    const char* name;
    std::function<void(test::Scene&)> add;
    bool falls;
  };
  const auto shifted = [](body::Body b, double by) {
    b.pose.translation.x() += by;
    return b;
  };
  const std::vector<Case> cases = {
      {"a plate on a box's top",
       [](test::Scene& s) {
         s.add(kBox.make(0.0));
         s.add(kPlate.make(kWidth));
       },
       false},
      {"a plate on a box's top, level but for rounding",
       [](test::Scene& s) {
         s.add(kBox.make(0.0));
         geometry::TriangleMesh mesh = test::square_mesh(0.1, 3);
         for (std::size_t k = 0; k < mesh.positions.size(); ++k)
           mesh.positions[k].y() += kWidth + (k % 3 == 0 ? -2e-16 : 1e-16);
         s.add(test::make_shell(mesh));
       },
       false},
      {"a plate under a box",
       [](test::Scene& s) {
         s.add(kBox.make(0.5));
         s.add(kPlate.make(0.5));
       },
       true},
      {"two plates in one place",
       [](test::Scene& s) {
         s.add(kPlate.make(0.5));
         s.add(kPlate.make(0.5));
       },
       true},
      {"two plates in one plane, one over the other's border",
       [&](test::Scene& s) {
         s.add(kPlate.make(0.5));
         s.add(shifted(kPlate.make(0.5), 0.03));
       },
       true},
      {"two plates edge to edge",
       [&](test::Scene& s) {
         s.add(kPlate.make(0.5));
         s.add(shifted(kPlate.make(0.5), kWidth));
       },
       true},
      {"five plates in one place, on the floor",
       [](test::Scene& s) {
         for (int k = 0; k < 5; ++k) s.add(kPlate.make(0.0));
       },
       false},
      {"two bowls in one place",
       [](test::Scene& s) {
         s.add(kBowl.make(0.5));
         s.add(kBowl.make(0.5));
       },
       true},
  };
  for (const Case& c : cases) {
    for (const bool has_gravity : {false, true}) {
      test::Scene scene;
      scene.add(test::make_plane());
      if (!has_gravity) scene.settings.gravity.setZero();
      c.add(scene);
      std::vector<double> places;
      for (const auto& b : scene.bodies) places.push_back(b.pose.translation.y());
      std::size_t parted = 0;
      int cut = 0, exempt = 0;
      double fastest = 0.0;
      for (int i = 0; i < 60; ++i) {
        scene.step();
        parted += scene.report.parted.size();
        cut += scene.report.failsafe_steps;
        exempt += scene.report.crossing_pairs;
        if (has_gravity && c.falls) continue;
        for (const auto& b : scene.bodies) fastest = std::max(fastest, b.velocity.norm());
      }
      INFO(c.name << (has_gravity ? "" : ", without gravity") << ": parted " << parted << ", fastest "
                  << fastest << " m/s");
      CHECK(parted >= 1);
      CHECK(cut == 0);
      CHECK(exempt == 0);
      for (std::size_t k = 1; k < scene.bodies.size(); ++k) {
        const double fallen = places[k] - scene.bodies[k].pose.translation.y();
        if (has_gravity && c.falls)
          CHECK(fallen == Approx(0.5 * 9.81 * 0.25 * 0.25).epsilon(0.01));
        else
          CHECK(std::abs(fallen) < 2e-3 * kWidth);
      }
      // A gap of 4e-6 m that opens within a step would be 1e-3 m/s.
      if (!(has_gravity && c.falls)) CHECK(fastest < (has_gravity ? 2e-3 : 1e-5));
    }
  }
}

TEST_CASE("solid blocks placed edge to edge, in a row or in a slab, fall as any other body") {
  for (const int count : {2, 3, 5})
    for (const int deep : {1, 3})
      for (const double half : {0.05, 0.1}) {
        test::Scene scene;
        for (int k = 0; k < count; ++k)
          for (int m = 0; m < deep; ++m)
            scene.add(
                test::make_solid_block(Vec3(half, 0.05, 0.07), Vec3(2.0 * half * k, 1.0, 2.0 * 0.07 * m)));
        int cut = 0, exempt = 0;
        for (int i = 0; i < 60; ++i) {
          scene.step();
          cut += scene.report.failsafe_steps;
          exempt += scene.report.crossing_pairs;
        }
        INFO(count << " by " << deep << " blocks " << 2.0 * half << " m wide");
        CHECK(cut == 0);
        CHECK(exempt == 0);
        for (const auto& b : scene.bodies)
          CHECK(1.0 - b.pose.translation.y() == Approx(0.5 * 9.81 * 0.25 * 0.25).epsilon(0.01));
      }
}

namespace {

/// A fan in the plane of that x, its middle vertex at `middle`.
body::Body make_fan(double x, double middle) {
  constexpr double kRadius = 0.05;
  geometry::TriangleMesh mesh;
  mesh.positions.push_back(Vec3(middle, 0.5, 0.0));
  for (int k = 0; k < 8; ++k) {
    const double angle = 0.25 * core::kPi * (k + 0.3);
    mesh.positions.push_back(Vec3(x, 0.5 + kRadius * std::sin(angle), kRadius * std::cos(angle)));
    mesh.triangles.push_back({0, k + 1, (k + 1) % 8 + 1});
  }
  return test::make_shell(mesh);
}

}  // namespace

TEST_CASE("the way of what is set aside goes there at once and then on") {
  // The second one is seen first in the third of four parts of the step.
  for (const int first : {0, 2}) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    scene.settings.has_ways = true;
    scene.add(make_fan(0.0, 0.0));
    dynamics::ContactReport step;
    Vec3 before = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      if (k == first) {
        scene.add(make_fan(1e-4, 0.0)).velocity = Vec3(0.0, 1.0, 0.0);
        before = scene.bodies[1].pose.translation;
      }
      dynamics::add_part(
          {k, 4}, dynamics::move_part(scene.bodies, scene.settings, {k, 4}, scene.state, scene.log), step);
    }
    REQUIRE(step.parted.size() == 1);
    REQUIRE(step.ways.size() == 2);
    const auto& points = step.ways[1].points;
    const std::size_t aside = first == 0 ? 0 : 1;  // behind where the part begins
    REQUIRE(points.size() == 4 + aside - static_cast<std::size_t>(first));
    CHECK(points[aside].time == Approx(0.25 * first).margin(1e-9));
    CHECK(points[aside].time > 0.25 * first);
    const Vec3 shift = points[aside].pose.translation - before;
    CHECK(shift.x() > 0.9 * shift.norm());
    CHECK(points[aside + 1].pose.translation.y() - points[aside].pose.translation.y() ==
          Approx(0.25 * scene.settings.time_step).epsilon(1e-6));
  }
}

TEST_CASE("sheets beside each other that touch in a point part to the sides on which they are") {
  // A fan in the plane x = 0, and one beside it whose middle vertex is in the middle of the first.
  constexpr double kApart = 1e-4;
  for (const double side : {1.0, -1.0}) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    scene.add(make_fan(0.0, 0.0));
    scene.add(make_fan(side * kApart, 0.0));
    const Vec3 before = scene.bodies[1].pose.translation;
    scene.step();
    CHECK(scene.report.parted.size() == 1);
    const Vec3 moved = scene.bodies[1].pose.translation - before;
    CHECK(side * moved.x() > 0.9 * moved.norm());
    CHECK(scene.report.crossing_pairs == 0);
  }
}

TEST_CASE("balls of one place and size cannot part: they are named, and fall") {
  geometry::Meshing meshing;
  meshing.edge_length = 0.05;
  auto mesh = geometry::make_sphere(0.1, meshing).value();
  test::Scene scene;
  for (int k = 0; k < 2; ++k) scene.add(test::make_shell(mesh));
  scene.step();
  CHECK(scene.report.new_crossing_pairs.size() == 1);
  CHECK(scene.report.parted.empty());
  for (int i = 0; i < 59; ++i) scene.step();
  CHECK(scene.report.crossing_pairs == 1);
  for (const auto& b : scene.bodies)
    CHECK(b.pose.translation.y() == Approx(-0.5 * 9.81 * 0.25 * 0.25).epsilon(1e-3));
}

}  // namespace shatterbox
