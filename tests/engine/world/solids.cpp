// Solids as bodies: the inside of a closed mesh has mass, its surface meets others.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/audit/audit.h"
#include "engine/core/parallel.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"
#include "engine/world/world.h"
#include "tests/engine/world/audited.h"
#include "tests/support/sanitized.h"
#include "tests/support/untrapped.h"

using namespace shatterbox;

namespace {

world::BodyDescription make_slab(const Vec3& half_extent, const Vec3& offset) {
  world::BodyDescription body;
  body.name = "slab";
  world::SolidDescription solid;
  solid.is_breakable = false;
  solid.mesh = geometry::make_box_surface(half_extent);
  for (Vec3& p : solid.mesh.positions) p += offset;
  body.form = solid;
  return body;
}

}  // namespace

TEST_CASE("a solid has the mass of its inside, about its centre of mass") {
  world::World w{world::WorldSettings{}};
  material::Material material;
  material.density = 1800.0;
  REQUIRE(w.add_material(material).ok());
  const Vec3 half(0.3, 0.1, 0.2), offset(1.0, -2.0, 0.5);
  world::BodyDescription slab = make_slab(half, offset);
  slab.pose.translation = Vec3(5.0, 6.0, 7.0);
  REQUIRE(w.add_body(slab).ok());
  const body::Body& body = w.bodies()[0];
  const auto expected = geometry::box_mass_properties(half, 1800.0);
  CHECK(body.shape->mass == Approx(expected.mass).epsilon(1e-13));
  CHECK((body.shape->inertia - expected.inertia).norm() < 1e-12 * expected.inertia.norm());
  CHECK((body.pose.translation - Vec3(6.0, 4.0, 7.5)).norm() < 1e-13);
}

TEST_CASE("solids tumble onto each other and come to rest, as boxes do") {
  world::WorldSettings settings;
  world::World w(settings);
  REQUIRE(w.add_material(*material::find_preset("ceramic")).ok());
  world::BodyDescription ground;
  ground.form = world::PlaneDescription{};
  REQUIRE(w.add_body(ground).ok());
  for (int i = 0; i < 4; ++i) {
    world::BodyDescription slab = make_slab(Vec3(0.15, 0.05, 0.1), Vec3::Zero());
    slab.pose.translation = Vec3(0.02 * i, 0.2 + 0.3 * i, 0.01 * i);
    slab.pose.rotation = Quat(Eigen::AngleAxisd(0.3 + 0.1 * i, Vec3(1, 2, 3).normalized()));
    REQUIRE(w.add_body(slab).ok());
  }
  w.keep_ways();
  audit::Audit audit;
  for (int step = 0; step < 720; ++step) {
    audit.begin_step(w.bodies());
    w.step();
    audit.end_step(w.bodies(), {}, w.ways(), w.time());
  }
  CHECK(audit.report().crossings == 0);
  CHECK(audit.report().passages == 0);
  const double energy = 4 * w.bodies()[1].shape->mass * 9.81 * 0.65;
  CHECK(w.report().conservation.greatest_energy_rise < 1e-3 * energy);
  for (const body::Body& body : w.bodies()) CHECK((!body.is_dynamic() || !body.is_awake));
  for (const body::Body& body : w.bodies())
    for (const Vec3& p : body.shape->surface.positions) CHECK(body.pose.apply(p).y() > 0.0);
}

TEST_CASE("a solid that is open, flat or inside out is refused in words") {
  world::World w{world::WorldSettings{}};
  REQUIRE(w.add_material(material::Material{}).ok());
  const auto refusal = [&](const auto& change) {
    world::BodyDescription body = make_slab(Vec3(0.1, 0.1, 0.1), Vec3::Zero());
    change(std::get<world::SolidDescription>(body.form).mesh);
    const auto id = w.add_body(body);
    REQUIRE(!id.ok());
    return id.error();
  };
  using geometry::TriangleMesh;
  CHECK(refusal([](TriangleMesh& m) { m.triangles.pop_back(); }).find("closed") != std::string::npos);
  CHECK(refusal([](TriangleMesh& m) {
          for (auto& t : m.triangles) std::swap(t[0], t[1]);
        }).find("inside out") != std::string::npos);
  CHECK(refusal([](TriangleMesh& m) {
          for (Vec3& p : m.positions) p.y() = 0.0;
        }).find("flat") != std::string::npos);
}

namespace {

constexpr double kBroken = 0.013;  // s after it has met the floor: it has broken, and its pieces move

/// What falls on its corner, of plaster.
struct Dropped {
  Vec3 half_extent;     // m
  double element_size;  // m
  int grading = 1;
};
constexpr double kLong = test::kIsSanitized ? kBroken : 0.1;

/// From that height, m; `after` it has met the floor, s.
world::World drop(const Dropped& dropped, double height, double grain_size = 0.0, double after = kLong,
                  const world::WorldSettings& settings = {}) {
  world::World w{settings};
  material::Material plaster = *material::find_preset("plaster");
  plaster.grain_size = grain_size;
  REQUIRE(w.add_material(plaster).ok());
  world::BodyDescription ground;
  ground.name = "floor";
  ground.form = world::PlaneDescription{};
  REQUIRE(w.add_body(ground).ok());
  world::BodyDescription slab = make_slab(dropped.half_extent, Vec3(0.7, 0.0, 0.0));
  auto& solid = std::get<world::SolidDescription>(slab.form);
  solid.is_breakable = true;
  solid.element_size = dropped.element_size;
  solid.grading = dropped.grading;
  slab.pose.rotation = Quat(Eigen::AngleAxisd(0.5, Vec3(1.0, 0.2, 1.2).normalized()));
  double lowest = 1e9;
  for (const Vec3& p : solid.mesh.positions) lowest = std::min(lowest, slab.pose.apply(p).y());
  slab.pose.translation = Vec3(0.0, height - lowest, 0.0);
  REQUIRE(w.add_body(slab).ok());
  const double fall = std::sqrt(2.0 * height / 9.81);
  while (w.time() < fall + after) w.step();
  return w;
}

world::World drop_slab(double height, double grain_size = 0.0, double after = kLong,
                       const world::WorldSettings& settings = {}) {
  return drop({Vec3(0.3, 0.03, 0.2), 0.05}, height, grain_size, after, settings);
}

void check_conserved(const world::World& w) {
  for (const world::BreakRow& row : w.report().breaks) {
    CHECK(row.mass_error < 1e-10);
    CHECK(row.momentum_error < 1e-10);
    CHECK(row.angular_momentum_error < 1e-10);
    CHECK(row.energy_gain < 1e-10);
    CHECK(row.fracture_energy <= row.elastic_energy);
  }
}

}  // namespace

TEST_CASE("a solid that falls breaks into pieces of its mass and motion, and holds if it falls less far") {
  const world::World held = drop_slab(0.02);
  CHECK(held.report().breaks.empty());
  CHECK(held.bodies().size() == 2);
  REQUIRE_FALSE(held.report().impacts.empty());
  CHECK(held.report().impacts[0].ratio < 1.0);

  const world::World broken = drop_slab(1.5);
  REQUIRE_FALSE(broken.report().breaks.empty());
  const world::BreakRow& first = broken.report().breaks[0];
  CHECK(first.pieces >= 2);
  CHECK(first.new_area > 0.06 * 0.2);
  check_conserved(broken);
  double mass = 0.0;
  for (const body::Body& body : broken.bodies()) {
    mass += body.shape->mass;
    if (body.shape->kind != body::ShapeKind::solid) continue;
    CHECK(body.is_dynamic());
    CHECK(geometry::enclosed_volume(body.shape->surface) > 0.0);
    CHECK(body.shape->crack_faces.size() == body.shape->surface.triangles.size());
  }
  CHECK(mass == Approx(0.6 * 0.06 * 0.4 * material::find_preset("plaster")->density).epsilon(1e-10));
  CHECK(count_overlaps(first) == 0);
}

TEST_CASE("a solid whose elements are larger inside tells an impact as one of even ones, and breaks whole") {
  const auto drop_block = [](int grading, double height) {
    return drop({Vec3(0.2, 0.17, 0.18), test::kIsSanitized ? 0.034 : 0.022, grading}, height, 0.0, 0.01);
  };
  const auto tetrahedra_of = [](const world::World& w) {
    for (const world::PartCount& part : w.inventory())
      if (part.part == "tetrahedra") return part.bytes;
    return 0.0;
  };
  if (!test::kIsSanitized) {
    const world::World even = drop_block(1, 0.01), graded = drop_block(2, 0.01);
    REQUIRE_FALSE(even.report().impacts.empty());
    REQUIRE_FALSE(graded.report().impacts.empty());
    CHECK(tetrahedra_of(graded) < 0.85 * tetrahedra_of(even));
    const world::ImpactRow &a = even.report().impacts[0], &b = graded.report().impacts[0];
    CHECK(b.stress == Approx(a.stress).epsilon(0.05));
    CHECK(b.duration == Approx(a.duration).epsilon(0.01));
  }

  const world::World broken = drop_block(2, 1.5);
  REQUIRE_FALSE(broken.report().breaks.empty());
  CHECK(broken.report().breaks[0].pieces >= 2);
  check_conserved(broken);
  for (const world::BreakRow& row : broken.report().breaks) CHECK(count_overlaps(row) == 0);
  for (const body::Body& body : broken.bodies())
    if (body.shape->kind == body::ShapeKind::solid)
      CHECK(geometry::enclosed_volume(body.shape->surface) > 0.0);
}

TEST_CASE("what breaks is followed in parts in which it goes a fifth of its size") {
  // Parts of the step in which a plaster slab of .72 m and one of a sixtieth of its size break.
  const auto parts_at = [](double share, double speed) {
    world::WorldSettings settings;
    settings.gravity = Vec3::Zero();
    world::World w{settings};
    REQUIRE(w.add_material(*material::find_preset("plaster")).ok());
    world::BodyDescription ground;
    ground.form = world::PlaneDescription{};
    REQUIRE(w.add_body(ground).ok());
    world::BodyDescription slab = make_slab(share * Vec3(0.3, 0.03, 0.2), Vec3(0.7, 0.0, 0.0));
    auto& solid = std::get<world::SolidDescription>(slab.form);
    solid.is_breakable = true;
    solid.element_size = share * 0.05;
    slab.pose.translation = Vec3(0.0, share * 0.4, 0.0);
    slab.velocity = Vec3(0.0, -speed, 0.0);
    REQUIRE(w.add_body(slab).ok());
    int parts = 0;  // once it has broken; no more is asked of the step
    w.watch([&parts](const world::Moment& moment) {
      if (moment.pass > 1) parts = moment.parts;
    });
    w.set_stop([&parts] { return parts > 0; });
    while (parts == 0 && w.time() < 0.1) w.step();
    return parts;
  };
  CHECK(parts_at(1.0, 6.0) == 4);
  const double size = 2.0 * Vec3(0.3, 0.03, 0.2).norm() / 60.0;
  const double ways = 15.0 / 240.0 / (0.2 * size);  // of a fifth of it in the step
  const int parts = parts_at(1.0 / 60.0, 15.0);
  CHECK(parts >= ways);
  CHECK(parts <= 512);
}

TEST_CASE("a solid with grains breaks along them, into pieces as whole as any") {
  const world::World broken = drop_slab(1.5, 0.12);
  REQUIRE_FALSE(broken.report().breaks.empty());
  const world::BreakRow& first = broken.report().breaks[0];
  CHECK(first.pieces >= 2);
  CHECK(first.grain_share > 0.1);
  CHECK(first.grain_share < 1.0);
  CHECK(count_overlaps(first) == 0);
  check_conserved(broken);
  for (const body::Body& body : broken.bodies()) {
    if (body.shape->kind != body::ShapeKind::solid) continue;
    CHECK(geometry::enclosed_volume(body.shape->surface) > 0.0);
  }
}

TEST_CASE("grains are drawn by the scene's seed, each body's own") {
  const auto bytes_of_grains = [](std::uint64_t seed, int copies) {
    world::WorldSettings settings;
    settings.seed = seed;
    world::World w{settings};
    material::Material plaster = *material::find_preset("plaster");
    plaster.grain_size = 0.05;
    REQUIRE(w.add_material(plaster).ok());
    world::BodyDescription slab = make_slab(Vec3(0.3, 0.03, 0.2), Vec3::Zero());
    auto& solid = std::get<world::SolidDescription>(slab.form);
    solid.is_breakable = true;
    solid.element_size = 0.05;
    for (int i = 0; i < copies; ++i) {
      slab.pose.translation.y() = i;
      REQUIRE(w.add_body(slab).ok());
    }
    for (const world::PartCount& part : w.inventory())
      if (part.part == "grains") return std::pair(part.count, part.bytes);
    return std::pair(0L, 0.0);
  };
  const auto one = bytes_of_grains(1, 1);
  CHECK(one.first == 1);
  CHECK(bytes_of_grains(1, 1) == one);
  CHECK(bytes_of_grains(2, 1).second != one.second);
  const auto two = bytes_of_grains(1, 2);
  CHECK(two.first == 2);
  CHECK(two.second != 2.0 * one.second);
}

TEST_CASE("an impact whose stress has no answer is told of, and nothing breaks by it") {
  const test::Untrapped untrapped;
  world::WorldSettings settings;
  settings.solve_residual = std::nan("");  // which no residual is below
  const world::World w = drop_slab(1.5, 0.0, 0.005, settings);
  CHECK(w.report().breaks.empty());
  REQUIRE_FALSE(w.report().impacts.empty());
  CHECK(w.report().impacts[0].verdict.starts_with("not evaluated: the solve did not settle"));
}

TEST_CASE("more grains than a body can have are refused in words") {
  world::World w{world::WorldSettings{}};
  material::Material plaster = *material::find_preset("plaster");
  plaster.grain_size = 1e-3;
  REQUIRE(w.add_material(plaster).ok());
  world::BodyDescription slab = make_slab(Vec3(0.3, 0.03, 0.2), Vec3::Zero());
  std::get<world::SolidDescription>(slab.form).is_breakable = true;
  const auto id = w.add_body(slab);
  REQUIRE_FALSE(id.ok());
  CHECK(id.error().find("grain_size of 0.001 m") != std::string::npos);
  CHECK(id.error().find("or more") != std::string::npos);
  world::BodyDescription sheet;
  world::ShellDescription shell;
  shell.mesh = geometry::make_sphere(0.1, {0.03, 0.0, 1}).value();
  sheet.form = shell;
  CHECK(w.add_body(sheet).error().find("grain_size of 0.001 m makes some 1.2") != std::string::npos);
}

TEST_CASE("solids: a break has the same bits for any number of threads") {
  if (test::kIsSanitized) return;  // the break is that of the test above; who shares its work is tsan's
  const auto hash = [](int threads, double grain_size) {
    core::set_thread_count(threads);
    const world::World w = drop_slab(1.0, grain_size, kBroken);
    core::set_thread_count(0);
    REQUIRE_FALSE(w.report().breaks.empty());
    return w.state_hash();
  };
  CHECK(hash(1, 0.0) == hash(3, 0.0));
  CHECK(hash(1, 0.1) == hash(3, 0.1));
}

TEST_CASE("a solid on its foot keeps what holds on to it when it is hit") {
  world::World w{world::WorldSettings{}};
  REQUIRE(w.add_material(*material::find_preset("plaster")).ok());
  REQUIRE(w.add_material(*material::find_preset("steel")).ok());
  world::BodyDescription wall = make_slab(Vec3(0.4, 0.3, 0.03), Vec3::Zero());
  auto& solid = std::get<world::SolidDescription>(wall.form);
  solid.is_breakable = true;
  solid.element_size = 0.05;
  solid.held = {{Vec3::UnitY(), -0.28}};
  REQUIRE(w.add_body(wall).ok());
  REQUIRE_FALSE(w.bodies()[0].is_dynamic());
  world::BodyDescription ball;
  ball.name = "ball";
  ball.form = world::SphereDescription{0.05};
  ball.material = 1;
  ball.pose.translation = Vec3(0.02, 0.05, 0.2);
  ball.velocity = Vec3(0.0, 0.0, -20.0);
  REQUIRE(w.add_body(ball).ok());
  for (long step = 0; step < test::how_many(24, 4); ++step) w.step();
  REQUIRE_FALSE(w.report().breaks.empty());
  int held = 0, loose = 0;
  for (const body::Body& body : w.bodies()) {
    if (body.shape->kind != body::ShapeKind::solid) continue;
    double lowest = 1e9;
    for (const Vec3& p : body.shape->surface.positions)
      lowest = std::min(lowest, (p + body.shape->material_from_body).y());
    if (body.is_dynamic())
      ++loose;
    else
      ++held;
    // Who is held has some of the foot.
    if (!body.is_dynamic()) CHECK(lowest < -0.25);
  }
  CHECK(held >= 1);
  CHECK(loose >= 2);
}

TEST_CASE("a support that holds nothing of a solid is told") {
  world::World w{world::WorldSettings{}};
  REQUIRE(w.add_material(*material::find_preset("plaster")).ok());
  world::BodyDescription wall = make_slab(Vec3(0.4, 0.3, 0.03), Vec3::Zero());
  auto& solid = std::get<world::SolidDescription>(wall.form);
  solid.is_breakable = true;
  solid.held = {{Vec3::UnitY(), -5.0}};
  const auto id = w.add_body(wall);
  REQUIRE(!id.ok());
  CHECK(id.error().find("support holds none") != std::string::npos);
}

TEST_CASE(
    "a stack of bricks that is thrown down at 50 m/s ends up as it may, but none passes through another") {
  // They turn in one step by up to four radians, some of them by more than their neighbours.
  for (const double down : {200.0, 400.0, 800.0}) {
    world::WorldSettings settings;
    settings.steps_per_second = 60;
    world::World w(settings);
    const int terracotta = w.add_material(*material::find_preset("terracotta")).value();
    world::BodyDescription floor;
    floor.form = world::PlaneDescription{};
    floor.material = terracotta;
    REQUIRE(w.add_body(floor).ok());
    std::vector<body::BodyId> bricks;
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 3; ++column) {
        world::BodyDescription brick;
        brick.form = world::BoxDescription{Vec3(0.05, 0.017, 0.025)};
        brick.material = terracotta;
        brick.pose.translation = Vec3(0.1003 * (column + 0.5 * (row % 2)), 0.01703 + 0.03403 * row, 0);
        bricks.push_back(w.add_body(brick).value());
      }
    }
    test::run_audited(w, 0.5);
    for (const body::BodyId id : bricks) {
      const body::Body& brick = *body::find_body(w.bodies(), id);
      REQUIRE(w.push_body(id, Vec3(5, -down, 46) / 12.0, brick.pose.translation));
    }
    const audit::AuditReport audit = test::run_audited(w, 1.0);
    INFO(down << " N s");
    CHECK(audit.crossings == 0);
    CHECK(audit.passages == 0);
  }
}

TEST_CASE("a box that another's face follows round for long is stopped all the same, at last") {
  struct Pile {
    const char* material;
    Vec3 size, first;
    int wide, high;
    Vec3 spacing, spin;
  };
  const std::vector<Pile> piles{{"terracotta",
                                 {0.04379, 0.08785, 0.06637},
                                 {-0.01277, 0.044, 0.01316},
                                 2,
                                 1,
                                 {0.04423, 0, 0},
                                 {0.636, 22.5, -1.81}},
                                {"ceramic",
                                 {0.0481, 0.07344, 0.07788},
                                 {-0.009008, 0.1257, -0.008822},
                                 2,
                                 1,
                                 {0.04858, 0, 0},
                                 {7.05e-05, 30.9, -0.254}},
                                {"steel",
                                 {0.06502, 0.09633, 0.06332},
                                 {0.009109, 0.2114, -0.005118},
                                 1,
                                 2,
                                 {0, 0.09729, 0},
                                 {20.1, 4.79, -0.0897}},
                                {"steel",
                                 {0.07942, 0.06408, 0.05122},
                                 {0.001167, 0.39, 0.01021},
                                 3,
                                 3,
                                 {0.08021, 0.06472, 0},
                                 {-0.54, -0.393, -46.9}}};
  world::WorldSettings settings;
  settings.steps_per_second = 60;
  world::World w(settings);
  world::BodyDescription floor;
  floor.form = world::PlaneDescription{};
  floor.material = w.add_material(*material::find_preset("ceramic")).value();
  REQUIRE(w.add_body(floor).ok());
  for (const Pile& pile : piles) {
    const int number = w.add_material(*material::find_preset(pile.material)).value();
    for (int y = 0; y < pile.high; ++y) {
      for (int x = 0; x < pile.wide; ++x) {
        world::BodyDescription box;
        box.form = world::BoxDescription{0.5 * pile.size};
        box.material = number;
        box.pose.translation = pile.first + Vec3(x * pile.spacing.x(), y * pile.spacing.y(), 0);
        box.angular_velocity = pile.spin;
        REQUIRE(w.add_body(box).ok());
      }
    }
  }
  const audit::AuditReport audit = test::run_audited(w, 0.15);
  CHECK(audit.crossings == 0);
  CHECK(audit.passages == 0);
}
