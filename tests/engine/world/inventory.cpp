// What a scene does not need is not made: counts, bytes and stage times of zero, with the control that
// needing it makes them rise.
#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"
#include "engine/world/world.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

world::PartCount part(const world::World& w, const std::string& name) {
  for (const world::PartCount& row : w.inventory())
    if (row.part == name) return row;
  FAIL("no part is called " << name);
  return {};
}

world::World make_scene(bool is_breakable, bool has_grains, bool has_shell = true) {
  world::World w{world::WorldSettings{}};
  material::Material glass = *material::find_preset("glass");
  glass.grain_size = has_grains ? 0.01 : 0.0;
  REQUIRE(w.add_material(glass).ok());
  world::BodyDescription floor;
  floor.form = world::PlaneDescription{};
  REQUIRE(w.add_body(floor).ok());
  world::BodyDescription box;
  box.form = world::BoxDescription{Vec3::Constant(0.05)};
  box.pose.translation = Vec3(1, 0.06, 0);
  REQUIRE(w.add_body(box).ok());
  if (!has_shell) return w;
  for (int copy = 0; copy < 3; ++copy) {
    world::BodyDescription ball;
    world::ShellDescription shell;
    shell.mesh = geometry::make_sphere(0.04, {test::kIsSanitized ? 0.012 : 0.008, 0.0, 1}).value();
    shell.thickness = 0.0006;
    shell.is_breakable = is_breakable;
    ball.form = shell;
    ball.pose.translation = Vec3(-0.2 * copy, 0.1, 0);
    ball.velocity = Vec3(0, -6, 0);
    REQUIRE(w.add_body(ball).ok());
  }
  return w;
}

bool has_stage(const world::World& w, const std::string& name) {
  for (const auto& stage : w.report().stages.stages())
    if (stage.name == name) return true;
  return false;
}

}  // namespace

TEST_CASE(
    "a world of boxes has no meshes, one of unbreakable shells no stress, and neither spends time on it") {
  for (const bool has_shell : {false, true}) {
    world::World w = make_scene(false, true, has_shell);
    w.prepare();
    for (int i = 0; i < 24; ++i) w.step();
    CHECK(part(w, "surfaces").count == (has_shell ? 1 : 0));
    CHECK((part(w, "surfaces").bytes > 0.0) == has_shell);
    for (const char* name : {"shell_stiffness", "bending", "factors", "flaws", "grains", "virtual_nodes",
                             "impact_memory", "hands"}) {
      INFO(name);
      CHECK(part(w, name).count == 0);
      CHECK(part(w, name).bytes == 0.0);
    }
    for (const char* stage : {"snapshot", "stress", "fracture", "explosions", "hands"}) {
      INFO(stage);
      CHECK_FALSE(has_stage(w, stage));
    }
    CHECK(w.report().solver.solves + w.report().solver.factorisations == 0);
  }
}

TEST_CASE(
    "what can break has stress, shared by copies, grains only if its material has them, factors when "
    "prepared") {
  for (const bool has_grains : test::kIsSanitized ? std::vector{true} : std::vector{false, true}) {
    world::World w = make_scene(true, has_grains);
    CHECK(part(w, "surfaces").count == 1);  // three copies
    CHECK(part(w, "shell_stiffness").count == 1);
    CHECK(part(w, "shell_stiffness").bytes > 1e4);
    CHECK(part(w, "bending").count == 1);
    CHECK(part(w, "bending").bytes > 0.4 * part(w, "shell_stiffness").bytes);
    CHECK(part(w, "bending").bytes < part(w, "shell_stiffness").bytes);
    CHECK(part(w, "virtual_nodes").count == 0);
    CHECK(part(w, "flaws").count == 3);  // each has its own
    CHECK(part(w, "impact_memory").count == 3);
    CHECK((part(w, "grains").count > 0) == has_grains);
    CHECK((part(w, "grains").bytes > 0.0) == has_grains);
    CHECK(part(w, "factors").count == 0);
    w.prepare();
    CHECK(part(w, "factors").count > 0);
    CHECK(part(w, "factors").bytes > 1e5);
    for (long i = 0; i < test::how_many(12, 4); ++i) w.step();
    CHECK(w.report().breaks.size() > 0);
    CHECK(part(w, "virtual_nodes").count > 10);
    CHECK(part(w, "virtual_nodes").bytes > 0.0);
    for (const char* stage : {"snapshot", "stress", "fracture"}) CHECK(has_stage(w, stage));
    CHECK_FALSE(has_stage(w, "hands"));
    REQUIRE(w.grab(2, w.bodies()[1].pose.translation, 10.0) != 0);
    w.step();
    CHECK(part(w, "hands").count == 1);
    CHECK(has_stage(w, "hands"));
    CHECK_FALSE(has_stage(w, "explosions"));
    w.explode({Vec3(0, 0.2, 1), 1.0});
    w.step();
    CHECK(has_stage(w, "explosions"));
  }
}

TEST_CASE("what stands still has no pairs, what lies on something has, and friction where there is any") {
  for (const bool is_static : {true, false}) {
    for (const double coefficient : {0.0, 0.5}) {
      world::World w{world::WorldSettings{}};
      material::Material stone = *material::find_preset("concrete");
      stone.friction = coefficient;
      REQUIRE(w.add_material(stone).ok());
      world::BodyDescription floor;
      floor.form = world::PlaneDescription{};
      REQUIRE(w.add_body(floor).ok());
      world::BodyDescription box;
      box.form = world::BoxDescription{Vec3::Constant(0.05)};
      box.pose.translation = Vec3(0, 0.051, 0);
      box.velocity = is_static ? Vec3::Zero() : Vec3(1, 0, 0);
      box.motion = is_static ? body::Motion::fixed : body::Motion::dynamic;
      REQUIRE(w.add_body(box).ok());
      for (int i = 0; i < 12; ++i) w.step();
      CHECK(part(w, "near_pairs").count == (is_static ? 0 : 1));
      CHECK((part(w, "near_pairs").bytes > 0.0) == !is_static);
      CHECK((part(w, "friction").count > 0) == (!is_static && coefficient > 0.0));
      CHECK((part(w, "friction").bytes > 0.0) == (!is_static && coefficient > 0.0));
    }
  }
}

TEST_CASE("ways are tested where something may be met, and rest is watched where sleep is wanted") {
  struct Case {
    double height;  // m, of a box over the floor
    bool has_sleep, has_tests, rests;
  };
  for (const Case& one :
       {Case{0.051, true, true, true}, Case{0.051, false, true, false}, Case{5.0, true, false, false}}) {
    world::WorldSettings settings;
    settings.has_sleep = one.has_sleep;
    world::World w{settings};
    REQUIRE(w.add_material(*material::find_preset("concrete")).ok());
    world::BodyDescription floor;
    floor.form = world::PlaneDescription{};
    REQUIRE(w.add_body(floor).ok());
    world::BodyDescription box;
    box.form = world::BoxDescription{Vec3::Constant(0.05)};
    box.pose.translation = Vec3(0, one.height, 0);
    REQUIRE(w.add_body(box).ok());
    for (int i = 0; i < 60; ++i) w.step();
    INFO(one.height << ' ' << one.has_sleep);
    CHECK((part(w, "continuous_tests").count > 0) == one.has_tests);
    CHECK((part(w, "continuous_tests").bytes > 0.0) == one.has_tests);
    CHECK(part(w, "sleeping").count == (one.rests ? 1 : 0));
    CHECK((part(w, "sleeping").bytes > 0.0) == one.rests);
  }
}

TEST_CASE("a solid has tetrahedra if it can break, and nothing of shells whether it can or not") {
  struct Case {
    bool is_breakable, has_grains;
  };
  for (const auto& [is_breakable, has_grains] : {Case{false, true}, Case{true, false}, Case{true, true}}) {
    world::World w{world::WorldSettings{}};
    material::Material plaster = *material::find_preset("plaster");
    plaster.grain_size = has_grains ? 0.06 : 0.0;
    REQUIRE(w.add_material(plaster).ok());
    world::BodyDescription slab;
    world::SolidDescription solid;
    solid.mesh = geometry::make_box_surface(Vec3(0.1, 0.05, 0.05));
    solid.element_size = 0.05;
    solid.is_breakable = is_breakable;
    slab.form = solid;
    REQUIRE(w.add_body(slab).ok());
    w.prepare();
    for (int i = 0; i < 2; ++i) w.step();
    CHECK(part(w, "surfaces").count == 1);
    CHECK((part(w, "tetrahedra").count > 0) == is_breakable);
    CHECK((part(w, "tetrahedra").bytes > 0.0) == is_breakable);
    CHECK((part(w, "flaws").count > 0) == is_breakable);
    CHECK((part(w, "grains").count > 0) == (is_breakable && has_grains));
    CHECK((part(w, "grains").bytes > 0.0) == (is_breakable && has_grains));
    CHECK((part(w, "virtual_nodes").count > 0) == is_breakable);  // the lattice reaches beyond the surface
    CHECK(part(w, "bending").count == 0);
    CHECK(part(w, "shell_stiffness").count == 0);
    CHECK(part(w, "shell_stiffness").bytes == 0.0);
    CHECK(has_stage(w, "fracture") == is_breakable);
  }
}
