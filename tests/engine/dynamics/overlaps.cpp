// Bodies that lie in each other when they are first seen: they pass until they have come apart, and hang on
// nothing.
#include <catch2/catch.hpp>

#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

struct Fall {
  double least = 1e300;  // m, of the falls
  int cut = 0;
  std::size_t named = 0, parted = 0;
};

/// m, of what fell freely.
double free_fall(const test::Scene& scene, int steps) {
  const double time = steps * scene.settings.time_step;
  return 0.5 * scene.settings.gravity.norm() * time * time;
}

Fall watch_fall(test::Scene& scene, int steps) {
  Fall fall;
  std::vector<double> before;
  for (const body::Body& b : scene.bodies) before.push_back(b.pose.translation.y());
  for (int i = 0; i < steps; ++i) {
    scene.step();
    fall.cut += scene.report.failsafe_steps;
    fall.named += scene.report.new_crossing_pairs.size();
    fall.parted += scene.report.parted.size();
  }
  for (std::size_t i = 0; i < before.size(); ++i)
    fall.least = std::min(fall.least, before[i] - scene.bodies[i].pose.translation.y());
  return fall;
}

void check_free_fall(test::Scene& scene) {
  constexpr int kSteps = 24;
  const Fall fall = watch_fall(scene, kSteps);
  CHECK(fall.cut == 0);
  CHECK(fall.named == scene.bodies.size() - 1);
  CHECK(fall.parted == 0);
  CHECK(fall.least == Approx(free_fall(scene, kSteps)));
}

}  // namespace

TEST_CASE("blocks in each other with their sides in one plane fall as if alone") {
  const Vec3 half(0.12, 0.035, 0.06);
  for (const Vec3& beside : {Vec3(0.238, 0, 0), Vec3(0, 0.068, 0), Vec3(0, 0, 0.11), Vec3(0.12, 0.068, 0)}) {
    INFO("beside by " << beside.transpose());
    for (const bool is_box : {false, true}) {
      test::Scene scene;
      scene.add(test::make_solid_block(half, Vec3(0.3, 1.0, 0.2)));
      scene.add(is_box ? test::make_box(half, Vec3(0.3, 1.0, 0.2) + beside)
                       : test::make_solid_block(half, Vec3(0.3, 1.0, 0.2) + beside));
      check_free_fall(scene);
    }
  }
}

TEST_CASE("blocks that touch, or are in each other by a micrometre, are set aside, and none passes") {
  const Vec3 half(0.12, 0.035, 0.06);
  for (const Vec3& beside : {Vec3(0.24, 0, 0), Vec3(0, 0.07, 0), Vec3(0.12, 0.07, 0), Vec3(0.239999, 0, 0),
                             Vec3(0, 0.069999, 0), Vec3(0.12, 0.069999, 0)}) {
    INFO("beside by " << beside.transpose());
    test::Scene scene;
    scene.add(test::make_solid_block(half, Vec3(0, 1, 0)));
    scene.add(test::make_solid_block(half, Vec3(0, 1, 0) + beside));
    const Fall fall = watch_fall(scene, 24);
    CHECK(fall.named == 0);
    CHECK(fall.parted == 1);
    CHECK(fall.cut == 0);
  }
}

TEST_CASE("what begins half in the floor is brought out of it before it sleeps") {
  test::Scene scene;
  scene.add(test::make_plane());
  const double half = 0.2;
  scene.add(test::make_box(Vec3::Constant(half), Vec3(0, 0.5 * half, 0)));
  scene.add(test::make_solid_block(Vec3::Constant(half), Vec3(1, 0.5 * half, 0)));
  scene.add(test::make_sphere(half, Vec3(2, 0.25 * half, 0)));
  for (int i = 0; i < 1200; ++i) scene.step();
  for (std::size_t k = 1; k < scene.bodies.size(); ++k) {
    INFO("body " << k);
    CHECK(!scene.bodies[k].is_awake);
    const double height = scene.bodies[k].pose.translation.y() - half;
    CHECK(height >= 0.0);
    CHECK(height <= 1.1 * scene.settings.kept_gap * 2.0 * scene.bodies[k].shape->bounding_radius);
  }
}

TEST_CASE("a capsule whose axis goes through a sheet falls with it") {
  // Near an edge of the sheet's triangles, and far from all.
  for (const int count : {3, 1}) {
    INFO("squares along a side: " << count);
    test::Scene scene;
    body::Body sheet = test::make_shell(test::square_mesh(0.1, count));
    sheet.pose.translation.y() = 1.0;
    scene.add(sheet);
    scene.add(
        test::make_capsule(0.01, 0.05, count == 3 ? Vec3(0.0137, 1.02, 0.0071) : Vec3(0.045, 1.02, -0.02)));
    check_free_fall(scene);
  }
}

TEST_CASE("a capsule that lies in a bowl narrower than itself does not hang there") {
  test::Scene scene;
  body::Body bowl = test::make_shell(test::bowl_mesh(0.011, 4, 12));
  bowl.pose.translation += Vec3(0, 1.0, 0);
  scene.add(bowl);
  scene.add(test::make_capsule(0.012, 0.03, Vec3(0.0003, 1.0275, 0.0002)));
  constexpr int kSteps = 48;
  const Fall fall = watch_fall(scene, kSteps);
  CHECK(fall.named == 1);
  CHECK(fall.least > 0.7 * free_fall(scene, kSteps));
}

}  // namespace shatterbox
