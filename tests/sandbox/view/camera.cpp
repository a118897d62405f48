// Where the camera is: on its path, and without a place where all is seen.
#include "sandbox/view/camera.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "sandbox/view/camera_rig.h"
#include "tests/sandbox/scene/reading.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

struct Look {
  scene::SceneDescription scene;
  view::Subject subject;

  view::Viewpoint at(double time) const { return view::viewpoint_at(scene.camera, subject, time); }
};

Look look_at(const std::string& text) {
  const auto reading = scene::read(text);
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  scene::Problems problems;
  const auto plan = scene::plan_bodies(*reading.scene, problems);
  REQUIRE(plan.has_value());
  return {*reading.scene, view::find_subject(*reading.scene, *plan)};
}

// How far from the middle of a picture of 4 : 3 the points are, 1 at its rim: the most along width and
// height.
Eigen::Vector2d spread(const view::Viewpoint& eye, const std::vector<Vec3>& points, const Vec3& up) {
  const Vec3 ahead = (eye.target - eye.position).normalized(), right = ahead.cross(up).normalized();
  const double half = std::tan(eye.fov * core::kPi / 360.0);
  Eigen::Vector2d most(0.0, 0.0);
  for (const Vec3& p : points) {
    const Vec3 way = p - eye.position;
    const double scale = half * way.dot(ahead);
    REQUIRE(scale > 0.0);
    most = most.cwiseMax(Eigen::Vector2d(std::abs(way.dot(right)) / (scale * 4.0 / 3.0),
                                         std::abs(way.dot(right.cross(ahead))) / scale));
  }
  return most;
}

}  // namespace

TEST_CASE("the camera passes its keyframes and stands still before and after") {
  const auto reading = scene::read(
      "[[body]]\nkind = \"sphere\"\n[camera]\npath = [{at = 1, position = [0,0,5], target = [0,0,0], fov = "
      "30},"
      "{at = 2, position = [1,0,5]}, {at = 4, position = [2,0,5], fov = 50}]\n");
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  const auto at = [&reading](double time) { return view::viewpoint_at(reading.scene->camera, {}, time); };
  CHECK(at(0.0).position.x() == Approx(0.0));
  CHECK(at(1.0).fov == Approx(30.0));
  CHECK(at(2.0).position.x() == Approx(1.0));
  CHECK(at(4.0).position.x() == Approx(2.0));
  CHECK(at(9.0).fov == Approx(50.0));
  // Continuous, velocity included.
  const double before = (at(2.0).position.x() - at(1.999).position.x()) / 0.001;
  const double after = (at(2.001).position.x() - at(2.0).position.x()) / 0.001;
  CHECK(before == Approx(after).margin(0.01));
}

TEST_CASE("an eye without a place has all points in its picture, as large as they may be") {
  core::Random random(7);
  for (int trial = 0; trial < 200; ++trial) {
    view::Framing framing;
    framing.fov = random.uniform(5.0, 110.0);
    framing.up = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const double size = std::pow(10.0, random.uniform(-3, 4));
    const Vec3 shape(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    std::vector<Vec3> points;
    for (int i = 0; i < 12; ++i)
      points.emplace_back(size * Vec3(shape.x() * random.uniform(-1, 1),
                                      3.0 + shape.y() * random.uniform(-1, 1),
                                      shape.z() * random.uniform(-1, 1)));
    const Eigen::Vector2d free = spread(view::frame_points(points, framing), points, framing.up);
    CHECK(free.maxCoeff() <= 0.75 + 1e-9);
    if (framing.fov < 50.0) CHECK(free.maxCoeff() == Approx(0.75));
    framing.target = points[0];
    const view::Viewpoint aimed = view::frame_points(points, framing);
    CHECK(aimed.target == points[0]);
    CHECK(spread(aimed, points, framing.up).maxCoeff() <= 0.75 + 1e-9);
  }
}

TEST_CASE("an eye without a place leaves as much above as below, and as much on the left as on the right") {
  // A long row, of which the width asks for the distance; and one thing far behind another.
  const std::vector<std::vector<Vec3>> scenes{
      {{-1, 0, -0.05}, {-1, 0.1, 0.05}, {1, 0, 0.05}, {1, 0.1, -0.05}},
      {{-0.5, 0, 0}, {0.5, 0, 0}, {0, 0.4, 0}, {-0.2, 0, -6}, {-0.2, 1, -6}}};
  for (const std::vector<Vec3>& points : scenes) {
    const view::Viewpoint eye = view::frame_points(points, {});
    const Vec3 ahead = (eye.target - eye.position).normalized(),
               right = ahead.cross(Vec3::UnitY()).normalized(), up = right.cross(ahead);
    for (const Vec3& axis : {right, up}) {
      double least = 1e300, most = -1e300;
      for (const Vec3& p : points) {
        const Vec3 way = p - eye.position;
        least = std::min(least, way.dot(axis) / way.dot(ahead));
        most = std::max(most, way.dot(axis) / way.dot(ahead));
      }
      CHECK(least == Approx(-most).epsilon(1e-6));
    }
  }
}

TEST_CASE("an eye without a place looks at the wider side") {
  const auto away = [](const Vec3& size) {
    const view::Viewpoint eye = view::frame_points({-size, size, Vec3(size.x(), size.y(), -size.z())}, {});
    return Vec3(eye.position - eye.target);
  };
  const Vec3 before = away({2.0, 1.0, 0.1}), beside = away({0.1, 1.0, 2.0});
  CHECK(before.z() > 2.0 * before.x());
  CHECK(beside.x() > 2.0 * std::abs(beside.z()));
  CHECK(before.y() > 0.0);
  CHECK(beside.y() > 0.0);
}

TEST_CASE("what a camera without a place must see reaches down to where bodies will land") {
  const auto centre = [](const std::string& text) { return look_at(text).subject.centre.y(); };
  const std::string floor = "[[body]]\nname = \"floor\"\nkind = \"plane\"\nposition = [0, 0.5, 0]\n";
  const std::string ball =
      "[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.1\nposition = [0, 2, 0]\n";
  CHECK(centre(floor + ball) == Approx(0.5 * (2.1 + 0.5)));
  CHECK(centre(ball) == Approx(2.0));                    // nothing below
  const double far = 3.0 * std::sqrt(2.0 * 1.4 / 9.81);  // of one that leaves at 3 m/s
  const double middle = look_at(floor + ball + "velocity = [3, 0, 0]\n").subject.centre.x();
  CHECK(middle == Approx(0.5 * (far + 0.16 - 0.1)));
  CHECK(centre(floor + ball + "motion = \"static\"\n") == Approx(2.0));
  const std::string hook =
      "[[body]]\nname = \"hook\"\nkind = \"sphere\"\nradius = 0.1\nposition = [0, 2.2, 0]\n"
      "motion = \"static\"\n";
  const std::string joint = "[[joint]]\nkind = \"point\"\nbetween = [\"hook\", \"ball\"]\nat = [0, 2.1, 0]\n";
  CHECK(centre(floor + ball + hook + joint) == Approx(2.1));  // it hangs
}

TEST_CASE("a camera without a place leaves room for what stands to tip over") {
  const std::string floor = "[[body]]\nkind = \"plane\"\n";
  const auto stands = [&](const std::string& size, const std::string& height) {
    return look_at(floor + "[[body]]\nkind = \"box\"\nsize = " + size + "\nposition = [0, " + height +
                   ", 0]\n")
        .at(0.0);
  };
  // A domino that lies on its side, whichever way it fell.
  const std::vector<Vec3> fallen{Vec3(0.6, 0, 0), Vec3(-0.6, 0, 0), Vec3(0, 0, 0.6), Vec3(0, 0, -0.6)};
  CHECK(spread(stands("[0.4, 1, 0.1]", "0.5"), fallen, Vec3::UnitY()).maxCoeff() < 0.76);
  // What lies flat asks for none.
  const std::vector<Vec3> plate{Vec3(0.5, 0, 0.5), Vec3(-0.5, 0, 0.5), Vec3(-0.5, 0, -0.5)};
  CHECK(spread(stands("[1, 0.02, 1]", "0.01"), plate, Vec3::UnitY()).maxCoeff() > 0.7);
}

TEST_CASE("a camera without a place sees of great scenery what is about the things on it") {
  const std::string cup =
      "[[body]]\nname = \"cup\"\nkind = \"sphere\"\nradius = 0.05\nposition = [0, 0.85, 0]\n";
  const auto on_table = [&](const std::string& length) {
    return look_at(cup + "[[body]]\nname = \"table\"\nkind = \"box\"\nsize = [" + length +
                   ", 0.05, 0.1]\nposition = [0, 0.775, 0]\nmotion = \"static\"\n");
  };
  const auto width = [](const Look& look) {
    double most = 0.0;
    for (const Vec3& p : look.subject.corners) most = std::max(most, std::abs(p.x()));
    return most;
  };
  CHECK(width(on_table("0.16")) == Approx(0.08));
  CHECK(width(on_table("4")) == Approx(0.18));
  CHECK(width(look_at(cup + "motion = \"static\"\n")) == Approx(0.05));  // there is nothing else
  const Look hit = look_at(cup +
                           "[[body]]\nname = \"pole\"\nkind = \"box\"\nsize = [1, 1, 1]\nposition = [9, 1, "
                           "0]\nmotion = \"static\"\n");
  CHECK(width(hit) == Approx(0.05));
  CHECK(hit.subject.centre.y() == Approx(0.85));  // nothing is below it
  // What falls on it falls no further.
  const Look falls = look_at("[[body]]\nkind = \"plane\"\n" + cup +
                             "[[body]]\nname = \"table\"\nkind = \"box\"\nsize = [4, 0.05, 2]\n"
                             "position = [0, 0.675, 0]\nmotion = \"static\"\n");
  double lowest = 1.0;
  for (const Vec3& p : falls.subject.corners) lowest = std::min(lowest, p.y());
  CHECK(lowest == Approx(0.65));
}

TEST_CASE("a camera without a place sees where things are dropped, though nothing is there yet") {
  const Look look = look_at(
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"egg\"\nkind = \"sphere\"\nradius = 0.1\n"
      "[[event]]\nat = 1\ndo = \"drop\"\nbody = \"egg\"\nposition = [5, 2, 0]\n");
  CHECK(look.subject.centre.x() == Approx(5.0));
  CHECK(look.subject.centre.y() == Approx(1.05));
  CHECK(!look.subject.fall);
  // Upon something else it comes from above the picture.
  const std::string table =
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"table\"\nkind = \"box\"\nsize = [1, 0.1, 1]\n"
      "position = [0, 0.05, 0]\n";
  const std::string egg =
      "[[body]]\nname = \"egg\"\nkind = \"sphere\"\nradius = 0.1\n"
      "[[event]]\nat = 1\ndo = \"drop\"\nbody = \"egg\"\nposition = [0, 9, 0]\n";
  const auto distance = [](const Look& one) { return (one.at(0.0).position - one.at(0.0).target).norm(); };
  CHECK(distance(look_at(table + egg)) < 1.8 * distance(look_at(table)));
}

TEST_CASE("a camera without a place goes down with what falls, and stands where more happens") {
  const std::string ball =
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.1\n"
      "position = [0, 2, 0]\n";
  const std::string thrown =
      "[[event]]\nat = 0.2\ndo = \"projectile\"\nfrom = [1, 2, 1]\nat_body = \"ball\"\nspeed = 9\n";
  for (const std::string& text : {ball, ball + thrown}) {
    const Look look = look_at(text);
    REQUIRE(look.subject.fall);
    CHECK(look.subject.fall->way == Approx(1.9));
    for (const double time : {0.0, 0.2, 0.4, 0.6, 0.8}) {
      const double height = std::max(2.0 - 0.5 * 9.81 * time * time, 0.1);
      CHECK(spread(look.at(time), {Vec3(0.0, height + 0.1, 0.0), Vec3(0.0, height - 0.1, 0.0)}, Vec3::UnitY())
                .maxCoeff() < 0.9);
    }
    CHECK((look.at(0.8).position - look.at(0.8).target).norm() < 1.5);
  }
  for (const std::string more :
       {"velocity = [3, 0, 0]\n", "motion = \"static\"\n",
        "[[body]]\nname = \"egg\"\nkind = \"sphere\"\nradius = 0.1\n[[event]]\nat = 1\ndo = \"drop\"\nbody = "
        "\"egg\"\nposition = [0, 1, 0]\n"}) {
    const Look look = look_at(ball + more);
    CHECK(look.at(0.0).target == look.at(1.0).target);
    CHECK(look.at(0.0).position == look.at(1.0).position);
  }
}

TEST_CASE("a camera without a place sees where something thrown meets its aim, and not where it would land") {
  const std::string target =
      "[[body]]\nkind = \"plane\"\n[[body]]\nkind = \"box\"\nsize = [0.2, 0.4, 0.2]\nposition = [0,0.2,0]\n";
  const std::string ball = "[[body]]\nkind = \"sphere\"\nradius = 0.05\n";
  const Look alone = look_at(target);
  const auto distance = [](const Look& look) { return (look.at(0.0).position - look.at(0.0).target).norm(); };
  for (const char* start : {"position = [-6, 0.5, 0]\nvelocity = [12, 1.5, 0]\n",
                            "position = [0, 0.5, 40]\nvelocity = [0, 2, -80]\n"}) {
    INFO(start);
    const Look look = look_at(target + ball + start);
    CHECK(distance(look) < 3.0 * distance(alone));
    CHECK(spread(look.at(0.0), alone.subject.corners, Vec3::UnitY()).maxCoeff() < 0.76);
    // It comes from there: with room on that side.
    const Vec3 shift = look.at(0.0).target - alone.at(0.0).target;
    CHECK(std::abs(shift.x()) + std::abs(shift.z()) > 0.02);
  }
  // What breaks there falls there.
  const Look wall = look_at(
      "[[body]]\nkind = \"plane\"\n[[body]]\nkind = \"box\"\nsize = [3, 6, 0.2]\nposition = [0, 3, -0.1]\n"
      "motion = \"static\"\n[[body]]\nkind = \"sphere\"\nradius = 0.1\nposition = [0, 2, 2]\n"
      "velocity = [0, 0, -20]\n");
  CHECK(spread(wall.at(0.0), {Vec3(0.2, 0, 0.1), Vec3(-0.2, 0, 0.3)}, Vec3::UnitY()).maxCoeff() < 0.76);
  // Past its aim it lands: all of its way is in the picture.
  const Look missed = look_at(target + ball + "position = [-6, 0.5, 3]\nvelocity = [12, 1.5, 0]\n");
  CHECK(spread(missed.at(0.0), {Vec3(-6, 0.5, 3), Vec3(-0.5, 0.0, 3)}, Vec3::UnitY()).maxCoeff() < 0.76);
}

TEST_CASE(
    "a camera without a place sees all of a turn about an axle, and of a path what is gone in the scene") {
  const Look wheel = look_at(
      "[[body]]\nkind = \"box\"\nsize = [1.2, 0.1, 0.05]\nposition = [0,1,0]\nangular_velocity = [0,0,6]\n"
      "fixed = [\"x\",\"y\",\"z\",\"rx\",\"ry\"]\n");
  const std::vector<Vec3> tips{Vec3(-0.6, 1, 0), Vec3(0.6, 1, 0), Vec3(0, 0.4, 0), Vec3(0, 1.6, 0)};
  CHECK(spread(wheel.at(0.0), tips, Vec3::UnitY()).maxCoeff() < 0.76);
  CHECK(spread(wheel.at(0.0), tips, Vec3::UnitY()).maxCoeff() > 0.6);
  // A hammer on a pivot, a quarter of a turn in the second that the scene lasts.
  const std::string hammer =
      "[[body]]\nkind = \"box\"\nsize = [0.1, 0.1, 0.1]\nposition = [1,0,0]\nmotion = \"scripted\"\n"
      "pivot = [-1,0,0]\nkeyframes = [{at = 0, position = [0,0,0]}, {at = 1, rotation = [0,0,90]}, "
      "{at = 2, rotation = [0,0,180]}]\n";
  const auto highest = [](const Look& look, int axis, double sign) {
    double most = -1e300;
    for (const Vec3& p : look.subject.corners) most = std::max(most, sign * p[axis]);
    return most;
  };
  const Look one = look_at("[scene]\nseconds = 1\n" + hammer),
             two = look_at("[scene]\nseconds = 2\n" + hammer);
  CHECK(highest(one, 1, 1.0) == Approx(1.05).epsilon(0.01));
  CHECK(highest(one, 0, -1.0) == Approx(0.05).epsilon(0.01));
  CHECK(highest(two, 0, -1.0) == Approx(1.05).epsilon(0.01));
}

TEST_CASE("a camera without a place sees where hands carry something") {
  const std::string box =
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"b\"\nkind = \"box\"\nsize = 0.2\nposition = "
      "[0,0.1,0]\n";
  const Look look = look_at(box +
                            "[[event]]\nat = 0\ndo = \"grab\"\nbody = \"b\"\npoint = [0,0.2,0]\n"
                            "[[event]]\nat = 0.1\ndo = \"move\"\nbody = \"b\"\nto = [0.5,1.5,0]\n");
  CHECK(
      spread(look.at(0.0), {Vec3(0.6, 1.5, 0), Vec3(0.4, 1.3, 0), Vec3(0, 0, 0)}, Vec3::UnitY()).maxCoeff() <
      0.76);
  CHECK(spread(look_at(box).at(0.0), {Vec3(0.4, 0.4, 0)}, Vec3::UnitY()).maxCoeff() > 1.0);
}

TEST_CASE(
    "pictures narrower than 4 : 3 see all that a camera without a place has, and no other camera changes") {
  const std::string row =
      "[[body]]\nkind = \"box\"\nsize = 0.2\nposition = [-1,0.1,0]\n[[body]]\nkind = \"box\"\nsize = "
      "0.2\nposition = [1,0.1,0]\n";
  const auto camera_of = [](const std::string& text) {
    const Look look = look_at(text);
    view::CameraRig rig(look.scene.camera, look.subject);
    const view::Moment moment{0.0, 0.0, 1.0, {}};
    return rig.at(moment, [](scene::BodyRef) { return std::optional<Vec3>(); });
  };
  const render::Camera chosen = camera_of(row), placed = camera_of(row + "[camera]\nposition = [0,1,5]\n");
  const float usual = placed.slope(16.0F / 9.0F);
  CHECK(chosen.slope(16.0F / 9.0F) == Approx(usual));
  CHECK(chosen.slope(4.0F / 3.0F) == Approx(usual));
  CHECK(chosen.slope(9.0F / 16.0F) * 9.0F / 16.0F == Approx(usual * 4.0F / 3.0F));
  CHECK(placed.slope(9.0F / 16.0F) == Approx(usual));
}
