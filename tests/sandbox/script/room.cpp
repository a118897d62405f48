// What is in the way of a body that comes in: every pair of forms, just apart and just in.
#include "sandbox/script/room.h"

#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::script;

namespace {

world::BodyDescription make(const char* kind, const Vec3& position) {
  world::BodyDescription description;
  description.name = kind;
  description.pose.translation = position;
  const std::string word = kind;
  if (word == "plane") description.form = world::PlaneDescription{};
  if (word == "box") description.form = world::BoxDescription{Vec3::Constant(0.5)};
  if (word == "sphere") description.form = world::SphereDescription{0.5};
  if (word == "shell") {
    world::ShellDescription shell;
    shell.mesh = geometry::make_pane(1.0, 1.0, {0.2, 0.0, 1}).value();  // upright, in the plane z = 0
    shell.is_breakable = false;
    description.form = shell;
  }
  if (word == "solid" || word == "crumb") {
    world::SolidDescription solid;
    solid.mesh = geometry::make_box_surface(Vec3::Constant(word == "solid" ? 0.5 : 0.1));
    solid.is_breakable = false;
    description.form = solid;
  }
  if (word == "capsule") description.form = world::CapsuleDescription{0.25, 1.0};
  if (word == "marble") description.form = world::SphereDescription{0.1};
  return description;
}

}  // namespace

TEST_CASE("bodies just apart leave room, bodies just in each other do not") {
  struct Case {
    const char *old, *fresh;
    Vec3 apart, inside;
  };
  const Case cases[] = {
      {"plane", "box", {0, 0.51, 0}, {0, 0.49, 0}},     {"plane", "sphere", {0, 0.51, 0}, {0, 0.49, 0}},
      {"plane", "shell", {0, 0.51, 0}, {0, 0.49, 0}},   {"box", "box", {1.01, 0.1, 0.1}, {0.99, 0.1, 0.1}},
      {"box", "sphere", {1.01, 0.1, 0}, {0.99, 0, 0}},  {"box", "shell", {0, 0, 0.51}, {0, 0, 0.4}},
      {"sphere", "box", {0, 1.01, 0}, {0, 0.99, 0}},    {"sphere", "sphere", {0, 0, 1.01}, {0, 0, 0.99}},
      {"sphere", "shell", {0, 0, 0.51}, {0, 0, 0.49}},  {"shell", "sphere", {0, 0, 0.51}, {0, 0, -0.49}},
      {"shell", "box", {0.1, 0, 0.51}, {0.1, 0, 0.49}}, {"box", "box", {3, 0, 0}, {0, 0, 0}},
      {"plane", "solid", {0, 0.51, 0}, {0, 0.49, 0}},   {"solid", "box", {1.01, 0.1, 0}, {0.99, 0.1, 0}},
      {"solid", "sphere", {0, 1.01, 0}, {0, 0.99, 0}},  {"solid", "shell", {0, 0, 0.51}, {0.1, 0, 0.2}},
      {"solid", "marble", {0.61, 0, 0}, {0.1, 0.2, 0}}, {"solid", "crumb", {0.61, 0, 0}, {0.1, 0.2, 0}},
      {"crumb", "solid", {0.61, 0, 0}, {0.1, 0.2, 0}},  {"plane", "capsule", {0, 0.51, 0}, {0, 0.49, 0}},
      {"box", "capsule", {0.76, 0.1, 0}, {0.74, 0, 0}}, {"capsule", "sphere", {0, 1.01, 0}, {0, 0.99, 0}},
      {"capsule", "marble", {0.36, 0, 0}, {0, 0.2, 0}}, {"capsule", "capsule", {0.51, 0, 0}, {0.49, 0, 0}},
  };
  for (const Case& c : cases) {
    INFO(c.fresh << " into " << c.old);
    world::World world{world::WorldSettings{}};
    REQUIRE(world.add_material(material::Material{}).ok());
    REQUIRE(world.add_body(make(c.old, Vec3::Zero())).ok());
    CHECK(find_obstacle(world, make(c.fresh, c.apart)).empty());
    CHECK(find_obstacle(world, make(c.fresh, c.inside)) == c.old);
  }
}

TEST_CASE("shells that cross are in each other's way, unless they are of one group") {
  world::World world{world::WorldSettings{}};
  REQUIRE(world.add_material(material::Material{}).ok());
  world::BodyDescription old = make("shell", Vec3::Zero());
  old.group = 3;
  REQUIRE(world.add_body(old).ok());
  world::BodyDescription fresh = make("shell", Vec3(0.07, 0.03, 0.1));
  CHECK(find_obstacle(world, fresh).empty());
  fresh.pose.rotation = Quat(0.8, 0.0, 0.6, 0.0);  // turned through the old one
  CHECK(find_obstacle(world, fresh) == "shell");
  fresh.group = 3;
  CHECK(find_obstacle(world, fresh).empty());
}
