// Joints through the door: what opens them, and what they leave unchanged.
#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/audit/audit.h"
#include "engine/core/elementary.h"
#include "engine/world/joints.h"
#include "engine/world/world.h"

using namespace shatterbox;

namespace {

constexpr double kLength = 0.24, kHeight = 0.07, kWidth = 0.115, kDensity = 1800.0;

world::World make_world(int steps_per_second, bool has_sleep = true) {
  world::WorldSettings settings;
  settings.steps_per_second = steps_per_second;
  settings.has_sleep = has_sleep;
  return world::World(settings);
}

body::BodyId add_brick(world::World& world, int material, const Vec3& position, body::Motion motion) {
  world::BodyDescription brick;
  brick.name = "brick" + std::to_string(world.bodies().size());
  brick.form = world::BoxDescription{0.5 * Vec3(kLength, kHeight, kWidth)};
  brick.material = material;
  brick.density = kDensity;
  brick.motion = motion;
  brick.pose.translation = position;
  return world.add_body(brick).value();
}

world::JointDescription mortar(body::BodyId a, body::BodyId b, double strength) {
  world::JointDescription joint;
  joint.name = "mortar";
  joint.body_a = a;
  joint.body_b = b;
  joint.form = world::MortarDescription{1e-3};
  joint.strength = strength;
  joint.shear_strength = strength;
  return joint;
}

/// The greatest tension at the top of a joint that bears one brick sideways: M / W, Pa.
double weight_tension() {
  const double weight = kDensity * kLength * kHeight * kWidth * 9.81;
  const double modulus = kWidth * kHeight * kHeight / 6.0;
  return weight * 0.5 * (kLength + 5e-4) / modulus;
}

/// A brick that hangs sideways on one that is held, for a quarter of a second.
world::JointRow hang(int steps_per_second, double strength) {
  world::World world = make_world(steps_per_second, false);
  const int stone = world.add_material(*material::find_preset("brick")).value();
  const auto held = add_brick(world, stone, Vec3(0, 1, 0), body::Motion::fixed);
  const auto free = add_brick(world, stone, Vec3(kLength + 5e-4, 1, 0), body::Motion::dynamic);
  REQUIRE(world.add_joint(mortar(held, free, strength)).value() == 1);
  while (world.time() < 0.25) world.step();
  return world.report().joints.front();
}

}  // namespace

TEST_CASE("a brick that hangs on mortar bends it as a cantilever does and opens it beyond its strength") {
  const double tension = weight_tension();
  for (const int steps : {60, 240, 960}) {
    CAPTURE(steps);
    const world::JointRow held = hang(steps, 1.02 * tension);
    CAPTURE(held.verdict);
    CHECK(held.opened < 0.0);
    CHECK(held.tension == Approx(tension).epsilon(1e-3));
    CHECK(held.most_ratio == Approx(1.0 / 1.02).epsilon(1e-3));
    const world::JointRow opened = hang(steps, 0.98 * tension);
    CHECK(opened.opened > 0.0);
    CHECK(opened.opened < 0.02);
    CHECK(opened.verdict.rfind("opened", 0) == 0);
  }
}

TEST_CASE("mortar finds the area of faces that are near and none of others") {
  world::World world = make_world(240);
  const int stone = world.add_material(*material::find_preset("brick")).value();
  const auto a = add_brick(world, stone, Vec3(0, 1, 0), body::Motion::dynamic);
  const auto b =
      add_brick(world, stone, Vec3(0.5 * kLength, 1 + kHeight, 0.25 * kWidth), body::Motion::dynamic);
  const auto far = add_brick(world, stone, Vec3(0, 2, 0), body::Motion::dynamic);
  CHECK(world.add_joint(mortar(a, far, 1e6)).value() == 0);
  CHECK(world.add_joint(mortar(a, b, 1e6)).value() == 1);
  CHECK_FALSE(world.add_joint(mortar(a, a, 1e6)).ok());
  CHECK_FALSE(world.add_joint(mortar(a, b, 0.0)).ok());
  CHECK(world.report().joints.front().area == Approx(0.5 * kLength * 0.75 * kWidth));
  const auto face = world::find_mortar_area(world.bodies()[0], world.bodies()[1], 1e-3);
  CHECK(face.centre.isApprox(Vec3(0.25 * kLength, 1 + 0.5 * kHeight, 0.125 * kWidth)));
  CHECK(face.axes.col(0).isApprox(-Vec3::UnitY()));
  const double y = 0.5 * kLength, z = 0.75 * kWidth;
  CHECK(face.moments.x() == Approx(y * z * z * z / 12.0));
  CHECK(face.moments.y() == Approx(z * y * y * y / 12.0));
  CHECK(face.outline.size() == 4);
}

TEST_CASE("a hit on joined bricks loads their mortar alike at any step and keeps their momentum") {
  std::vector<double> ratios;
  for (const int steps : {120, 240, 960}) {
    world::World world = make_world(steps);
    world.set_gravity(Vec3::Zero());
    const int stone = world.add_material(*material::find_preset("brick")).value();
    const int steel = world.add_material(*material::find_preset("steel")).value();
    body::BodyId last = 0;
    for (int i = 0; i < 4; ++i) {
      const auto next = add_brick(world, stone, Vec3(i * (kLength + 5e-4), 1, 0), body::Motion::dynamic);
      if (last != 0) REQUIRE(world.add_joint(mortar(last, next, 1e9)).value() > 0);
      last = next;
    }
    world::BodyDescription ball;
    ball.name = "ball";
    ball.form = world::SphereDescription{0.03};
    ball.material = steel;
    ball.pose.translation = Vec3(0.4, 1.2, 0.0);
    ball.velocity = Vec3(0.0, -4.0, 0.0);
    REQUIRE(world.add_body(ball).ok());
    const double mass = world.bodies().back().shape->mass;
    while (world.time() < 0.1) world.step();
    Vec3 momentum = Vec3::Zero();
    for (const auto& b : world.bodies()) momentum += b.shape->mass * b.velocity;
    CHECK((momentum - mass * ball.velocity).norm() < 1e-12 * mass * ball.velocity.norm());
    CHECK(world.report().joints[1].is_struck);
    ratios.push_back(world.report().joints[1].most_ratio);
  }
  CAPTURE(ratios);
  CHECK(ratios[0] == Approx(ratios[2]).epsilon(0.01));
  CHECK(ratios[1] == Approx(ratios[2]).epsilon(0.01));
}

TEST_CASE("a blast loads mortar by its own duration though something arrives in the same step") {
  std::vector<double> ratios;
  for (const bool has_pellet : {false, true}) {
    world::World world = make_world(240);
    world.set_gravity(Vec3::Zero());
    const int stone = world.add_material(*material::find_preset("brick")).value();
    const auto held = add_brick(world, stone, Vec3(0, 1, 0), body::Motion::fixed);
    const auto free = add_brick(world, stone, Vec3(kLength + 5e-4, 1, 0), body::Motion::dynamic);
    REQUIRE(world.add_joint(mortar(held, free, 1e8)).value() == 1);
    if (has_pellet) {
      world::BodyDescription pellet;
      pellet.form = world::SphereDescription{0.002};
      pellet.material = stone;
      pellet.pose.translation = Vec3(kLength, 1.0 + 0.5 * kHeight + 0.004, 0);
      pellet.velocity = Vec3(0, -1.0, 0);
      REQUIRE(world.add_body(pellet).ok());
    }
    world.explode({Vec3(kLength, 1, 2), 1e5, 0.0});
    world.step();
    CHECK(world.report().joints.front().is_struck);
    ratios.push_back(world.report().joints.front().most_ratio);
  }
  CAPTURE(ratios);
  CHECK(ratios[0] > 1e-3);
  CHECK(ratios[1] == Approx(ratios[0]).epsilon(0.05));
}

TEST_CASE("a hit opens mortar about it and not all of it and bits repeat") {
  const auto run = [](std::uint64_t& hash) {
    world::World world = make_world(240);
    const int stone = world.add_material(*material::find_preset("brick")).value();
    const int steel = world.add_material(*material::find_preset("steel")).value();
    world::BodyDescription floor;
    floor.name = "floor";
    floor.form = world::PlaneDescription{};
    floor.material = stone;
    REQUIRE(world.add_body(floor).ok());
    std::vector<body::BodyId> bricks;
    for (int row = 0; row < 5; ++row)
      for (int i = 0; i < 5; ++i)
        bricks.push_back(add_brick(
            world, stone, Vec3((i + 0.5 * (row % 2)) * (kLength + 5e-4), (row + 0.5) * (kHeight + 5e-4), 0),
            body::Motion::dynamic));
    int joints = 0;
    for (std::size_t i = 0; i < bricks.size(); ++i)
      for (std::size_t k = i + 1; k < bricks.size(); ++k)
        joints += world.add_joint(mortar(bricks[i], bricks[k], 0.5e6)).value() > 0 ? 1 : 0;
    CHECK(joints == 5 * 4 + 4 * 9);
    world::BodyDescription ball;
    ball.name = "ball";
    ball.form = world::SphereDescription{0.05};
    ball.material = steel;
    ball.pose.translation = Vec3(0.6, 0.21, 0.5);
    ball.velocity = Vec3(0.0, 0.0, -15.0);
    REQUIRE(world.add_body(ball).ok());
    while (world.time() < 0.1) world.step();
    hash = world.state_hash();
    int opened = 0;
    for (const world::JointRow& row : world.report().joints) opened += row.opened >= 0.0 ? 1 : 0;
    CHECK(world.report().conservation.momentum_error < 1e-9);
    CHECK(world.report().contact.crossing_pairs == 0);
    return opened;
  };
  std::uint64_t once = 0, again = 0;
  const int opened = run(once);
  CAPTURE(opened);
  CHECK(opened > 0);
  CHECK(opened < 56);
  CHECK(run(again) == opened);
  CHECK(once == again);
}

TEST_CASE(
    "a joint of a body that broke goes on with the nearest piece in the same place, or ends if that is "
    "small") {
  const auto shape = std::make_shared<body::Shape>();
  shape->bounding_radius = 0.05;
  body::Body parent;
  parent.id = 3;
  parent.shape = shape;
  parent.pose = {Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())), Vec3(1, 2, 3)};
  std::vector<body::Body> bodies(2, parent);
  for (int i = 0; i < 2; ++i) {
    bodies[static_cast<std::size_t>(i)].id = static_cast<body::BodyId>(7 + i);
    bodies[static_cast<std::size_t>(i)].pose.translation = parent.pose.apply(Vec3(i == 0 ? -0.1 : 0.1, 0, 0));
  }
  dynamics::Joint joint;
  joint.body_a = 2;
  joint.body_b = 3;
  joint.frame_b = {Quat(Eigen::AngleAxisd(0.3, Vec3::UnitY())), Vec3(0.12, 0.05, 0.0)};
  std::vector<dynamics::Joint> joints{joint};
  CHECK(world::rehang(joints, parent, {7, 8}, bodies).empty());
  CHECK(joints[0].body_a == 2);
  REQUIRE(joints[0].body_b == 8);
  const Pose& piece = bodies[1].pose;
  CHECK(piece.apply(joints[0].frame_b.translation).isApprox(parent.pose.apply(joint.frame_b.translation)));
  CHECK((piece.rotation * joints[0].frame_b.rotation)
            .isApprox(parent.pose.rotation * joint.frame_b.rotation, 1e-12));
  // Pieces of two centimetres that are five from it.
  shape->bounding_radius = 0.02;
  dynamics::Joint near = joint;
  near.number = 4;
  near.frame_b.translation = Vec3(0.12, 0.0, 0.0);
  joint.number = 5;
  joints = {joint, near};
  CHECK(world::rehang(joints, parent, {7, 8}, bodies) == std::vector<int>{5});
  REQUIRE(joints.size() == 1);
  CHECK(joints[0].number == 4);
}

TEST_CASE("a pivot bears a weight up to its strength and goes with its body") {
  for (const double share : {1.02, 0.98}) {
    world::World world = make_world(240, false);
    const int stone = world.add_material(*material::find_preset("brick")).value();
    const auto held = add_brick(world, stone, Vec3(0, 2, 0), body::Motion::fixed);
    const auto free = add_brick(world, stone, Vec3(0, 1, 0), body::Motion::dynamic);
    const double weight = kDensity * kLength * kHeight * kWidth * 9.81, area = 1e-4;
    world::JointDescription joint;
    joint.body_a = held;
    joint.body_b = free;
    joint.form = world::PivotDescription{Vec3(0, 1.5, 0), area};
    joint.strength = share * weight / area;
    REQUIRE(world.add_joint(joint).value() == 1);
    while (world.time() < 0.2) world.step();
    const world::JointRow& row = world.report().joints.front();
    CAPTURE(row.verdict);
    CHECK((row.opened >= 0.0) == (share < 1.0));
    const double height = world.bodies()[1].pose.translation.y();
    if (share > 1.0) CHECK(height == Approx(1.0).epsilon(1e-6));
    if (share < 1.0) CHECK(height < 0.95);
    REQUIRE(world.remove_body(held));
    world.step();
    CHECK(world.bodies().front().velocity.y() < 0.0);
  }
}

TEST_CASE("a chain folds up and falls in a heap, and nothing in it crosses") {
  for (const int rate : {60, 240}) {
    world::World world = make_world(rate);
    const int steel = world.add_material(*material::find_preset("steel")).value();
    const std::variant<world::BoxDescription, world::CapsuleDescription, world::SphereDescription> links[] = {
        world::BoxDescription{Vec3(0.1, 0.03, 0.04)}, world::CapsuleDescription{0.03, 0.2},
        world::SphereDescription{0.1}};
    world::BodyDescription floor;
    floor.form = world::PlaneDescription{};
    floor.material = steel;
    world.add_body(floor).value();
    body::BodyId last = 0;
    for (int k = 0; k < 6; ++k) {
      world::BodyDescription link;
      std::visit([&](const auto& form) { link.form = form; }, links[k % 3]);
      link.material = steel;
      link.pose.translation = Vec3(0.25 * k, 0.6, 0.0);
      if (k % 3 == 1) link.pose.rotation = Quat(Eigen::AngleAxisd(0.5 * core::kPi, Vec3::UnitZ()));
      if (k == 5) link.angular_velocity = Vec3(0.0, 3.0, 12.0);
      const body::BodyId id = world.add_body(link).value();
      world::JointDescription joint;
      joint.body_a = last;
      joint.body_b = id;
      joint.form = world::PivotDescription{Vec3(0.25 * k - 0.125, 0.6, 0.0), 1e-2};
      joint.strength = joint.shear_strength = 1e12;
      if (k > 0) REQUIRE(world.add_joint(joint).value() == k);
      last = id;
    }
    world.keep_ways();
    audit::Audit audit;
    for (int i = 0; i < 2 * rate; ++i) {
      audit.begin_step(world.bodies());
      world.step();
      audit.end_step(world.bodies(), {}, world.ways(), world.time());
    }
    CAPTURE(rate);
    CHECK(audit.report().crossings == 0);
    CHECK(audit.report().passages == 0);
    CHECK(world.report().contact.longest_cut <= 3);
    for (const world::JointRow& row : world.report().joints) CHECK(row.opened < 0.0);
  }
}

TEST_CASE("a chain that a blow tears opens at one of its links, and another one beside it holds") {
  world::World world = make_world(240, false);
  const int steel = world.add_material(*material::find_preset("steel")).value();
  const auto hang_chain = [&](double x) {
    const auto hook = add_brick(world, steel, Vec3(x, 3, 0), body::Motion::fixed);
    body::BodyId last = hook;
    for (int k = 0; k < 6; ++k) {
      world::BodyDescription ball;
      ball.form = world::SphereDescription{k == 5 ? 0.15 : 0.02};
      ball.material = steel;
      ball.pose.translation = Vec3(x, k == 5 ? 2.1 : 2.85 - 0.1 * k, 0);
      const body::BodyId id = world.add_body(ball).value();
      world::JointDescription joint;
      joint.body_a = last;
      joint.body_b = id;
      joint.form = world::PivotDescription{Vec3(x, 2.9 - 0.1 * k, 0), 1e-4};
      joint.strength = 5e8;  // bears five tons
      REQUIRE(world.add_joint(joint));
      last = id;
    }
    return last;
  };
  hang_chain(0.0);
  hang_chain(1.0);
  world::BodyDescription stone;  // it rolls off the ball's side after it has torn the chain
  stone.form = world::SphereDescription{0.1};
  stone.material = steel;
  stone.pose.translation = Vec3(-0.1, 2.5, 0);
  stone.velocity = Vec3(0, -10, 0);
  world.add_body(stone).value();
  while (world.time() < 0.2) world.step();
  const auto& rows = world.report().joints;
  REQUIRE(rows.size() == 12);
  const auto is_open = [](const world::JointRow& row) { return row.opened >= 0.0; };
  CHECK(std::count_if(rows.begin(), rows.begin() + 6, is_open) == 1);
  CHECK(std::count_if(rows.begin() + 6, rows.end(), is_open) == 0);
}

TEST_CASE("a pellet loads the links of a taut chain alike at any step, and the hook by what hangs on it") {
  for (const double speed : {20.0, 150.0}) {
    std::vector<double> hardest, hooks;  // N; as shares of the weight
    for (const int rate : {60, 240, 960}) {
      world::World world = make_world(rate);
      const int steel = world.add_material(*material::find_preset("steel")).value();
      body::BodyId last = add_brick(world, steel, Vec3(0, 3, 0), body::Motion::fixed);
      double weight = 0.0;
      for (int k = 0; k < 9; ++k) {
        const bool is_ball = k == 8;
        world::BodyDescription link;
        link.material = steel;
        link.form = world::CapsuleDescription{0.01, 0.09};
        if (is_ball) link.form = world::SphereDescription{0.08};
        link.pose.translation = Vec3(0, is_ball ? 2.02 : 2.85 - 0.1 * k, 0);
        const body::BodyId id = world.add_body(link).value();
        weight += 9.81 / world.bodies().back().inverse_mass;
        world::JointDescription joint;
        joint.body_a = last;
        joint.body_b = id;
        joint.form = world::PivotDescription{Vec3(0, 2.9 - 0.1 * k, 0), 1e-4};
        joint.strength = 1e10;
        REQUIRE(world.add_joint(joint));
        last = id;
      }
      world::BodyDescription pellet;
      pellet.material = steel;
      pellet.form = world::SphereDescription{0.004};
      pellet.pose.translation = Vec3(0.5, 2.47, 0);
      pellet.velocity = Vec3(-speed, 0.2, 0);
      world.add_body(pellet).value();
      while (world.time() < 0.1) world.step();
      const auto& rows = world.report().joints;
      double most = 0.0;
      for (const world::JointRow& row : rows) most = std::max(most, row.most_ratio);
      hardest.push_back(most * 1e10 * 1e-4);
      hooks.push_back(rows.front().most_ratio * 1e10 * 1e-4 / weight);
    }
    CAPTURE(speed, hardest[0], hardest[1], hardest[2]);
    CHECK(hardest[0] > 500.0);
    CHECK(hardest[0] == Approx(hardest[2]).epsilon(0.03));
    CHECK(hardest[1] == Approx(hardest[2]).epsilon(0.03));
    CAPTURE(hooks[0], hooks[1], hooks[2]);
    CHECK(hooks[2] < 4.0);  // it swings, and so pulls the harder
    CHECK(hooks[0] == Approx(hooks[2]).epsilon(0.1));
    CHECK(hooks[1] == Approx(hooks[2]).epsilon(0.1));
  }
}

TEST_CASE("what sleeps on joints falls as a whole when what bears it is gone or opens") {
  for (const bool is_removed : {true, false}) {
    CAPTURE(is_removed);
    world::World world = make_world(240);
    const int steel = world.add_material(*material::find_preset("steel")).value();
    const auto hook = add_brick(world, steel, Vec3(0, 3, 0), body::Motion::fixed);
    body::BodyId last = hook;
    for (int k = 0; k < 4; ++k) {
      const auto id = add_brick(world, steel, Vec3(0, 2.9 - 0.1 * k, 0), body::Motion::dynamic);
      world::JointDescription joint;
      joint.body_a = last;
      joint.body_b = id;
      joint.form = world::PivotDescription{Vec3(0, 2.95 - 0.1 * k, 0), 1e-4};
      joint.strength = joint.shear_strength = k == 0 ? 5e6 : 5e8;
      REQUIRE(world.add_joint(joint));
      last = id;
    }
    while (world.time() < 1.5) world.step();
    for (const body::Body& body : world.bodies()) CHECK(body.is_awake == !body.is_dynamic());
    if (is_removed) {
      REQUIRE(world.remove_body(hook));
    } else {
      world::BodyDescription stone;  // it hits the uppermost of them from above
      stone.form = world::SphereDescription{0.02};
      stone.material = steel;
      stone.pose.translation = Vec3(0.1, 2.96, 0);
      stone.velocity = Vec3(0, -20, 0);
      world.add_body(stone).value();
    }
    const double begin = world.time();
    while (world.time() < begin + 0.3) world.step();
    if (!is_removed) CHECK(world.report().joints.front().opened >= 0.0);
    for (int k = 0; k < 4; ++k) {
      const body::Body& link = world.bodies()[static_cast<std::size_t>(k + (is_removed ? 0 : 1))];
      CAPTURE(k);
      CHECK(link.is_awake);
      CHECK(link.pose.translation.y() < 2.9 - 0.1 * k - 0.2);
    }
  }
}

TEST_CASE("what sleeps on a joint goes along when what bears it begins to move") {
  world::World world = make_world(240);
  const int steel = world.add_material(*material::find_preset("steel")).value();
  world::BodyDescription arm;
  arm.form = world::BoxDescription{Vec3(0.1, 0.1, 0.1)};
  arm.material = steel;
  arm.motion = body::Motion::scripted;
  arm.pose.translation = Vec3(0, 2, 0);
  arm.path =
      world::PathDescription{{{1.5, Vec3(0, 2, 0), Vec3::Zero()}, {2.0, Vec3(0, 2.5, 0), Vec3::Zero()}}};
  world::JointDescription joint;
  joint.body_a = world.add_body(arm).value();
  joint.body_b = add_brick(world, steel, Vec3(0, 1.8, 0), body::Motion::dynamic);
  joint.form = world::PivotDescription{Vec3(0, 1.87, 0), 1e-4};
  joint.strength = joint.shear_strength = 1e9;
  REQUIRE(world.add_joint(joint));
  while (world.time() < 1.4) world.step();
  CHECK_FALSE(world.bodies()[1].is_awake);
  while (world.time() < 2.0) world.step();
  CHECK(world.bodies()[1].pose.translation.y() == Approx(2.3).margin(1e-2));
  CHECK(world.report().joints.front().opened < 0.0);
}

TEST_CASE("what touches where it is hinged turns about that place freely") {
  world::World world = make_world(240, false);
  const int stone = world.add_material(*material::find_preset("brick")).value();
  const auto held = add_brick(world, stone, Vec3(0, 1, 0), body::Motion::fixed);
  const auto door = add_brick(world, stone, Vec3(kLength, 1, 0), body::Motion::dynamic);
  world::JointDescription joint;
  joint.body_a = held;
  joint.body_b = door;
  joint.form = world::PivotDescription{Vec3(0.5 * kLength, 1.0, 0.0), 1e-2};
  joint.strength = joint.shear_strength = 1e12;
  REQUIRE(world.add_joint(joint).value() == 1);
  while (world.time() < 0.15) world.step();
  CHECK(world.bodies()[1].pose.translation.y() < 0.95);
}

TEST_CASE("joined bricks that fall on a plane load their mortar as on a large slab") {
  // The plane is endless, and has no size: the duration of the hit was not a number.
  const auto fall = [](bool on_plane) {
    world::World world = make_world(240);
    const int stone = world.add_material(*material::find_preset("brick")).value();
    world::BodyDescription floor;
    floor.material = stone;
    floor.motion = body::Motion::fixed;
    if (on_plane)
      floor.form = world::PlaneDescription{};
    else {
      floor.form = world::BoxDescription{Vec3(5, 1, 5)};
      floor.pose.translation = Vec3(0, -1, 0);
    }
    world.add_body(floor).value();
    const Quat tilt(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
    body::BodyId ids[2];
    for (int k = 0; k < 2; ++k) {
      world::BodyDescription brick;
      brick.form = world::BoxDescription{0.5 * Vec3(kLength, kHeight, kWidth)};
      brick.material = stone;
      brick.pose.rotation = tilt;
      brick.pose.translation = Vec3(0, 0.1, 0) + tilt * Vec3((kLength + 5e-4) * k, 0, 0);
      brick.velocity = Vec3(0, -2, 0);
      ids[k] = world.add_body(brick).value();
    }
    REQUIRE(world.add_joint(mortar(ids[0], ids[1], 1e9)).value() == 1);
    while (world.time() < 0.1) world.step();
    return world.report().joints.front();
  };
  const world::JointRow plane = fall(true), slab = fall(false);
  REQUIRE(slab.is_struck);
  REQUIRE(plane.is_struck);
  CHECK(plane.most_ratio > 0.0);
  CHECK(plane.most_ratio == Approx(slab.most_ratio).epsilon(0.1));
}
