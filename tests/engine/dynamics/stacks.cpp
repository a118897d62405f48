// What lies on something carries it: the impulses at every level of a stack sum to the weight above, nothing
// trembles away, and gaps are those that are kept.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "engine/dynamics/motion_work.h"
#include "tests/engine/dynamics/piles.h"
#include "tests/support/sanitized.h"

namespace shatterbox {
namespace {

constexpr int kRate = 240;

void lift(geometry::TriangleMesh& mesh, double height) {
  for (Vec3& p : mesh.positions) p.y() += height;
}

struct Stack {
  const char* name;
  int count;
  std::function<body::Body(int)> make;  // the k-th from below
};

Stack boxes(int count) {
  return {"boxes", count,
          [](int k) { return test::make_box(Vec3::Constant(0.1), Vec3(0, 0.1 + 2e-4 + 0.2002 * k, 0)); }};
}

Stack plates(int count) {
  return {"plates", count, [](int k) {
            auto mesh = test::square_mesh(0.1, 3);
            lift(mesh, 1.5e-4 * (k + 1));
            return test::make_shell(mesh);
          }};
}

// Turned by 45 degrees in turn: corners over edges.
Stack crossed_plates(int count) {
  return {"crossed plates", count, [](int k) {
            auto body = test::make_shell(test::square_mesh(0.1, 2));
            body.pose.rotation = Quat(core::cos(k * core::kPi / 8), 0, core::sin(k * core::kPi / 8), 0);
            body.pose.translation.y() = 1.5e-4 * (k + 1);
            return body;
          }};
}

test::Scene stack_scene(const Stack& stack) {
  test::Scene scene;
  scene.settings.has_sleep = false;
  scene.add(test::make_plane());
  for (int k = 0; k < stack.count; ++k) scene.add(stack.make(k));
  return scene;
}

/// Gaps of pairs that push each other, as shares of their size: the least and the greatest.
std::pair<double, double> loaded_gaps(const test::Scene& scene) {
  auto state = scene.state;
  dynamics::MotionWork work;
  dynamics::find_candidate_pairs(scene.bodies, scene.settings, state, work);
  double least = 1e300, greatest = 0.0;
  for (const auto& pair : work.pairs) {
    const auto a = scene.bodies[static_cast<std::size_t>(pair.a)].id,
               b = scene.bodies[static_cast<std::size_t>(pair.b)].id;
    const bool is_loaded = std::any_of(scene.log.begin(), scene.log.end(), [&](const auto& entry) {
      return std::minmax(entry.body_a, entry.body_b) == std::minmax(a, b);
    });
    if (!is_loaded) continue;
    least = std::min(least, pair.least_gap / pair.size);
    greatest = std::max(greatest, pair.least_gap / pair.size);
  }
  return {least, greatest};
}

// Impulses along y from each body on those above it, N s.
void add_carried(const test::Scene& scene, std::vector<double>& carried) {
  for (const auto& entry : scene.log) {
    const auto [low, high] = std::minmax(entry.body_a, entry.body_b);
    const double up = high == entry.body_a ? entry.impulse_world.y() : -entry.impulse_world.y();
    for (auto k = low; k < high; ++k) carried[k - 1] += up;
  }
}

struct Rest {
  double weight_error = 0.0;  // relative, worst of all levels
  double moved = 0.0;         // m, farthest from where it was when the second began
  double least_gap = 0.0, greatest_gap = 0.0;
  int cut = 0;
};

Rest watch(test::Scene& scene, int seconds) {
  Rest rest;
  std::vector<double> carried(scene.bodies.size() - 1, 0.0);
  std::vector<Vec3> places;
  for (const auto& b : scene.bodies) places.push_back(b.pose.translation);
  for (int i = 0; i < kRate * seconds; ++i) {
    scene.step();
    rest.cut += scene.report.failsafe_steps;
    add_carried(scene, carried);
    for (std::size_t k = 0; k < places.size(); ++k)
      rest.moved = std::max(rest.moved, (scene.bodies[k].pose.translation - places[k]).norm());
  }
  double above = 0.0;
  for (std::size_t k = carried.size(); k-- > 0;) {
    above += scene.bodies[k + 1].shape->mass * 9.81 * seconds;
    rest.weight_error = std::max(rest.weight_error, std::abs(carried[k] / above - 1.0));
  }
  std::tie(rest.least_gap, rest.greatest_gap) = loaded_gaps(scene);
  return rest;
}

}  // namespace

TEST_CASE("every level of a stack carries what is above it, at the gap that is kept") {
  const int count = static_cast<int>(test::how_many(10, 4));
  for (const Stack& stack : {boxes(count), plates(count / 2), crossed_plates(count / 2)}) {
    auto scene = stack_scene(stack);
    for (int i = 0; i < kRate; ++i) scene.step();
    const Rest rest = watch(scene, 1);
    const double size = 2.0 * scene.bodies[1].shape->bounding_radius;
    WARN(stack.name << ": weight error " << rest.weight_error << ", moved in a second " << rest.moved / size
                    << " of the size, gaps " << rest.least_gap << " to " << rest.greatest_gap << ", cut "
                    << rest.cut);
    CHECK(rest.weight_error < 1e-3);
    CHECK(rest.moved < 4e-4 * size);
    CHECK(rest.least_gap > 1e-4);
    CHECK(rest.greatest_gap < 1e-3);
    CHECK(rest.cut == 0);
  }
}

TEST_CASE("ten boxes stand for 60 s whether the highest weighs as much or a thousand times as much",
          "[.][long]") {
  for (const double ratio : {1.0, 10.0, 100.0, 1000.0}) {
    auto scene = stack_scene(boxes(10));
    body::Body& top = scene.bodies.back();
    top = test::make_box(top.shape->half_extent, top.pose.translation, true, 1000.0 * ratio);
    top.id = static_cast<body::BodyId>(scene.bodies.size());
    for (int i = 0; i < 2 * kRate; ++i) scene.step();
    const Rest rest = watch(scene, 60);
    WARN("ten boxes, the highest " << ratio << " times as heavy: weight error " << rest.weight_error
                                   << ", moved in a minute " << rest.moved << " m, gaps " << rest.least_gap
                                   << " to " << rest.greatest_gap << ", cut " << rest.cut);
    CHECK(rest.weight_error < 1e-3);
    CHECK(rest.moved < (ratio > 10.0 ? 2.4e-3 : 2e-4));  // three times what it is
    CHECK(rest.greatest_gap < 1e-3);
    CHECK(rest.cut == 0);
    CHECK(scene.bodies.back().pose.translation.y() == Approx(1.9).margin(4e-3));
  }
}

}  // namespace shatterbox
