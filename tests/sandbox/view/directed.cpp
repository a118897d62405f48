// What the script does to the picture: the camera's moves, captions, overlays.
#include <catch2/catch.hpp>

#include "sandbox/view/view.h"
#include "tests/sandbox/script/building.h"

using namespace shatterbox;
using namespace shatterbox::sandbox;

namespace {

/// A scene whose events are handed to its view one by one.
struct Stage {
  scene::Reading reading;
  std::optional<scene::BuiltScene> built;
  std::optional<view::View> view;

  explicit Stage(const std::string& text) : reading(scene::read(text)), built(build(reading)) {
    view.emplace(*reading.scene, *built);
  }
  view::Moment at(double film) const { return {film, built->world.time(), 1.0, built->world.bodies()}; }
  void begin(std::size_t event, double film) { view->begin({film, &reading.scene->events[event]}, at(film)); }
  render::Frame frame(double film) { return view->make_frame(at(film)); }
  glm::vec3 eye(double film) { return frame(film).camera.position; }
  glm::vec3 target(double film) { return frame(film).camera.target; }
};

bool is_near(const glm::vec3& a, const glm::vec3& b) {
  return glm::distance(a, b) < 1e-4F;
}

const std::string kBall =
    "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\nradius = 0.1\n"
    "position = [1,0,0]\nvelocity = [0,2,0]\n[camera]\nposition = [0,0,4]\ntarget = [0,0,0]\nfov = 40\n";

std::string camera(const std::string& keys) {
  return "[[event]]\nat = 0\ndo = \"camera\"\n" + keys;
}

}  // namespace

TEST_CASE("a cut is there at once, a dolly eases from where the camera is to where it is sent") {
  Stage stage(kBall + camera("position = [0,3,4]\nfov = 20\n") +
              camera("move = \"dolly\"\nposition = [4,3,0]\nduration = 2\n"));
  CHECK(is_near(stage.eye(0.5), {0, 0, 4}));
  stage.begin(0, 1.0);
  CHECK(is_near(stage.eye(1.0), {0, 3, 4}));
  CHECK(stage.frame(1.0).camera.vertical_fov == Approx(20));
  CHECK(is_near(stage.target(1.0), {0, 0, 0}));  // it said nothing of the target
  stage.begin(1, 2.0);
  CHECK(is_near(stage.eye(2.0), {0, 3, 4}));
  CHECK(is_near(stage.eye(3.0), {2, 3, 2}));
  CHECK(is_near(stage.eye(4.0), {4, 3, 0}));
  CHECK(is_near(stage.eye(9.0), {4, 3, 0}));
  // At rest at both ends: of a smooth step the first hundredth goes 3e-4 of the way.
  CHECK(glm::distance(stage.eye(2.02), stage.eye(2.0)) <
        4e-4F * glm::distance(stage.eye(2.0), stage.eye(4.0)));
}

TEST_CASE("an orbit keeps its distance, and goes against the clock seen from above") {
  Stage stage(kBall + camera("move = \"orbit\"\nangle = 90\nduration = 1\neasing = \"straight\"\n"));
  stage.begin(0, 0.0);
  CHECK(is_near(stage.eye(1.0), {4, 0, 0}));
  CHECK(is_near(stage.eye(0.5), {4 * std::sqrt(0.5F), 0, 4 * std::sqrt(0.5F)}));
  for (const double film : {0.1, 0.3, 0.7}) CHECK(glm::length(stage.eye(film)) == Approx(4.0F));
}

TEST_CASE("a camera follows a body with its eye or as a whole, while other moves go on") {
  Stage stage(kBall + camera("move = \"follow\"\nbody = \"ball\"\nduration = 0\n") +
              camera("move = \"dolly\"\nposition = [0,0,8]\nduration = 1\n") +
              camera("move = \"follow\"\nbody = \"ball\"\noffset = [0,1,2]\nduration = 0\n"));
  stage.begin(0, 0.0);
  CHECK(is_near(stage.target(0.0), {1, 0, 0}));
  CHECK(is_near(stage.eye(0.0), {0, 0, 4}));
  while (stage.built->world.time() < 0.5) stage.built->world.step();
  CHECK(is_near(stage.target(0.5), {1, 1, 0}));
  stage.begin(1, 1.0);
  CHECK(is_near(stage.eye(2.0), {0, 0, 8}));
  CHECK(is_near(stage.target(2.0), {1, 1, 0}));
  stage.begin(2, 3.0);
  CHECK(is_near(stage.eye(3.0), {1, 2, 2}));
  stage.built->world.remove_body(stage.built->world.bodies()[0].id);
  CHECK(is_near(stage.target(4.0), {1, 1, 0}));  // where it was last
}

TEST_CASE("the scene's own camera follows a body") {
  Stage stage(
      "[scene]\ngravity = [0,0,0]\n[[body]]\nname = \"ball\"\nkind = \"sphere\"\nvelocity = [0,2,0]\n"
      "[camera]\nfollow = \"ball\"\noffset = [0,0,3]\n");
  CHECK(is_near(stage.target(0.0), {0, 0, 0}));
  while (stage.built->world.time() < 0.5) stage.built->world.step();
  CHECK(is_near(stage.target(0.5), {0, 1, 0}));
  CHECK(is_near(stage.eye(0.5), {0, 1, 3}));
}

TEST_CASE("a caption fades in, stays and fades out, and the next takes its place") {
  Stage stage(kBall + "[[event]]\nat = 0\ndo = \"caption\"\ntext = \"one\"\nduration = 2\nfade = 0.5\n" +
              "[[event]]\nat = 0\ndo = \"caption\"\ntext = \"two\"\n");
  CHECK(stage.frame(0.0).title.opacity == 0.0F);
  stage.begin(0, 1.0);
  CHECK(stage.frame(1.25).title.opacity == Approx(0.5F));
  CHECK(stage.frame(2.0).title.opacity == 1.0F);
  CHECK(stage.frame(2.0).title.text == "one");
  CHECK(stage.frame(2.75).title.opacity == Approx(0.5F));
  CHECK(stage.frame(3.1).title.opacity == 0.0F);
  stage.begin(0, 4.0);
  stage.begin(1, 5.0);
  CHECK(stage.frame(5.9).title.text == "two");
}

TEST_CASE("the velocity overlay tells how fast each point is, the impacts overlay marks the hits") {
  Stage stage(
      "[[body]]\nkind = \"plane\"\n[[body]]\nname = \"box\"\nkind = \"box\"\nsize = [2,1,1]\n"
      "position = [0,5,0]\nvelocity = [0,3,0]\nangular_velocity = [0,0,4]\n"
      "[[body]]\nname = \"ball\"\nkind = \"shell\"\nshape = \"sphere\"\nradius = 0.05\nedge_length = 0.012\n"
      "thickness = 0.0006\nmaterial = \"glass\"\nposition = [3,0.1,0]\nvelocity = [0,-6,0]\n"
      "[[event]]\nat = 0\ndo = \"overlay\"\nshow = \"velocity\"\nmost = 9\n"
      "[[event]]\nat = 0\ndo = \"overlay\"\nshow = \"impacts\"\n"
      "[[event]]\nat = 0\ndo = \"overlay\"\nshow = \"wireframe\"\n"
      "[[event]]\nat = 0\ndo = \"overlay\"\nshow = \"none\"\n");
  CHECK(stage.frame(0.0).overlay.kind == render::OverlayKind::none);
  stage.begin(0, 0.0);
  const render::Frame fast = stage.frame(0.0);
  CHECK(fast.overlay.kind == render::OverlayKind::heat);
  CHECK(fast.overlay.unit == "m/s");
  CHECK(fast.overlay.most == 9.0F);
  const render::Draw& box = fast.draws[0];
  REQUIRE(box.scalars);
  for (std::size_t v = 0; v < box.scalars->size(); ++v) {
    const glm::vec3 p = box.mesh->positions[v];  // v + w x r, w about z
    CHECK((*box.scalars)[v] == Approx(std::hypot(-4.0 * p.y, 3.0 + 4.0 * p.x)));
  }
  stage.begin(1, 0.0);
  const std::size_t bodies = stage.frame(0.0).draws.size();
  while (stage.built->world.report().impacts.empty() && stage.built->world.steps() < 60)
    stage.built->world.step();
  CHECK(stage.frame(0.1).draws.size() >= bodies + stage.built->world.report().impacts.size());
  stage.begin(2, 0.2);
  CHECK(stage.frame(0.2).overlay.has_wires);
  stage.begin(3, 0.2);
  CHECK_FALSE(stage.frame(0.3).overlay.has_wires);
}

TEST_CASE("the grains overlay parts a shell where grains meet, and nowhere else") {
  body::Shape shape;
  shape.kind = body::ShapeKind::shell;
  shape.surface.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(2, 0, 0)};
  shape.surface.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
  const auto mesh = view::make_mesh(shape, 1);
  CHECK_FALSE(view::make_grain_mesh(shape, *mesh, 2).has_value());
  shape.triangle_grains = {5, 5, 8};
  const auto parted = view::make_grain_mesh(shape, *mesh, 2);
  REQUIRE(parted.has_value());
  CHECK(parted->mesh->positions.size() == 7);
  CHECK(parted->groups->size() == 7);
  for (std::size_t t = 0; t < 3; ++t)
    for (int corner = 0; corner < 3; ++corner) {
      const unsigned vertex = parted->mesh->triangles[t][corner];
      CHECK(parted->mesh->positions[vertex] == mesh->positions[mesh->triangles[t][corner]]);
      CHECK((*parted->groups)[vertex] == (*parted->groups)[parted->mesh->triangles[t][0]]);
    }
  CHECK((*parted->groups)[parted->mesh->triangles[0][0]] != (*parted->groups)[parted->mesh->triangles[2][0]]);
}
