// From plain data to bodies: meshes, supports, copies.
#include "sandbox/scene/build_world.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <set>
#include <utility>

#include "engine/core/elementary.h"
#include "engine/geometry/generators.h"
#include "engine/material/material.h"
#include "sandbox/scene/build_mesh.h"
#include "sandbox/scene/wall_thickness.h"
#include "tests/sandbox/scene/mesh_file_folder.h"
#include "tests/sandbox/scene/reading.h"

using namespace shatterbox;
using namespace shatterbox::sandbox::scene;

namespace {

const ShellForm& first_shell(const Reading& reading) {
  return std::get<ShellForm>(reading.scene->bodies.front().form);
}

BuiltScene build(const std::string& text) {
  const Reading reading = read(text);
  REQUIRE(reading.scene.has_value());
  Problems problems;
  auto built = build_world(*reading.scene, problems);
  REQUIRE(built.has_value());
  return std::move(*built);
}

/// What is told while a world is made.
std::vector<std::string> watched(const std::string& text) {
  const Reading reading = read(text);
  REQUIRE(reading.scene.has_value());
  Problems problems;
  std::vector<std::string> told;
  REQUIRE(build_world(*reading.scene, problems, [&](int body, const std::string& note) {
            told.push_back(fmt::format("{} {}", body, note));
          }).has_value());
  return told;
}

/// Least and greatest coordinates.
std::pair<Vec3, Vec3> bounds_of(const geometry::TriangleMesh& mesh) {
  Vec3 least = Vec3::Constant(1e9), most = -least;
  for (const Vec3& p : mesh.positions) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  return {least, most};
}

}  // namespace

TEST_CASE("generated meshes have about 5000 triangles unless told otherwise") {
  for (const char* shape : {"sphere", "ornament", "bowl", "pane"}) {
    const Reading reading = read(std::string("[[body]]\nkind = \"shell\"\nshape = \"") + shape + "\"\n");
    REQUIRE(reading.scene.has_value());
    Problems problems;
    std::vector<std::string> notes;
    const auto built = build_mesh(first_shell(reading), {}, problems, notes);
    REQUIRE(built.has_value());
    INFO(shape << ": " << built->mesh.triangles.size());
    CHECK(built->mesh.triangles.size() > 3500);
    CHECK(built->mesh.triangles.size() < 7000);
    CHECK(built->parts.size() == built->mesh.triangles.size());
  }
}

TEST_CASE("in a bond every other course is shifted") {
  const Reading reading = read(
      "[[body]]\nkind = \"box\"\nsize = 0.1\nrepeat = {count = [2, 3, 1], spacing = [1, 2, 3], bond = "
      "0.5}\n");
  REQUIRE(reading.scene.has_value());
  const std::vector<Pose> poses = copy_poses(reading.scene->bodies.front(), 1, 0);
  const std::vector<Vec3> expected{{0, 0, 0}, {1, 0, 0}, {0.5, 2, 0}, {1.5, 2, 0}, {0, 4, 0}, {1, 4, 0}};
  REQUIRE(poses.size() == expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) CHECK(poses[i].translation == expected[i]);
}

TEST_CASE("a solid needs a closed mesh") {
  const MeshFileFolder folder;
  const std::string open =
      folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  const Reading reading = read("[[body]]\nname = \"tent\"\nkind = \"solid\"\nmesh = \"" + open + "\"\n");
  REQUIRE(reading.scene.has_value());
  Problems problems;
  CHECK(!build_world(*reading.scene, problems).has_value());
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("open border") != std::string::npos);
}

TEST_CASE("a solid's small hole is closed, and parts that overlap are united, with a note") {
  const MeshFileFolder folder;
  geometry::Meshing meshing;
  meshing.edge_length = 0.015;
  const geometry::TriangleMesh ball = geometry::make_sphere(0.1, meshing).value();
  std::string points, faces, more_faces, shifted;
  for (const Vec3& p : ball.positions) {
    points += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
    shifted += fmt::format("v {} {} {}\n", p.x() + 0.12, p.y(), p.z());
  }
  const auto count = static_cast<int>(ball.positions.size());
  for (const geometry::Triangle& t : ball.triangles) {
    faces += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    more_faces += fmt::format("f {} {} {}\n", t[0] + 1 + count, t[1] + 1 + count, t[2] + 1 + count);
  }
  const auto build = [&](const char* name, const std::string& text) {
    const Reading reading =
        read("[[body]]\nname = \"ball\"\nkind = \"solid\"\nmaterial = \"plaster\"\nmesh = \"" +
             folder.write(name, text).string() + "\"\n");
    REQUIRE(reading.scene.has_value());
    Problems problems;
    auto built = build_world(*reading.scene, problems);
    INFO(describe(problems));
    REQUIRE(built.has_value());
    REQUIRE(built->plan.notes.size() >= 1);
    return std::pair(built->world.bodies()[0].shape->mass, built->plan.notes.back());
  };
  const double density = material::find_preset("plaster")->density;
  constexpr double kBall = 4.0 / 3.0 * core::kPi * 1e-3, kLens = core::kPi / 12.0 * 0.52 * 0.08 * 0.08;
  const auto [holed_mass, holed_note] = build("holed.obj", points + faces.substr(faces.find('\n') + 1));
  CHECK(holed_mass == Approx(density * kBall).epsilon(0.03));
  CHECK(holed_note.find("open border") != std::string::npos);
  CHECK(holed_note.find("over holes") != std::string::npos);
  const auto [united_mass, united_note] = build("united.obj", points + shifted + faces + more_faces);
  CHECK(united_mass == Approx(density * (2.0 * kBall - kLens)).epsilon(0.03));
  CHECK(united_note.find("pass through each other") != std::string::npos);
  // What an event brings in cannot wait until it is there.
  const Reading later = read(
      "[[event]]\nat = 1\ndo = \"drop\"\nposition = [0, 1, 0]\nbody = {name = \"late\", kind = \"solid\", "
      "material = "
      "\"plaster\", mesh = \"" +
      folder.write("late.obj", points + shifted + faces + more_faces).string() + "\"}\n");
  REQUIRE(later.scene.has_value());
  Problems problems;
  const auto built = build_world(*later.scene, problems);
  INFO(describe(problems));
  REQUIRE(built.has_value());
  REQUIRE_FALSE(built->plan.notes.empty());
  CHECK(built->plan.notes.back().find("pass through each other") != std::string::npos);
}

TEST_CASE("walls of hardly an element are noted, and closed meshes of files that are walls and no sheets") {
  const auto notes_of = [](const std::string& keys) {
    const Reading reading = read("[[body]]\nname = \"it\"\nmaterial = \"glass\"\n" + keys);
    INFO(reading.text);
    REQUIRE(reading.scene.has_value());
    Problems problems;
    const auto plan = plan_bodies(*reading.scene, problems);
    REQUIRE(plan.has_value());
    std::string all;
    for (const std::string& note : plan->notes) all += note + "\n";
    return all;
  };
  const std::string vase = "kind = \"solid\"\nshape = \"vase\"\nwall = 0.006\n";
  CHECK(notes_of(vase).find("the wall of \"it\" is 0.00") != std::string::npos);
  CHECK(notes_of(vase + "element_size = 0.014\n").find("element_size = 0.00") != std::string::npos);
  CHECK(notes_of(vase + "element_size = 0.011\n").find("the wall of") == std::string::npos);
  CHECK(notes_of(vase + "breakable = false\n").find("the wall of") == std::string::npos);
  // What is advised is not refused: sheets are vases, panes and bottles, and no lathe's wall that is not one.
  CHECK(notes_of(vase).find("a sheet (kind = \"shell\", thickness = 0.00") != std::string::npos);
  CHECK(notes_of("kind = \"shell\"\nshape = \"vase\"\nthickness = 0.006\n").empty());
  CHECK(
      notes_of("kind = \"solid\"\nshape = \"lathe\"\nprofile = [[0.1, 0], [0.1, 0.3], [0.095, 0.3], [0.095, "
               "0], [0.1, 0]]\nelement_size = 0.02\n")
          .find("a sheet") == std::string::npos);
  CHECK(notes_of("kind = \"solid\"\nshape = \"slab\"\nsize = [1, 0.01, 0.3]\n").find("shape = \"pane\"") !=
        std::string::npos);
  CHECK(notes_of("kind = \"solid\"\nshape = \"bottle\"\n").find("a sheet (kind = \"shell\"") !=
        std::string::npos);
  CHECK(notes_of("kind = \"solid\"\nshape = \"slab\"\nsize = [1, 0.2, 0.3]\n").find("the wall of") ==
        std::string::npos);
  // A plate of two sides, and a cube.
  const MeshFileFolder folder;
  const auto sheet_from = [&](const std::string& name, double height) {
    std::string text;
    for (int i = 0; i < 8; ++i) text += fmt::format("v {} {} {}\n", i & 1, (i & 2) / 2 * height, (i & 4) / 4);
    text += "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";
    return notes_of("kind = \"shell\"\nthickness = 0.003\nmesh = \"" + folder.write(name, text).string() +
                    "\"\n");
  };
  CHECK(sheet_from("plate.obj", 0.02).find("a wall of its own, 0.02 m thick") != std::string::npos);
  CHECK(sheet_from("cube.obj", 1.0).find("a wall of its own") == std::string::npos);
}

TEST_CASE("half of all lines straight in through a closed mesh are no longer than its wall") {
  geometry::Meshing meshing;
  meshing.edge_length = 0.02;
  geometry::TriangleMesh ball = geometry::make_sphere(0.1, meshing).value();
  CHECK(wall_thickness(ball) == Approx(0.2).epsilon(0.03));
  const geometry::TriangleMesh inner = geometry::make_sphere(0.09, meshing).value();
  const int first = static_cast<int>(ball.positions.size());
  ball.positions.insert(ball.positions.end(), inner.positions.begin(), inner.positions.end());
  for (const geometry::Triangle& t : inner.triangles)
    ball.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
  CHECK(wall_thickness(ball) == Approx(0.01).epsilon(0.1));
  CHECK(wall_thickness({}) == 0.0);
}

TEST_CASE("a mesh that is beyond mending is refused with what is wrong") {
  const MeshFileFolder folder;
  const std::string flat = folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  const Reading reading = read("[[body]]\nkind = \"shell\"\nmesh = \"" + flat + "\"\n");
  REQUIRE(reading.scene.has_value());
  Problems problems;
  CHECK(!build_world(*reading.scene, problems).has_value());
  REQUIRE(problems.size() == 1);
  INFO(describe(problems));
  CHECK(problems[0].message.find("flat.obj cannot be used") != std::string::npos);
  CHECK_FALSE(problems[0].hint.empty());
}

TEST_CASE("size stretches to a box, up = z turns") {
  const Reading reading = read(
      "[[body]]\nkind = \"shell\"\nshape = \"pane\"\nwidth = 1\nheight = 2\nup = \"z\"\nsize = [3, 1, 4]\n"
      "edge_length = 0.1\n");
  REQUIRE(reading.scene.has_value());
  Problems problems;
  std::vector<std::string> notes;
  const auto built = build_mesh(first_shell(reading), {}, problems, notes);
  REQUIRE(built.has_value());
  const auto [least, most] = bounds_of(built->mesh);
  CHECK((most - least - Vec3(3, 0, 4)).norm() <
        1e-12);  // the pane's height lies along -z; no thickness to stretch
}

TEST_CASE("bricks are a wall on the middle of its foot, each a body") {
  const BuiltScene built = build(
      "[[body]]\nname = \"brick\"\nkind = \"solid\"\nshape = \"bricks\"\nsize = [1, 0.5, 0.12]\nmaterial = "
      "\"brick\"\nelement_size = 0.1\nposition = [3, 1, 2]\n");
  REQUIRE(built.world.bodies().size() == 4 * 7);
  geometry::TriangleMesh wall;
  double mass = 0.0;
  for (const body::Body& brick : built.world.bodies()) {
    mass += brick.shape->mass;
    for (const Vec3& p : brick.shape->surface.positions) wall.positions.push_back(brick.pose.apply(p));
  }
  const auto [least, most] = bounds_of(wall);
  // Every other course stands out by a third of a brick.
  const double half = 0.5 * ((4.0 + 1.0 / 3.0) * 0.241 - 0.001);
  CHECK((least - Vec3(3 - half, 1.0001, 2 - 0.0575)).norm() < 1e-9);
  CHECK((most - Vec3(3 + half, 1 + 7 * 0.0711, 2 + 0.0575)).norm() < 1e-9);
  CHECK(mass == Approx(28 * built.world.bodies()[0].shape->mass));
}

TEST_CASE("a file's mesh stands where it is asked to, wherever its own frame begins") {
  const MeshFileFolder folder;
  const std::string file =
      folder.write("far.obj", "v 5 3 -2\nv 7 3 -2\nv 5 6 -2\nv 5 3 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
          .string();
  const auto least_and_most = [&](const std::string& origin) {
    const Reading reading =
        read("[[body]]\nkind = \"shell\"\nmesh = \"" + file + "\"\nscale = 0.5\n" + origin);
    REQUIRE(reading.scene.has_value());
    Problems problems;
    std::vector<std::string> notes;
    const auto built = build_mesh(first_shell(reading), {}, problems, notes);
    REQUIRE(built.has_value());
    return bounds_of(built->mesh);
  };
  CHECK(least_and_most("") == std::pair(Vec3(2.5, 1.5, -1.0), Vec3(3.5, 3.0, 1.0)));
  CHECK(least_and_most("origin = \"file\"\n") == least_and_most(""));
  CHECK(least_and_most("origin = \"foot\"\n") == std::pair(Vec3(-0.5, 0.0, -1.0), Vec3(0.5, 1.5, 1.0)));
  CHECK(least_and_most("origin = \"middle\"\n") == std::pair(Vec3(-0.5, -0.75, -1.0), Vec3(0.5, 0.75, 1.0)));
}

TEST_CASE("a file's mesh of a hundred metres is built, with a word on millimetres") {
  const MeshFileFolder folder;
  const std::string file = folder.write("tent.obj", "v 0 0 0\nv 150 0 0\nv 0 120 0\nf 1 2 3\n").string();
  const auto notes_at = [&](double scale) {
    ShellForm form;
    form.shape = MeshFileShape{{}, {file}};
    form.scale = Vec3::Constant(scale);
    Problems problems;
    std::vector<std::string> notes;
    CHECK(build_mesh(form, {}, problems, notes).has_value());
    return notes;
  };
  REQUIRE(notes_at(1.0).size() == 1);
  CHECK(notes_at(1.0)[0].find("150 m across\n") != std::string::npos);
  CHECK(notes_at(1.0)[0].find("if the file is in millimetres") != std::string::npos);
  CHECK(notes_at(0.001).empty());
}

TEST_CASE("supports hold the border, the foot, or what is in a box") {
  const Reading reading =
      read("[[body]]\nkind = \"shell\"\nshape = \"pane\"\nwidth = 1\nheight = 1\nedge_length = 0.1\n");
  REQUIRE(reading.scene.has_value());
  Problems problems;
  std::vector<std::string> notes;
  const auto mesh = build_mesh(first_shell(reading), {}, problems, notes)->mesh;
  const auto held = [&](const Support& support, const Quat& rotation = Quat::Identity()) {
    return find_clamped(mesh, rotation, support, {}, problems);
  };
  for (const int v : held(EdgeSupport{})) {
    CHECK(mesh.positions[static_cast<std::size_t>(v)].cwiseAbs().maxCoeff() == Approx(0.5));
  }
  CHECK(held(EdgeSupport{}).size() >= 36);
  for (const int v : held(FootSupport{})) CHECK(mesh.positions[static_cast<std::size_t>(v)].y() < -0.47);
  const Quat upside_down(0, 0, 0, 1);  // half a turn about z
  for (const int v : held(FootSupport{}, upside_down))
    CHECK(mesh.positions[static_cast<std::size_t>(v)].y() > 0.47);
  for (const int v : held(BoxSupport{Vec3(0, 0, -1), Vec3(1, 1, 1)})) {
    CHECK(mesh.positions[static_cast<std::size_t>(v)].x() >= 0.0);
  }
  CHECK(problems.empty());
  CHECK(held(BoxSupport{Vec3(5, 5, 5), Vec3(6, 6, 6)}).empty());
  CHECK(problems.size() == 1);
}

TEST_CASE("copies stand in rows and grids, and jitter by the seed alone") {
  const Reading reading = read(
      "[[body]]\nkind = \"sphere\"\nrepeat = {count = 3, spacing = [1, 2, 0]}\n"
      "[[body]]\nkind = \"sphere\"\nrepeat = {count = [2, 3, 4], spacing = 0.5, jitter = 0.1, "
      "rotation_jitter = 20}\n");
  REQUIRE(reading.scene.has_value());
  const auto row = copy_poses(reading.scene->bodies[0], 1, 0);
  REQUIRE(row.size() == 3);
  CHECK(row[2].translation == Vec3(2, 4, 0));
  const auto grid = copy_poses(reading.scene->bodies[1], 1, 1);
  REQUIRE(grid.size() == 24);
  CHECK((grid[23].translation - Vec3(0.5, 1.0, 1.5)).cwiseAbs().maxCoeff() <= 0.1);
  CHECK(grid[0].translation != Vec3(0, 0, 0));
  CHECK(copy_poses(reading.scene->bodies[1], 1, 1)[7].translation == grid[7].translation);
  CHECK(copy_poses(reading.scene->bodies[1], 2, 1)[7].translation != grid[7].translation);
  CHECK(grid[5].rotation.angularDistance(Quat::Identity()) < 20.0 * 3.15 / 180.0);
}

TEST_CASE("a count with a layer fills layers from their middle, upwards") {
  const Reading reading = read(
      "[[body]]\nkind = \"sphere\"\nposition = [1, 2, 3]\n"
      "repeat = {count = 20, layer = [3, 3], spacing = [1, 0.5, 2]}\n");
  REQUIRE(reading.scene.has_value());
  const auto poses = copy_poses(reading.scene->bodies[0], 1, 0);
  REQUIRE(poses.size() == 20);
  CHECK(poses[0].translation == Vec3(1, 2, 3));
  CHECK(poses[1].translation == Vec3(0, 2, 3));  // x is the nearer neighbour
  CHECK(poses[2].translation == Vec3(2, 2, 3));
  CHECK(poses[9].translation == Vec3(1, 2.5, 3));
  CHECK(poses[19].translation == Vec3(0, 3, 3));
  std::set<std::array<double, 3>> places;
  for (const Pose& pose : poses)
    places.insert({pose.translation.x(), pose.translation.y(), pose.translation.z()});
  CHECK(places.size() == 20);
}

TEST_CASE("fewer copies are the first of many, to the bit") {
  const char* const text =
      "[[body]]\nname = \"boats\"\nkind = \"shell\"\nshape = \"boat\"\nbreakable = false\n"
      "repeat = {count = 30, layer = [3, 3], spacing = 2, jitter = 0.2, rotation_jitter = 50}\n";
  const Reading many = read(text);
  const Reading few = read(text, {"boats.repeat.count=7"});
  REQUIRE(many.scene.has_value());
  REQUIRE(few.scene.has_value());
  const auto all = copy_poses(many.scene->bodies[0], 5, 0);
  const auto some = copy_poses(few.scene->bodies[0], 5, 0);
  REQUIRE(some.size() == 7);
  for (std::size_t i = 0; i < some.size(); ++i) {
    CHECK(some[i].translation == all[i].translation);
    CHECK(some[i].rotation.coeffs() == all[i].rotation.coeffs());
  }
}

TEST_CASE("copies share one shape, have numbered names, and know where they came from") {
  const Reading reading = read(
      "[[body]]\nname = \"boats\"\nkind = \"shell\"\nshape = \"boat\"\n"
      "repeat = {count = 3, spacing = 2}\n");
  REQUIRE(reading.scene.has_value());
  Problems problems;
  const auto built = build_world(*reading.scene, problems);
  REQUIRE(built.has_value());
  const auto bodies = built->world.bodies();
  REQUIRE(bodies.size() == 3);
  CHECK(bodies[0].shape->surface.triangles.size() == 300);
  CHECK(bodies[1].shape == bodies[0].shape);
  CHECK(bodies[2].shape == bodies[0].shape);
  CHECK(bodies[2].name == "boats[3]");
  CHECK(built->origins.at(bodies[2].id).copy == 2);
}

TEST_CASE("bodies that cannot be are refused at their place") {
  const auto refused = [](const std::string& text, const char* part) {
    const Reading reading = read(text);
    INFO(reading.text);
    REQUIRE(reading.scene.has_value());
    Problems problems;
    CHECK_FALSE(build_world(*reading.scene, problems).has_value());
    INFO(describe(problems));
    REQUIRE_FALSE(problems.empty());
    CHECK(describe(problems).find("t.toml:1:1") == 0);
    CHECK(describe(problems).find(part) != std::string::npos);
  };
  refused("[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nsupport = \"edge\"\n", "no open border");
  refused("[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nedge_length = 1e-9\n", "");
  refused(
      "[[body]]\nkind = \"solid\"\nshape = \"slab\"\nsize = [1, 1, 1]\nsupport = {box = [[5, 5, 5], [6, 6, "
      "6]]}\n",
      "the support's box is beside the mesh");
  refused(
      "[[body]]\nkind = \"solid\"\nshape = \"slab\"\nsize = [0.2, 0.2, 0.01]\nmaterial = "
      "\"tempered_glass\"\n",
      "surface_compression is of sheets");
  // Nor what is to come in later.
  refused(
      "[[body]]\nname = \"q\"\nkind = \"solid\"\nshape = \"slab\"\nsize = [0.2, 0.2, 0.01]\nmaterial = "
      "\"tempered_glass\"\n[[event]]\nat = 1\ndo = \"drop\"\nbody = \"q\"\n",
      "body \"q\": surface_compression is of sheets");
  refused("[[body]]\nkind = \"shell\"\nshape = \"sphere\"\nradius = 1\nscale = 1e6\n", "scale = 0.001");
}

TEST_CASE("copies of a scripted body go the same way from where each stands, about their pivots") {
  const Reading reading = read(
      "[[body]]\nname = \"arm\"\nkind = \"box\"\nsize = [1, 0.1, 0.1]\nrotation = [0, 90, 0]\nmotion = "
      "\"scripted\"\n"
      "pivot = [-0.5, 0, 0]\nbetween_keys = \"straight\"\nrepeat = {count = 2, spacing = [3, 0, 0]}\n"
      "keyframes = [{at = 0, position = [0, 1, 0]}, {at = 0.5, rotation = [0, 450, 0]}, {at = 1, position = "
      "[0, "
      "2, 0]}]\n");
  INFO(reading.text);
  REQUIRE(reading.scene.has_value());
  Problems problems;
  auto built = build_world(*reading.scene, problems);
  REQUIRE(built.has_value());
  // The arm points along -z at 0, a turn later, and along +x after a quarter of the half second.
  const auto check = [&](const Vec3& first) {
    for (std::size_t i = 0; i < 2; ++i)
      CHECK((built->world.bodies()[i].pose.translation - (first + Vec3(3.0 * static_cast<double>(i), 0, 0)))
                .norm() < 1e-12);
  };
  check(Vec3(0, 1, -0.5));
  for (int i = 0; i < 30; ++i) built->world.step();
  check(Vec3(-0.5, 1, 0));  // 180 degrees
  for (int i = 0; i < 90; ++i) built->world.step();
  check(Vec3(0, 1, -0.5));
  for (int i = 0; i < 120; ++i) built->world.step();
  check(Vec3(0, 2, -0.5));
}

TEST_CASE("mortar joins copies where they touch and says so where none do") {
  const std::string wall =
      "[[body]]\nname = \"brick\"\nkind = \"box\"\nsize = [0.2, 0.1, 0.1]\nposition = [0, 0.05, 0]\n"
      "repeat = {count = [3, 2, 1], spacing = [0.2005, 0.1005, 1], bond = 0.5}\n"
      "[[body]]\nname = \"floor\"\nkind = \"plane\"\n"
      "[[joint]]\nname = \"mortar\"\nbetween = [\"brick\", \"floor\"]\n";
  const BuiltScene built = build(wall);
  const auto& joints = built.world.report().joints;
  CHECK(joints.size() == 2 * 2 + 5 + 3);  // in the courses, between them, and on the floor
  CHECK(joints.front().name == "mortar");
  build(wall + "gap = 0.0001\n");  // the floor is near enough
  const Reading none = read(
      "[[body]]\nname = \"a\"\nkind = \"box\"\nsize = 1\nposition = [0, 1, 0]\n[[body]]\nname = \"b\"\n"
      "kind = \"box\"\nsize = 1\nposition = [0, 3, 0]\n[[joint]]\nbetween = [\"a\", \"b\"]\n");
  REQUIRE(none.scene.has_value());
  Problems problems;
  CHECK(!build_world(*none.scene, problems).has_value());
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].message.find("look against each other") != std::string::npos);
}

TEST_CASE("points join copies by their numbers, and a row of copies each to the next") {
  const std::string beads =
      "[[body]]\nname = \"bead\"\nkind = \"sphere\"\nradius = 0.04\nposition = [0, 2, 0]\n"
      "repeat = {count = 4, spacing = [0.1, 0, 0]}\n"
      "[[body]]\nname = \"hook\"\nkind = \"box\"\nsize = 0.1\nmotion = \"static\"\nposition = [-0.1, 2, 0]\n"
      "[[joint]]\nname = \"chain\"\nkind = \"point\"\nbetween = [\"bead\"]\nstrength = 1e9\n"
      "[[joint]]\nname = \"top\"\nkind = \"point\"\nbetween = [\"hook\", \"bead[1]\"]\nat = [-0.05, 2, 0]\n"
      "strength = 1e9\n";
  BuiltScene built = build(beads);
  const auto& joints = built.world.report().joints;
  REQUIRE(joints.size() == 4);
  for (int i = 0; i < 3; ++i) {
    CHECK(joints[static_cast<std::size_t>(i)].body_a == "bead[" + std::to_string(i + 1) + "]");
    CHECK(joints[static_cast<std::size_t>(i)].body_b == "bead[" + std::to_string(i + 2) + "]");
  }
  CHECK(joints[3].body_a == "bead[1]");
  CHECK(joints[3].body_b == "hook");
  // The chain hangs: it swings down about its hook, no longer than it was.
  for (int i = 0; i < 60; ++i) built.world.step();
  for (const body::Body& body : built.world.bodies())
    if (body.name == "bead[4]") CHECK((body.pose.translation - Vec3(-0.05, 2.0, 0.0)).norm() < 0.3501);
}

TEST_CASE("a scene beyond what the engine bears says so at load") {
  const auto notes = [](const std::string& text) {
    const Reading reading = read(text);
    REQUIRE(reading.scene.has_value());
    Problems problems;
    const auto built = build_world(*reading.scene, problems);
    REQUIRE(built);
    std::string all;
    for (const std::string& note : built->plan.notes) all += note + "\n";
    return all;
  };
  const std::string box = "[[body]]\nname = \"crate\"\nkind = \"box\"\nsize = 0.2\ndensity = 2500\n";
  const std::string heavy =
      "[[body]]\nname = \"block\"\nkind = \"box\"\nsize = 0.2\nposition = [1, 0, 0]\ndensity = ";
  CHECK(notes(box) == "");
  CHECK(notes(box + heavy + "2.0e7\n") == "");
  const std::string apart = notes(box + heavy + "2.6e7\n");
  INFO(apart);
  CHECK(apart.find("\"block\" has 1e+04 times the mass of \"crate\"") != std::string::npos);
  CHECK(notes("[scene]\ngravity = [0, -300, 0]\n" + box) == "");
  const std::string strong = notes("[scene]\ngravity = [0, -9810, 0]\n" + box);
  INFO(strong);
  CHECK(strong.find("\"crate\", 0.35 m in size, falls by 0.085 m in a step") != std::string::npos);
  CHECK(strong.find("at least 842 steps a second") != std::string::npos);
  const std::string rubber =
      "[[material]]\nname = \"rubber\"\nlike = \"plaster\"\npoisson = 0.49\n[[body]]\nname = \"block\"\nkind "
      "= "
      "\"solid\"\nshape = \"slab\"\nsize = [0.1, 0.1, 0.1]\nmaterial = \"rubber\"\nposition = [0, 1, 0]\n";
  CHECK(notes(rubber).find("\"block\" has Poisson's ratio 0.49: its stress is solved with 0.4") !=
        std::string::npos);
  const auto balls = [](const char* kind) {
    return "[[material]]\nname = \"billiard\"\nlike = \"glass\"\nrestitution = 1\n[[body]]\nradius = "
           "0.1\nmaterial = "
           "\"billiard\"\nrepeat = {count = 3, spacing = [1, 0, 0]}\n" +
           std::string(kind);
  };
  const std::string slow = "[scene]\nsteps_per_second = 60\n";
  CHECK(notes(slow + balls("kind = \"shell\"\nshape = \"sphere\"\n"))
            .find("3 shells and solids bounce with a restitution of 0.9 or more") != std::string::npos);
  CHECK(notes(slow + balls("kind = \"sphere\"\n")) == "");
  CHECK(notes(balls("kind = \"shell\"\nshape = \"sphere\"\n")) == "");
  const auto pane = [](double size) {
    return "[[body]]\nname = \"door\"\nkind = \"shell\"\nshape = \"pane\"\nmaterial = "
           "\"tempered_glass\"\nwidth = " +
           std::to_string(size) + "\nheight = " + std::to_string(size) + "\n";
  };
  CHECK(notes(pane(0.25)) == "");
  const std::string door = notes(pane(1.0));
  INFO(door);
  CHECK(door.find("\"door\" would break into about 2.2e+04 dice of 45 mm2") != std::string::npos);
}

TEST_CASE("whoever watches is told what is being made") {
  const std::vector<std::string> told = watched(
      "[[body]]\nname = \"floor\"\nkind = \"plane\"\n[[body]]\nname = \"block\"\nkind = \"solid\"\nshape = "
      "\"slab\"\nsize = [0.2, 0.2, 0.2]\nelement_size = 0.1\nposition = [0, 1, 0]\n");
  REQUIRE(told.size() == 2);
  CHECK(told[0] == "0 making \"floor\"");
  CHECK(told[1] == "1 dividing \"block\" into tetrahedra");
}
