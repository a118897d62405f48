// Paths of scripted bodies: through their keys, never beyond them, and smooth or straight between.
#include "engine/body/scripted_path.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/elementary.h"

namespace shatterbox {
namespace {

using body::Between;
using body::Keyframe;
using body::ScriptedPath;

const std::vector<Keyframe> kThere{{0.5, Vec3(0, 1, 0), Vec3::Zero()},
                                   {1.0, Vec3(0, 0.2, 0), Vec3::Zero()},
                                   {1.5, Vec3(0, 0, 0), Vec3::Zero()},
                                   {2.5, Vec3(0, 0, 0), Vec3::Zero()},
                                   {3.0, Vec3(3, 1, 0), Vec3(0, 4.0 * core::kPi, 0)}};

}  // namespace

TEST_CASE("a path leads through its keys, rests before the first and after the last") {
  for (const Between between : {Between::smooth, Between::straight}) {
    const ScriptedPath path(kThere, between);
    for (const Keyframe& key : kThere)
      CHECK((path.pose_at(key.time).translation - key.position).norm() < 1e-14);
    CHECK(path.pose_at(0.0).translation == kThere.front().position);
    CHECK(path.pose_at(9.0).translation == kThere.back().position);
    CHECK(path.rests(0.0, 0.5));
    CHECK(path.rests(1.5, 2.5));
    CHECK(path.rests(3.0, 9.0));
    CHECK_FALSE(path.rests(0.4, 0.6));
    CHECK_FALSE(path.rests(1.0, 1.2));
  }
}

TEST_CASE("between two keys a path is at rest at both, or goes at one speed") {
  const std::vector<Keyframe> keys{{1.0, Vec3(1, 0, 0), Vec3::Zero()}, {3.0, Vec3(1, 0, -4), Vec3::Zero()}};
  const ScriptedPath smooth(keys), straight(keys, Between::straight);
  for (const double s : {0.0, 0.1, 0.25, 0.5, 0.9, 1.0}) {
    CHECK(smooth.pose_at(1.0 + 2.0 * s).translation.z() ==
          Approx(-4.0 * s * s * (3.0 - 2.0 * s)).margin(1e-14));
    CHECK(straight.pose_at(1.0 + 2.0 * s).translation.z() == Approx(-4.0 * s).margin(1e-14));
  }
  CHECK(smooth.top_speed() == Approx(3.0));  // 1.5 times the mean
  CHECK(straight.top_speed() == Approx(2.0));
}

TEST_CASE("a smooth path never leaves its keys, and has no jump in speed") {
  const ScriptedPath path(kThere);
  double before = 0.0, speed_before = 0.0;
  const double dt = 1e-3;
  for (double t = 0.5; t < 3.2; t += dt) {
    const Vec3 x = path.pose_at(t).translation, next = path.pose_at(t + dt).translation;
    CHECK(x.y() >= -1e-15);
    CHECK(x.y() <= 1.0);
    if (t < 2.4) CHECK(x.y() <= (t == 0.5 ? 1.0 : before) + 1e-14);
    before = x.y();
    const double speed = (next - x).norm() / dt;
    CHECK(speed <= path.top_speed() * (1.0 + 1e-9));
    CHECK(std::abs(speed - speed_before) < 0.15);  // 75 m/s2 are the most here
    speed_before = speed;
  }
}

TEST_CASE("angles are numbers: two turns are two turns, about the pivot") {
  const std::vector<Keyframe> keys{{0.0, Vec3(0, 2, 0), Vec3::Zero()},
                                   {4.0, Vec3(0, 2, 0), Vec3(0, 0, 4.0 * core::kPi)}};
  const Vec3 arm(0.5, 0.0, 0.0);
  const ScriptedPath path(keys, Between::straight, Quat::Identity(), arm);
  for (const double t : {0.0, 0.3, 1.0, 1.7, 2.5, 4.0}) {
    const double angle = core::kPi * t;
    const Vec3 expected(0.5 * std::cos(angle), 2.0 + 0.5 * std::sin(angle), 0.0);
    CHECK((path.pose_at(t).translation - expected).norm() < 1e-13);
  }
  CHECK(path.top_spin() == Approx(core::kPi));
  CHECK(path.top_speed() == Approx(0.5 * core::kPi));
}

}  // namespace shatterbox
