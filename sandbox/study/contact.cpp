#include "sandbox/study/contact.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "engine/audit/audit.h"
#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/generators.h"
#include "sandbox/study/contact_scene.h"
#include "sandbox/study/small_world.h"
#include "sandbox/study/stopwatch.h"
#include "sandbox/study/telling.h"

namespace shatterbox::sandbox::study {

namespace contact_parts {
namespace {

constexpr double kGravity = 9.81;  // m/s2
const int kDefaultSubsteps = dynamics::ContactSettings{}.substeps;
const int kUsualRate = world::WorldSettings{}.steps_per_second;

/// What is varied.
struct Grain {
  int rate = kUsualRate;            // steps a second
  int substeps = kDefaultSubsteps;  // a step
};

// ---- a stack

constexpr double kSide = 0.2;  // m

/// `count` boxes on a floor, the highest `ratio` times as heavy as the others. After a second, over a second:
/// how far the impulse at every level is from the weight above it, how far the top sank, how far anything
/// moved.
Measured stand(const Grain& grain, int count, double ratio) {
  world::World world((world::WorldSettings()));
  add_material(world, plain_material(0.5, 0.0));
  add_body(world, floor_description());
  const double gap = 2.0 * 5e-4 * 0.5 * kSide * std::sqrt(3.0);  // that is kept
  for (int k = 0; k < count; ++k) {
    auto box =
        box_description(Vec3::Constant(0.5 * kSide), Vec3(0.0, (k + 0.5) * kSide + (k + 1) * gap, 0.0));
    if (k + 1 == count) box.density = 2500.0 * ratio;
    add_body(world, box);
  }
  ContactScene scene(world, 1.0 / grain.rate, grain.substeps);
  const double top = scene.bodies.back().pose.translation.y();
  for (int i = 0; i < grain.rate; ++i) scene.step();
  std::vector<double> carried(static_cast<std::size_t>(count), 0.0);
  const std::vector<body::Body> before = scene.bodies;
  double moved = 0.0;
  long cut = 0;
  for (int i = 0; i < grain.rate; ++i) {
    scene.step();
    cut += scene.report.failsafe_steps;
    for (const body::LoggedImpulse& entry : scene.log) {  // ids are 1 for the floor, 2 for the lowest, ...
      const auto [low, high] = std::minmax(entry.body_a, entry.body_b);
      if (low == 0) continue;  // the failsafe's
      const double up = high == entry.body_a ? entry.impulse_world.y() : -entry.impulse_world.y();
      for (auto k = low; k < high; ++k) carried[k - 1] += up;
    }
  }
  for (std::size_t i = 0; i < before.size(); ++i)
    moved = std::max(moved, (scene.bodies[i].pose.translation - before[i].pose.translation).norm());
  double above = 0.0, weight_error = 0.0;
  for (std::size_t k = carried.size(); k-- > 0;) {
    above += scene.bodies[k + 1].shape->mass * kGravity;
    weight_error = std::max(weight_error, std::abs(carried[k] / above - 1.0));
  }
  return {{weight_error, (top - scene.bodies.back().pose.translation.y()) / kSide, moved / kSide},
          scene.seconds,
          cut > 0 ? fmt::format("the failsafe cut {} body-steps short", cut) : ""};
}

// ---- balls

/// Walls of a room `side` wide about the axis y, and its floor; a lid if it is closed.
void add_room(world::World& world, double side, bool is_closed) {
  add_body(world, floor_description());
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0, -1, 0)}) {
    if (normal.y() != 0.0 && !is_closed) continue;
    auto wall = floor_description();
    wall.pose.rotation = Quat::FromTwoVectors(Vec3::UnitY(), normal);
    wall.pose.translation = normal.y() != 0.0 ? Vec3(0.0, side, 0.0) : Vec3(-0.5 * side * normal);
    add_body(world, wall);
  }
}

constexpr double kRadius = 0.05;  // m

/// How deep balls are in each other and in the planes, m; 0 if they are not.
double deepest(const std::vector<body::Body>& bodies) {
  double depth = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const body::Body &a = bodies[i], &b = bodies[j];
      if (!a.is_dynamic()) continue;
      const Vec3 apart = a.pose.translation - b.pose.translation;
      const double gap = b.is_dynamic() ? apart.norm() - 2.0 * kRadius
                                        : (b.pose.rotation * Vec3::UnitY()).dot(apart) - kRadius;
      depth = std::max(depth, -gap);
    }
  return depth;
}

/// n^3 balls fall into a heap between walls for `length` seconds.
Measured heap(const Grain& grain, int n, double length) {
  world::World world((world::WorldSettings()));
  add_material(world, plain_material(0.5, 0.2));
  add_room(world, 2.2 * kRadius * n + 0.02, false);
  core::Random random(5, 0);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        Vec3 place(i - 0.5 * (n - 1), k + 0.6, j - 0.5 * (n - 1));
        place *= 2.2 * kRadius;
        for (int axis = 0; axis < 3; ++axis) place[axis] += random.uniform(-0.04, 0.04) * kRadius;
        add_body(world, ball_description(kRadius, place));
      }
  ContactScene scene(world, 1.0 / grain.rate, grain.substeps);
  const double start = scene.energy(), weight = scene.mass() * kGravity;
  double rise = 0.0, unexplained = 0.0, depth = 0.0, last = start;
  const long steps = std::lround(length * grain.rate);
  for (long i = 0; i < steps; ++i) {
    scene.step();
    const double now = scene.energy();
    rise = std::max(rise, now - last);
    last = now;
    unexplained = std::max(unexplained, scene.unexplained_momentum());
    depth = std::max(depth, deepest(scene.bodies));
  }
  return {{rise / start, unexplained * grain.rate / weight, depth / kRadius, scene.kinetic_energy() / start},
          scene.seconds,
          scene.report.failsafe_steps > 0 ? "the failsafe acted in the last step" : ""};
}

/// Balls of restitution 1 without friction in a closed room without gravity.
Measured elastic(const Grain& grain, int n, double length) {
  world::WorldSettings settings;
  settings.gravity.setZero();
  world::World world(settings);
  add_material(world, plain_material(0.0, 1.0));
  const double side = 5.0 * kRadius * n;
  add_room(world, side, true);
  core::Random random(7, 0);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        auto ball =
            ball_description(kRadius, 5.0 * kRadius * Vec3(i - 0.5 * (n - 1), k + 0.5, j - 0.5 * (n - 1)));
        for (int axis = 0; axis < 3; ++axis) ball.velocity[axis] = random.uniform(-2.0, 2.0);
        add_body(world, ball);
      }
  ContactScene scene(world, 1.0 / grain.rate, grain.substeps);
  const double start = scene.kinetic_energy();
  double worst = 0.0, depth = 0.0, unexplained = 0.0;
  long collisions = 0;
  const long steps = std::lround(length * grain.rate);
  for (long i = 0; i < steps; ++i) {
    scene.step();
    collisions += static_cast<long>(scene.log.size());
    worst = std::max(worst, std::abs(scene.kinetic_energy() / start - 1.0));
    depth = std::max(depth, deepest(scene.bodies));
    unexplained = std::max(unexplained, scene.unexplained_momentum() / (scene.mass() * 2.0));
  }
  return {{worst, unexplained, depth / kRadius, static_cast<double>(collisions)}, scene.seconds, ""};
}

// ---- an arch

/// One voussoir: the part of a ring between two angles, `deep` along z.
geometry::TriangleMesh voussoir(double inner, double outer, double from, double to, double deep) {
  geometry::TriangleMesh mesh;
  for (const double z : {-0.5 * deep, 0.5 * deep})
    for (const auto& [radius, angle] : {std::pair{inner, from}, {outer, from}, {outer, to}, {inner, to}})
      mesh.positions.emplace_back(radius * core::cos(angle), radius * core::sin(angle), z);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                    {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  return mesh;
}

/// A half circle of dry voussoirs, `thickness` over its middle radius, on two fixed springers: how far its
/// crown came down in two seconds, over the radius. It stands if it is thicker than 0.1075 (Milankovitch
/// 1907).
Measured arch(const Grain& grain, double thickness) {
  world::WorldSettings settings;
  settings.steps_per_second = grain.rate;
  settings.has_sleep = false;
  world::World world(settings);
  add_material(world, plain_material(0.8, 0.0));
  const int stones = 16;
  const double radius = 1.0, inner = radius * (1.0 - 0.5 * thickness),
               outer = radius * (1.0 + 0.5 * thickness);
  const double deep = 0.3, joint = 1e-4;  // rad: drawn with its joints nearly closed
  const auto add_stone = [&](double from, double to, bool is_fixed) {
    world::BodyDescription stone;
    stone.name = "stone";
    world::SolidDescription solid;
    solid.mesh = voussoir(inner, outer, from + joint, to - joint, deep);
    solid.is_breakable = false;
    stone.form = std::move(solid);
    if (is_fixed) stone.motion = body::Motion::fixed;
    stone.pose.translation = Vec3(0.0, 1.0, 0.0);
    return add_body(world, stone);
  };
  const double part = core::kPi / stones;
  add_stone(-part, 0.0, true);
  add_stone(core::kPi, core::kPi + part, true);
  std::vector<body::BodyId> ids;
  for (int k = 0; k < stones; ++k) ids.push_back(add_stone(k * part, (k + 1) * part, false));
  const auto crown = [&] {
    double height = 0.0;
    for (const body::Body& body : world.bodies())
      if (body.id == ids[stones / 2] || body.id == ids[stones / 2 - 1])
        height += 0.5 * body.pose.translation.y();
    return height;
  };
  const double start = crown();
  Measured measured;
  measured.seconds = advance(world, 2.0);
  const double sunk = (start - crown()) / radius;
  const bool stands = sunk<0.02, should_stand = thickness> 0.1075;
  measured.errors = {sunk, stands == should_stand ? 0.0 : 1.0};
  measured.note = stands ? "stands" : "fell";
  return measured;
}

// ---- shells, and the paper's scheme

/// Boats that fall on each other rim against rim, under either scheme: what the audit finds.
Measured boats(int rate, world::ContactScheme scheme, double length) {
  world::WorldSettings settings;
  settings.steps_per_second = rate;
  settings.contact = scheme;
  settings.has_sleep = false;
  world::World world(settings);
  add_material(world, plain_material(0.4, 0.2));
  add_body(world, floor_description());
  geometry::Meshing meshing;
  meshing.edge_length = 0.09;
  const auto mesh = geometry::make_boat(geometry::BoatSizes{}, meshing);
  core::Random random(3, 0);
  for (int k = 0; k < 8; ++k) {
    world::BodyDescription boat;
    boat.name = "boat";
    boat.form = world::ShellDescription{mesh.value(), {}, 2e-3, {}, false};
    const double turn = random.uniform(-3.0, 3.0), tip = random.uniform(-1.0, 1.0);
    boat.pose.rotation =
        Quat(Eigen::AngleAxisd(turn, Vec3::UnitY())) * Quat(Eigen::AngleAxisd(tip, Vec3::UnitX()));
    boat.pose.translation = Vec3(0.1 * (k % 2), 0.9 + 0.9 * k, 0.05 * (k % 3));
    add_body(world, boat);
  }
  world.keep_ways();
  audit::Audit audit;
  Measured measured;
  measured.seconds = 0.0;
  const long steps = steps_in(world, length);
  for (long i = 0; i < steps; ++i) {
    audit.begin_step(world.bodies());
    const Stopwatch watch;
    world.step();
    measured.seconds += watch.seconds();
    audit.end_step(world.bodies(), {}, world.ways(), world.time());
  }
  const auto& report = world.report();
  double potential = 0.0;
  for (const body::Body& body : world.bodies())
    if (body.is_dynamic()) potential += body.shape->mass * kGravity * 4.0;
  measured.errors = {static_cast<double>(audit.report().crossings),
                     static_cast<double>(audit.report().passages),
                     report.conservation.greatest_energy_rise / potential, report.contact.drift,
                     100.0 * report.contact.frozen_share};
  return measured;
}

// ---- tables

Table make_table(const char* name, const char* what, std::vector<std::string> errors, const char* setting,
                 const char* value) {
  Table table;
  table.name = name;
  table.what = what;
  table.error_names = std::move(errors);
  table.setting_name = setting;
  table.value_name = value;
  return table;
}

/// A table over rates and one over substeps of the same case.
void add_both(Plan& plan, const std::string& name, const char* what, const std::vector<std::string>& errors,
              const std::function<Measured(const Grain&)>& measure, bool is_quick) {
  add_rates(plan, rate_table(name + "-steps", what, errors),
            is_quick ? std::vector<int>{120, 240, 480} : std::vector<int>{60, 120, 240, 480, 960},
            [measure](int rate) {
              return measure({rate, kDefaultSubsteps});
            });
  Table substeps = make_table("", what, errors, "substeps a step", "substep, of a step");
  substeps.name = name + "-substeps";
  const std::vector<int> counts =
      is_quick ? std::vector<int>{4, 8, 16} : std::vector<int>{1, 2, 4, 8, 16, 32};
  for (const int count : counts)
    plan.jobs.push_back(
        {plan.tables.size(), std::to_string(count), 1.0 / count, count == kDefaultSubsteps, [measure, count] {
           return measure({kUsualRate, count});
         }});
  plan.tables.push_back(substeps);
}

void add_boats(Plan& plan, bool is_quick) {
  const std::vector<std::string> errors{"crossings", "passages", "energy rise", "drift, m", "cut short, %"};
  for (const bool is_paper : {false, true}) {
    Table table = rate_table(is_paper ? "boats-paper" : "boats",
                             is_paper ? "the same with the paper's contact scheme"
                                      : "eight boats, shells without thickness, fall on each other",
                             errors);
    table.value_name.clear();
    table.is_relative = false;
    table.is_plotted = false;
    add_rates(plan, table, is_quick ? std::vector<int>{60} : std::vector<int>{60, 240},
              [is_paper, is_quick](int rate) {
                return boats(rate, is_paper ? world::ContactScheme::paper : world::ContactScheme::standard,
                             is_quick ? 0.6 : 2.5);
              });
  }
}

std::vector<std::string> conclude(const std::vector<Table>& tables) {
  std::vector<std::string> sentences;
  std::map<std::string, const Table*> by_name;
  for (const Table& table : tables)
    if (!table.rows.empty()) by_name[table.name] = &table;
  const auto sum = [](const Table& table, std::size_t error) {
    double total = 0.0;
    for (const Row& row : table.rows) total += row.errors[error];
    return total;
  };
  if (by_name.count("boats") != 0 && by_name.count("boats-paper") != 0) {
    const Table &ours = *by_name["boats"], &paper = *by_name["boats-paper"];
    sentences.push_back(
        fmt::format("Over all step sizes our boats had {:.0f} crossings and {:.0f} passages, the paper's "
                    "scheme {:.0f} and {:.0f}; its "
                    "surfaces drifted by up to {:.2g} m from their bodies.",
                    sum(ours, 0), sum(ours, 1), sum(paper, 0), sum(paper, 1), paper.rows.back().errors[3]));
  }
  if (by_name.count("arch") != 0) {
    const Table& table = *by_name["arch"];
    std::string wrong;
    for (const Row& row : table.rows)
      if (row.errors[1] != 0.0) wrong += (wrong.empty() ? "" : ", ") + row.setting;
    sentences.push_back(wrong.empty()
                            ? "Every arch stands or falls as Milankovitch's 0.1075 says."
                            : "Arches that did not do as Milankovitch's 0.1075 says: " + wrong + ".");
  }
  return sentences;
}

Plan make_contact_plan(bool is_quick) {
  Plan plan;
  const int count = is_quick ? 4 : 10;
  Table ratios =
      make_table("stack",
                 "ten boxes, the highest many times as heavy, after a second: the weight that each "
                 "level carries",
                 {"weight", "sunk, of a box", "moved in a second, of a box"}, "times the others' mass", "");
  for (const double ratio :
       is_quick ? std::vector<double>{1.0, 10.0} : std::vector<double>{1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6})
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", ratio), kNoNumber, ratio == 1.0,
                         [count, ratio] { return stand({}, count, ratio); }});
  plan.tables.push_back(std::move(ratios));
  add_both(
      plan, "stack",
      is_quick ? "four boxes, the highest ten times as heavy"
               : "ten boxes, the highest a hundred times as heavy",
      {"weight", "sunk, of a box", "moved in a second, of a box"},
      [count, ratio = is_quick ? 10.0 : 100.0](const Grain& grain) { return stand(grain, count, ratio); },
      is_quick);
  const int n = is_quick ? 3 : 6;
  add_both(
      plan, "heap", is_quick ? "27 balls fall into a heap" : "216 balls fall into a heap",
      {"energy rise in a step", "momentum, of the weight", "overlap, of a radius", "kinetic energy left"},
      [n, is_quick](const Grain& grain) { return heap(grain, n, is_quick ? 0.5 : 2.0); }, is_quick);
  add_both(
      plan, "gas", is_quick ? "8 elastic balls in a closed room" : "64 elastic balls in a closed room",
      {"energy", "momentum", "overlap, of a radius", "collisions"},
      [is_quick](const Grain& grain) { return elastic(grain, is_quick ? 2 : 4, is_quick ? 1.0 : 5.0); },
      is_quick);
  Table arches =
      make_table("arch", "a half circle of 16 dry stones stands if it is thicker than 0.1075 of its radius",
                 {"crown sunk, of the radius", "wrong verdict"}, "of the radius thick", "");
  arches.is_relative = false;
  arches.is_plotted = false;
  for (const double thickness :
       is_quick ? std::vector<double>{0.09, 0.13}
                : std::vector<double>{0.08, 0.09, 0.1, 0.105, 0.11, 0.115, 0.12, 0.14, 0.2})
    plan.jobs.push_back({plan.tables.size(), fmt::format("{:g}", thickness), kNoNumber, false,
                         [thickness] { return arch({}, thickness); }});
  plan.tables.push_back(std::move(arches));
  add_boats(plan, is_quick);
  plan.conclude = conclude;
  return plan;
}

}  // namespace
}  // namespace contact_parts

Study contact_study() {
  return {"contact",
          "stacks, heaps, an elastic gas, an arch, boats: iterations and step, ours beside the paper's",
          contact_parts::make_contact_plan};
}

}  // namespace shatterbox::sandbox::study
