// What good scenes mean: defaults, numbers, poses, events, and --set and --script on top.
#include "sandbox/scene/read_scene.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "sandbox/scene/nearest_name.h"
#include "sandbox/scene/overrides.h"
#include "tests/sandbox/scene/reading.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::scene;

namespace {

const char* const kScene = R"(# a ball and a pane
[scene]
seconds = 2
seed = 7
[[material]]
name = "thin glass"
like = "glass"
strength = 3e7
[[body]]
name = "floor"
kind = "plane"
[[body]]
name = "ball"
kind = "sphere"
radius = 0.05
position = [0, 1, 0]
velocity = [0, 0, 3]
[[body]]
name = "window"
kind = "shell"
shape = "pane"
width = 2
material = "thin glass"
support = "edge"
rotation = [0, 90, 0]
[[event]]
name = "late"
at = 1.5
do = "drop"
body = {kind = "box", size = 0.1}
position = [0, 2, 0]
[[event]]
at = 0.5
do = "projectile"
from = [1, 1, 1]
at_body = "window"
speed = 10
)";

}  // namespace

TEST_CASE("a good scene is read as it stands") {
  const Reading reading = read(kScene);
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  const SceneDescription& scene = *reading.scene;
  CHECK(scene.goal == "a ball and a pane");
  CHECK(scene.name == "t");
  CHECK(scene.seconds == 2.0);
  CHECK(scene.world.seed == 7);
  CHECK(scene.world.steps_per_second == 240);
  CHECK(scene.world.has_energy_guard);
  CHECK(scene.world.gravity == Vec3(0, -9.81, 0));
  REQUIRE(scene.bodies.size() == 5);  // two are brought in by events
  const BodyEntry& ball = scene.bodies[1];
  CHECK(std::get<SphereForm>(ball.form).radius == 0.05);
  CHECK(ball.motion == body::Motion::dynamic);
  CHECK(ball.velocity == Vec3(0, 0, 3));
  CHECK_FALSE(ball.is_held_back);
  const BodyEntry& window = scene.bodies[2];
  CHECK(window.motion == body::Motion::fixed);
  CHECK(scene.materials[static_cast<std::size_t>(window.material)].material.strength == 3e7);
  CHECK(scene.materials[static_cast<std::size_t>(window.material)].preset == "glass");
  CHECK((window.rotation * Vec3::UnitX() - Vec3(0, 0, -1)).norm() < 1e-15);
  REQUIRE(scene.events.size() == 2);
  CHECK(scene.events[0].at == 0.5);  // by time
  CHECK(std::get<BodyRef>(std::get<Projectile>(scene.events[0].action).target) == BodyRef{2, -1});
  CHECK(scene.events[1].name == "late");
  CHECK(scene.bodies[static_cast<std::size_t>(scene.events[0].who.body)].is_held_back);
  CHECK(scene.warnings.empty());
}

TEST_CASE("turns are applied about x, then y, then z") {
  const Reading reading = read("[[body]]\nkind = \"sphere\"\nrotation = [90, 90, 0]\n");
  REQUIRE(reading.scene.has_value());
  // y -> z (about x) -> x (about y)
  CHECK((reading.scene->bodies[0].rotation * Vec3::UnitY() - Vec3::UnitX()).norm() < 1e-15);
}

TEST_CASE("an event after the end is a warning") {
  const Reading reading = read(kScene, {"scene.seconds=1"});
  REQUIRE(reading.scene.has_value());
  REQUIRE(reading.scene->warnings.size() == 1);
  CHECK(reading.scene->warnings[0].find("\"late\"") != std::string::npos);
}

TEST_CASE("the option --set changes named bodies, materials, events and tables") {
  const Reading reading = read(kScene, {"ball.radius=0.1", "thin glass.strength=1e7", "late.at=1",
                                        "scene.gravity=[0,0,0]", "scene.energy_guard=false",
                                        "camera.fov = 50", "ball.repeat.count=3", "ball.material=\"glass\""});
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  const SceneDescription& scene = *reading.scene;
  CHECK(scene.materials[0].material.strength == 1e7);
  CHECK(std::get<SphereForm>(scene.bodies[1].form).radius == 0.1);
  CHECK(scene.bodies[1].repeat.total() == 3);
  CHECK(scene.events[1].at == 1.0);
  CHECK(scene.world.gravity == Vec3(0, 0, 0));
  CHECK_FALSE(scene.world.has_energy_guard);
  CHECK(scene.camera.fov == 50.0);
}

TEST_CASE("the option --set puts a shape in place of a mesh and a mesh in place of a shape") {
  const std::string figure = "[[body]]\nname = \"figure\"\nkind = \"solid\"\nshape = \"figure\"\n";
  const Reading sphere = read(figure, {"figure.shape=\"sphere\"", "figure.radius=0.2"});
  INFO(sphere.text);
  REQUIRE(sphere.scene.has_value());
  CHECK(std::holds_alternative<SphereShape>(find_mesh_form(sphere.scene->bodies[0].form)->shape));
  const Reading mesh = read(figure, {"figure.mesh=\"none.obj\""});
  REQUIRE(mesh.problems.size() == 1);  // and not that it has both
  CHECK(mesh.text.find("there is no mesh file") != std::string::npos);
}

TEST_CASE("numbers of the option --set may begin with their point") {
  const Reading reading = read(kScene, {"ball.position=[0, .5,-.25]", "ball.radius=.125"});
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  const auto& ball = *std::find_if(reading.scene->bodies.begin(), reading.scene->bodies.end(),
                                   [](const auto& body) { return body.name == "ball"; });
  CHECK(ball.position == Vec3(0.0, 0.5, -0.25));
  CHECK(std::get<SphereForm>(ball.form).radius == 0.125);
}

TEST_CASE("the option --set is checked with the scene's own words, and named as the place") {
  const auto refused = [](const char* change, const char* part) {
    const Reading reading = read(kScene, {change});
    INFO(change << "\n" << reading.text);
    CHECK_FALSE(reading.scene.has_value());
    CHECK(reading.text.find(std::string("--set ") + change) != std::string::npos);
    CHECK(reading.text.find(part) != std::string::npos);
  };
  refused("ball.radius=-1", "from 1e-09 to 1e+06 m");
  refused("ball.radios=1", "did you mean \"radius\"?");
  refused("bal.radius=1", "did you mean \"ball\"?");
  refused("ball.material=stel", "did you mean \"steel\"?");
  refused("ball.radius=big", "radius must be a number");
  refused("ball.name=a b", "is not a value");
  refused("ball.radius=", "is not a value");
  refused("ball=1", "NAME.key=value");
  refused("ball.radius", "NAME.key=value");
  refused("ball..radius=1", "NAME.key=value");
  refused("ball.radius.size=1", "not a table");
  refused("ball.radius=nan", "must be finite");
  refused("scene.seconds=1 seed=2", "is not a value");
}

TEST_CASE("a word behind --set is a text, with or without the quotes that the shell takes away") {
  for (const char* change :
       {"ball.look=steel", "ball.look=\"steel\"", "ball.look='steel'", "ball.look = steel "}) {
    const Reading reading = read(kScene, {change, "ball.colour=#ff0000"});
    INFO(change << "\n" << reading.text);
    REQUIRE(reading.scene.has_value());
    CHECK(reading.scene->bodies[1].look.name == "steel");
    CHECK(reading.scene->bodies[1].look.colours.size() == 1);
  }
}

TEST_CASE("bodies without a name are called by their number") {
  const Reading reading = read("[[body]]\nkind = \"sphere\"\n", {"body1.radius=0.25"});
  REQUIRE(reading.scene.has_value());
  CHECK(std::get<SphereForm>(reading.scene->bodies[0].form).radius == 0.25);
}

TEST_CASE("bodies that name no material are of what their kind is made of most often") {
  const Reading reading = read(
      "[[body]]\nshape = \"ornament\"\n[[body]]\nkind = \"solid\"\nshape = \"sphere\"\n"
      "[[body]]\nkind = \"plane\"\n[[body]]\nkind = \"sphere\"\n"
      "[[body]]\nkind = \"box\"\nsize = [1, 1, 1]\n[[body]]\nkind = \"capsule\"\n");
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  std::vector<std::string> materials;
  for (const auto& body : reading.scene->bodies)
    materials.push_back(reading.scene->materials.at(static_cast<std::size_t>(body.material)).material.name);
  CHECK(materials == std::vector<std::string>{"glass", "ceramic", "ceramic", "steel", "steel", "steel"});
}

TEST_CASE("a body may have a force and a torque") {
  const Reading reading = read("[[body]]\nkind = \"sphere\"\nforce = [1, 2, 3]\ntorque = [4, 5, 6]\n");
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  CHECK(reading.scene->bodies[0].force == Vec3(1, 2, 3));
  CHECK(reading.scene->bodies[0].torque == Vec3(4, 5, 6));
}

TEST_CASE("axes may be fixed by name") {
  const Reading reading = read("[[body]]\nkind = \"sphere\"\nfixed = [\"z\", \"rx\", \"ry\"]\n");
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  const body::LockedAxes& locked = reading.scene->bodies[0].locked;
  CHECK(locked.let_move(Vec3::Ones()) == Vec3(1, 1, 0));
  CHECK(locked.let_turn(Vec3::Ones()) == Vec3(0, 0, 1));
}

TEST_CASE("a capsule has a radius and a length and each has a sense without the other") {
  const auto capsule_of = [](const std::string& sizes) {
    const Reading reading = read("[[body]]\nkind = \"capsule\"\n" + sizes);
    INFO(reading.text);
    REQUIRE(reading.scene.has_value());
    return std::get<CapsuleForm>(reading.scene->bodies[0].form);
  };
  CHECK(capsule_of("radius = 0.1\nlength = 0.5\n").radius == 0.1);
  CHECK(capsule_of("radius = 0.1\nlength = 0.5\n").length == 0.5);
  CHECK(capsule_of("radius = 0.2\n").length == 0.8);
  CHECK(capsule_of("length = 0.2\n").radius == 0.05);
  CHECK(capsule_of("").length > 2.0 * capsule_of("").radius);
}

TEST_CASE("a script's events play on any scene, its faults bear its name") {
  const std::string file = "test_script.toml";
  std::ofstream(file)
      << "[[event]]\nat = 0.25\ndo = \"projectile\"\nfrom = [0, 1, 2]\nat_body = \"ball\"\nspeed = 5\n";
  const Reading reading = read(kScene, {}, file);
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  CHECK(reading.scene->events.size() == 3);
  CHECK(reading.scene->events[0].at == 0.25);
  std::ofstream(file)
      << "[[event]]\nat = 0.25\ndo = \"projectile\"\nfrom = [0, 1, 2]\nat_body = \"boll\"\nspeed = 5\n"
      << "[scene]\nseconds = 1\n";
  const Reading broken = read(kScene, {}, file);
  INFO(broken.text);
  CHECK_FALSE(broken.scene.has_value());
  CHECK(broken.text.find("test_script.toml:5:11") != std::string::npos);
  CHECK(broken.text.find("[[event]] only") != std::string::npos);
  std::remove(file.c_str());
  CHECK_FALSE(read(kScene, {}, "no_such_script.toml").scene.has_value());
}

TEST_CASE("edit distance counts insertions, removals, replacements and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("abc", "abc") == 0);
  CHECK(edit_distance("abc", "") == 3);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("ab", "ba") == 1);
  CHECK(edit_distance("position", "postion") == 1);
}

TEST_CASE("the nearest name is the one meant, or none") {
  const std::vector<std::string> known{"position", "rotation", "radius", "mesh"};
  CHECK(nearest_name("postion", known) == "position");
  CHECK(nearest_name("Radius", known) == "radius");
  CHECK(nearest_name("meshes", known) == "mesh");
  CHECK(nearest_name("Pos", known) == "position");
  CHECK(nearest_name("lookat", known).empty());  // there is no target here
  CHECK(nearest_name("xyz", known).empty());
  CHECK(nearest_name("", known).empty());
}
