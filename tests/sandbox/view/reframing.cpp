// A camera without a place goes after what leaves its picture, and no other does.
#include "sandbox/view/reframing.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/core/elementary.h"
#include "sandbox/view/camera_rig.h"
#include "tests/sandbox/script/building.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

/// A scene whose steps a camera watches.
struct Set {
  scene::Reading reading;
  std::optional<scene::BuiltScene> built;
  std::optional<view::Subject> subject;
  std::optional<view::Reframing> reframing;
  std::optional<view::CameraRig> rig;

  explicit Set(const std::string& text) : reading(scene::read(text)), built(build(reading)) {
    subject = view::find_subject(*reading.scene, built->plan);
    reframing.emplace(*reading.scene, *built, *subject);
    rig.emplace(reading.scene->camera, *subject);
  }

  view::Viewpoint eye() {
    const double time = built->world.time();
    const view::Moment moment{time, time, 1.0, built->world.bodies(), reframing->shift()};
    return rig->view_at(moment, [](scene::BodyRef) { return std::optional<Vec3>(); });
  }
  double distance() {
    const view::Viewpoint now = eye();
    return (now.position - now.target).norm();
  }
  const body::Body& body(const std::string& name) const {
    for (const body::Body& body : built->world.bodies())
      if (body.name == name) return body;
    FAIL("no body " + name);
    return built->world.bodies().front();
  }
  /// How far from the middle of a picture of 4 : 3 a ball's rim is, 1 at the picture's.
  double spread(const std::string& name) {
    const view::Viewpoint now = eye();
    const Vec3 ahead = (now.target - now.position).normalized();
    const Vec3 right = ahead.cross(Vec3::UnitY()).normalized(), up = right.cross(ahead);
    const Vec3 way = body(name).pose.translation - now.position;
    const double half = std::tan(now.fov * core::kPi / 360.0) * way.dot(ahead),
                 radius = body(name).shape->radius;
    return std::max((std::abs(way.dot(right)) + radius) / (half * 4.0 / 3.0),
                    (std::abs(way.dot(up)) + radius) / half);
  }
  void go_on(
      double seconds, const std::function<void()>& after_each = [] {}) {
    const double until = built->world.time() + seconds;
    while (built->world.time() < until - 1e-9) {
      REQUIRE(built->world.step());
      reframing->look();
      after_each();
    }
  }
};

const std::string kHung =
    "[[body]]\nkind = \"plane\"\n"
    "[[body]]\nname = \"hook\"\nkind = \"box\"\nsize = 0.1\nposition = [0, 2, 0]\nmotion = \"static\"\n"
    "[[body]]\nname = \"lamp\"\nkind = \"sphere\"\nradius = 0.06\nposition = [0, 1.6, 0]\n"
    "[[joint]]\nkind = \"point\"\nbetween = [\"hook\", \"lamp\"]\nat = [0, 1.95, 0]\n";

const std::string kTable =
    "[[body]]\nkind = \"plane\"\n"
    "[[body]]\nname = \"table\"\nkind = \"box\"\nsize = [0.6, 0.05, 0.6]\nposition = [0, 0.775, 0]\n"
    "motion = \"static\"\n"
    "[[body]]\nname = \"cup\"\nkind = \"sphere\"\nradius = 0.05\nposition = [0.2, 0.85, 0]\n";

void push(Set& set, const std::string& name, const Vec3& velocity) {
  const body::Body& body = set.body(name);
  set.built->world.push_body(body.id, velocity / body.inverse_mass, body.pose.translation);
}

}  // namespace

TEST_CASE("the camera that sees a lamp hang goes down with it when its hook is gone, and comes close") {
  Set set(kHung);
  const double before = set.distance();
  const view::Viewpoint hanging = set.eye();
  set.go_on(0.5);
  CHECK(set.eye().position == hanging.position);
  set.built->world.remove_body(set.body("hook").id);
  double furthest = 0.0;
  Vec3 last = set.eye().position;
  set.go_on(2.5, [&] {
    CHECK(set.spread("lamp") < 1.0);
    // As an operator would: no jerk.
    CHECK((set.eye().position - last).norm() < 0.15 * before);
    last = set.eye().position;
    furthest = std::max(furthest, set.distance());
  });
  CHECK(furthest > 1.5 * before);
  CHECK(set.distance() < 1.3 * before);
  CHECK(set.body("lamp").pose.translation.y() < 0.07);
}

TEST_CASE(
    "the camera follows a cup off its table, and does not heed one that stays or one that is shot away") {
  Set falls(kTable), stays(kTable), is_shot(kTable);
  const view::Viewpoint usual = falls.eye();
  push(falls, "cup", Vec3(1.0, 0.0, 0.0));
  falls.go_on(1.0, [&] { CHECK(falls.spread("cup") < 1.0); });
  CHECK(falls.body("cup").pose.translation.y() < 0.06);
  push(stays, "cup", Vec3(0.2, 0.0, 0.0));
  stays.go_on(0.4, [&] { CHECK(stays.eye().position == usual.position); });
  push(is_shot, "cup", Vec3(40.0, 10.0, 0.0));
  is_shot.go_on(1.0, [&] { CHECK(is_shot.distance() < 3.0 * (usual.position - usual.target).norm()); });
}

TEST_CASE("the camera that goes down with what falls goes no other way for that") {
  Set set(
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.06\n"
      "position = [0, 3, 0]\n");
  REQUIRE(set.subject->fall);
  set.go_on(0.7, [&] {
    CHECK(set.spread("ball") < 1.0);
    CHECK(set.reframing->shift().position == Vec3::Zero());
  });
  set.go_on(0.8, [&] { CHECK(set.spread("ball") < 1.0); });  // it bounces
}

TEST_CASE("a camera with a place or a target of its own stays as it is whatever leaves its picture") {
  for (const std::string own : {"position = [0, 1.5, 3]\n", "target = [0, 1.7, 0]\n", "follow = \"hook\"\n",
                                "path = [{at = 0, position = [0, 1, 4], target = [0, 1.7, 0]}]\n"}) {
    INFO(own);
    Set set(kHung + "[camera]\n" + own);
    set.built->world.remove_body(set.body("hook").id);
    set.go_on(1.0);
    CHECK(set.body("lamp").pose.translation.y() < 0.5);
    CHECK(set.reframing->shift().position == Vec3::Zero());
    CHECK(set.reframing->shift().target == Vec3::Zero());
  }
}

TEST_CASE("of what breaks the camera goes after great pieces, and after nothing that cannot break") {
  // A shot leaves the picture, and the pane that it goes through stays in it.
  Set set(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"pane\"\nkind = \"shell\"\nshape = \"pane\"\nwidth = "
      "0.4\nheight = 0.4\nthickness = 0.003\nedge_length = 0.05\nmaterial = \"glass\"\n"
      "[[body]]\nname = \"shot\"\nkind = \"sphere\"\nradius = 0.02\nmaterial = \"steel\"\nposition = [0.1, "
      "0.1, "
      "0.3]\nvelocity = [0, 0, -3]\n");
  const view::Viewpoint usual = set.eye();
  push(set, "shot", Vec3(8.0, 0.0, 3.0));
  set.go_on(1.0);
  CHECK(set.eye().position == usual.position);
  push(set, "pane", Vec3(0.4, 0.0, 0.0));
  set.go_on(0.9);
  CHECK(set.eye().target.x() > usual.target.x() + 0.05);
}
