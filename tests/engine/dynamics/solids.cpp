// Planes, boxes and spheres against closed forms.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/collision/analytic_contact.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"
#include "tests/engine/dynamics/bodies.h"
#include "tests/support/sanitized.h"

namespace shatterbox {
namespace {

using body::ImpulseKind;

test::Scene ground_scene() {
  test::Scene scene;
  scene.add(test::make_plane());
  return scene;
}

}  // namespace

TEST_CASE("a ball bounces to e^2 of its height and never gains") {
  for (const double e : {0.0, 0.5, 0.9, 1.0}) {
    auto scene = ground_scene();
    const double radius = 0.1, gap = 2.0 * radius * scene.settings.kept_gap;
    auto& ball = scene.add(test::make_sphere(radius, Vec3(0, 1.0 + radius + gap, 0)));
    ball.restitution = 1.0;
    scene.bodies[0].restitution = e;
    std::vector<double> peaks;
    double last_velocity = 0.0, highest = 0.0;
    const double start = scene.energy();
    double most = start;
    for (int i = 0; i < 240 * 4; ++i) {
      scene.step();
      const auto& b = scene.bodies[1];
      most = std::max(most, scene.energy());
      highest = std::max(highest, last_velocity > 0.0 || b.velocity.y() > 0.0 ? b.pose.translation.y() : 0.0);
      if (last_velocity > 0.0 && b.velocity.y() <= 0.0) {
        peaks.push_back(highest - radius - gap);
        highest = 0.0;
      }
      last_velocity = b.velocity.y();
    }
    INFO("e " << e);
    CHECK(most <= start * (1.0 + 1e-12));
    if (e == 0.0) {
      CHECK(scene.bodies[1].pose.translation.y() == Approx(radius + gap).epsilon(1e-4));
      CHECK(!scene.bodies[1].is_awake);
      continue;
    }
    REQUIRE(peaks.size() >= 3);
    for (int n = 0; n < 3; ++n) {
      CHECK(peaks[static_cast<std::size_t>(n)] == Approx(std::pow(e, 2 * (n + 1))).epsilon(0.02));
    }
  }
}

TEST_CASE("boxes that turn fast do not come into each other") {
  // Between the ends of a step corners go straight: of a box that turns by 0.4 rad they are inside of where a
  // rigid box would have them, and what touches on the way is not yet touching in rigid poses.
  core::Random random(5, 0);
  const auto direction = [&random] {
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0), z = random.uniform(-1.0, 1.0);
    return Vec3(Vec3(x, y, z) / std::max(0.1, Vec3(x, y, z).norm()));
  };
  double deepest = 0.0;
  for (int round = 0; round < 150; ++round) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    for (const double side : {-1.0, 1.0}) {
      auto& box = scene.add(test::make_box(Vec3(0.12, 0.036, 0.058), Vec3(0.15 * side, 0, 0)));
      box.pose.rotation = Quat(Eigen::AngleAxisd(random.uniform(0.0, 3.0), direction().normalized()));
      box.angular_velocity = random.uniform(20.0, 115.0) * direction();
      box.velocity = Vec3(-side * random.uniform(1.0, 12.0), 0, 0) + direction();
    }
    for (int i = 0; i < 20; ++i) {
      scene.step();
      Vec3 normal;
      const auto &a = scene.bodies[0], &b = scene.bodies[1];
      deepest = std::min(deepest, collision::analytic_gap(*a.shape, a.pose, *b.shape, b.pose, normal));
    }
  }
  CHECK(deepest > -1e-12);
}

TEST_CASE("a box that is hit does not come into one that nobody thought it would meet") {
  for (const double speed : {5.0, 15.0, 40.0}) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    auto& ball = scene.add(test::make_sphere(0.14, Vec3(-0.4, 0.02, 0.01), 7800.0));
    ball.velocity.x() = speed;
    for (int i = 0; i < 3; ++i) scene.add(test::make_box(Vec3(0.12, 0.036, 0.058), Vec3(0.25 * i, 0, 0)));
    double deepest = 0.0;
    for (int step = 0; step < 40; ++step) {
      scene.step();
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const auto &a = scene.bodies[i], &b = scene.bodies[j];
          Vec3 normal;
          deepest = std::min(deepest, collision::analytic_gap(*a.shape, a.pose, *b.shape, b.pose, normal));
        }
    }
    INFO(speed << " m/s");
    CHECK(deepest > -1e-12);
    CHECK(scene.bodies[3].velocity.x() > 0.1 * speed);
  }
}

TEST_CASE("a falling ball is seen to touch before it bounces, and its impact is logged as a collision") {
  auto scene = ground_scene();
  auto& ball = scene.add(test::make_sphere(0.1, Vec3(0, 1.0, 0)));
  ball.velocity.y() = -4.0;
  double lowest = 1.0, closing = 0.0;
  int collisions = 0;
  for (int i = 0; i < 120; ++i) {
    const double before = scene.bodies[1].velocity.y();
    scene.step();
    lowest = std::min(lowest, scene.bodies[1].pose.translation.y());
    Vec3 sum = Vec3::Zero();
    for (const auto& entry : scene.log) {
      sum += entry.body_a == 2 ? entry.impulse_world : Vec3(-entry.impulse_world);
      if (entry.kind != ImpulseKind::collision) continue;
      ++collisions;
      closing = std::max(closing, entry.closing_speed);
      CHECK(entry.effective_mass == Approx(scene.bodies[1].shape->mass));
      CHECK(entry.impulse_world.norm() ==
            Approx(1.3 * entry.closing_speed * entry.effective_mass).epsilon(1e-3));
    }
    const double gained = scene.bodies[1].velocity.y() - before + 9.81 / 240.0;
    CHECK(std::abs(sum.y() * scene.bodies[1].inverse_mass - gained) < 1e-12);
  }
  CHECK(collisions == 1);
  CHECK(closing == Approx(std::sqrt(16.0 + 2.0 * 9.81 * 0.9)).epsilon(1e-3));
  CHECK(lowest < 0.102);
  CHECK(lowest > 0.1);
}

TEST_CASE("a block sticks below the friction angle and slides above it") {
  const double tilt = 0.4;
  for (const auto& [share, is_shell] : {std::pair(1.05, false), {0.95, false}, {1.05, true}, {0.95, true}}) {
    auto scene = ground_scene();
    const Quat turn(core::cos(tilt / 2), 0, 0, core::sin(tilt / 2));
    scene.bodies[0].pose.rotation = turn;
    const double mu = share * std::tan(tilt);
    auto& block = scene.add(is_shell ? test::make_shell(test::square_mesh(0.2, 3))
                                     : test::make_box(Vec3(0.2, 0.05, 0.2), Vec3::Zero()));
    block.pose.translation = turn * Vec3(0, is_shell ? 4e-4 : 0.0504, 0);
    block.pose.rotation = turn;
    block.friction = scene.bodies[0].friction = mu;
    scene.settings.has_sleep = false;
    const Vec3 start = block.pose.translation;
    for (int i = 0; i < 480; ++i) scene.step();
    const double way = (scene.bodies[1].pose.translation - start).norm();
    const double slide = 0.5 * 9.81 * (std::sin(tilt) - mu * std::cos(tilt)) * 4.0;
    INFO((is_shell ? "plate" : "block") << ", share " << share << " way " << way << " closed form " << slide);
    if (share > 1.0) {
      CHECK(way < 1e-3);
      CHECK(scene.bodies[1].velocity.norm() < 5e-5);
    } else {
      CHECK(way == Approx(slide).epsilon(0.01));
    }
  }
}

TEST_CASE("what a slope holds creeps no further, though some of its feet slide") {
  // The lower feet of what is high carry most, and the upper ones are at their friction's end.
  struct Case {
    double rate, share;
    bool is_shell = false, may_break = false;
  };
  for (const Case& c :
       {Case{30, 1.15}, Case{60, 1.05}, Case{240, 1.05}, Case{960, 1.05}, Case{60, 1.05, true},
        Case{240, 1.05, true}, Case{30, 1.15, false, true}, Case{60, 1.05, false, true}}) {
    if (test::kIsSanitized && c.rate > 240) continue;
    const double tilt = core::kPi / 6.0;
    auto scene = ground_scene();
    const Quat turn(core::cos(tilt / 2), 0, 0, core::sin(tilt / 2));
    scene.bodies[0].pose.rotation = turn;
    auto& block = scene.add(c.is_shell ? test::make_shell(test::square_mesh(0.05, 3))
                                       : test::make_box(Vec3(0.05, 0.03, 0.04), Vec3::Zero()));
    block.pose.translation = turn * Vec3(0, c.is_shell ? 7e-5 : 0.03, 0);
    block.pose.rotation = turn;
    block.friction = scene.bodies[0].friction = c.share * std::tan(tilt);
    scene.settings.has_sleep = false;
    scene.settings.time_step = 1.0 / c.rate;
    block.may_break = c.may_break;
    const Vec3 down = turn * Vec3::UnitX();
    std::vector<double> ways;
    for (int i = 0; i < 5 * static_cast<int>(c.rate); ++i) {
      scene.step();
      ways.push_back(-down.dot(scene.bodies[1].pose.translation));
    }
    const double first = ways[ways.size() / 5] - ways.front(), then = ways.back() - ways[ways.size() / 5];
    INFO(c.rate << " steps a second, share " << c.share << (c.may_break ? ", may break: " : ": ") << first
                << " m in a second, then " << then);
    CHECK(std::abs(first) < 1e-5);
    CHECK(std::abs(then) < 1e-6);
  }
}

TEST_CASE("a sliding ball comes to roll") {
  auto scene = ground_scene();
  const double v0 = 3.0, mu = 0.3;
  auto& ball = scene.add(test::make_sphere(0.1, Vec3(0, 0.1001, 0)));
  ball.velocity.x() = v0;
  ball.friction = scene.bodies[0].friction = mu;
  const double rolls_at = 2.0 * v0 / (7.0 * mu * 9.81);
  // The slip falls by 7/2 mu g: its line through two steps in the midst of the slide says when it ends.
  const auto slip = [&] { return scene.bodies[1].velocity.x() + scene.bodies[1].angular_velocity.z() * 0.1; };
  double slips[2] = {0.0, 0.0};
  for (int i = 1; i <= 480; ++i) {
    scene.step();
    if (i == 30 || i == 60) slips[i / 60] = slip();
    if (i == 60) CHECK(slip() > 0.1 * v0);
    if (i / 240.0 > 1.01 * rolls_at) CHECK(std::abs(slip()) < 1e-3);
  }
  CHECK(0.125 + 0.125 * slips[0] / (slips[0] - slips[1]) == Approx(rolls_at).epsilon(0.01));
  CHECK(scene.bodies[1].velocity.x() == Approx(5.0 / 7.0 * v0).epsilon(0.01));
}

TEST_CASE("a ball that spins on the spot is slowed by the friction of the patch it rests on") {
  auto scene = ground_scene();
  scene.settings.has_sleep = false;
  const double radius = 0.05, patch = 0.002, friction = 0.4, spin = 30.0;
  scene.settings.overrides = {{0, 0, friction, 0.0}};
  auto ball = test::make_sphere(radius, Vec3(0, radius, 0));
  ball.rolling_friction = patch;
  ball.angular_velocity = Vec3(0, spin, 0);
  scene.add(std::move(ball));
  // The couple 2/3 mu b m g on 2/5 m r^2.
  const double slowing = (2.0 / 3.0) * friction * patch * 9.81 / (0.4 * radius * radius);
  const int half = static_cast<int>(0.5 * spin / slowing * 240.0);
  for (int i = 0; i < half; ++i) scene.step();
  CHECK(scene.bodies[1].angular_velocity.y() == Approx(spin - slowing * half / 240.0).epsilon(0.01));
  for (int i = 0; i < half + 24; ++i) scene.step();
  CHECK(scene.bodies[1].angular_velocity.norm() < 1e-3);
  CHECK(scene.bodies[1].velocity.norm() < 1e-3);
}

TEST_CASE("colliding bodies keep momentum and lose what Newton's rule says") {
  core::Random random(7);
  const auto draw = [&] {
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    const double z = random.uniform(-1, 1);
    return Vec3(x, y, z);
  };
  int seen = 0, opened = 0;
  for (int n = 0; n < 60; ++n) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    const bool has_boxes = n % 2 == 1, has_bowls = n % 6 == 3;
    const double e = 0.25 * (n % 5);
    for (int k = 0; k < 2; ++k) {
      const Vec3 place = (k == 0 ? -1.0 : 1.0) * (Vec3(0.4, 0, 0) + 0.05 * draw());
      auto b = has_boxes ? test::make_box(Vec3(0.1, 0.15, 0.2), place, true, 500.0 + 1500.0 * k)
                         : test::make_sphere(0.1 + 0.05 * k, place, 500.0 + 1500.0 * k);
      if (has_bowls) {
        b = test::make_shell(test::bowl_mesh(0.15 + 0.05 * k, 4, 10));
        b.pose.translation = place;
      }
      b.velocity = (k == 0 ? 1.0 : -1.0) * Vec3(2.0, 0, 0) + 0.2 * draw();
      b.angular_velocity = 0.5 * draw();
      b.pose.rotation = dynamics::rotation_by(draw());
      b.restitution = e;
      b.friction = has_boxes ? 0.4 : 0.0;
      scene.add(b);
    }
    const Vec3 momentum = scene.momentum(), spin = scene.spin();
    const double scale = 2.0 * scene.bodies[1].shape->mass;
    int slid = 0;  // steps in a row
    for (int i = 0; i < 120; ++i) {
      const double before = scene.kinetic();
      scene.step();
      INFO("pair " << n << " step " << i);
      CHECK((scene.momentum() - momentum).norm() < 1e-12 * scale);
      // The continuous pass opens gaps in position, which keeps momentum but not quite angular momentum.
      if (scene.report.rounds > 0) {
        ++opened;
        break;
      }
      CHECK((scene.spin() - spin).norm() < 1e-12 * scale);
      // What has slid along an edge for long, and comes upon a face, may win a ten millionth by that.
      slid = has_boxes && scene.report.hits == 0 && scene.report.contacts > 0 ? slid + 1 : 0;
      CHECK(scene.kinetic() <= before * (1.0 + (slid > 40 ? 1e-6 : 1e-9)));
      if (has_boxes || scene.log.empty()) continue;
      ++seen;
      REQUIRE(scene.log.size() == 1);
      const auto& entry = scene.log[0];
      if (e == 0.0 && entry.kind == ImpulseKind::contact) continue;  // without a bounce they go on sliding
      CHECK(entry.kind == ImpulseKind::collision);
      const double lost =
          0.5 * (1.0 - e * e) * entry.effective_mass * entry.closing_speed * entry.closing_speed;
      // The centres turn about each other by a little between the approach and the bounce of a substep.
      CHECK(before - scene.kinetic() == Approx(lost).margin(1e-4 * before));
    }
  }
  CHECK(seen >= 20);
  CHECK(opened <= 5);
}

TEST_CASE("boxes thrown hard at each other meet several times in a step and keep their angular momentum") {
  core::Random random(11);
  const auto draw = [&](double most) {
    const double x = random.uniform(-most, most);
    const double y = random.uniform(-most, most);
    const double z = random.uniform(-most, most);
    return Vec3(x, y, z);
  };
  int met = 0, opened = 0;
  for (int n = 0; n < 60; ++n) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    scene.settings.time_step = 1.0 / 60.0;
    for (const double side : {-1.0, 1.0}) {
      auto box = test::make_box(Vec3::Constant(0.05) + draw(0.025), Vec3(0.5 * side, 0, 0) + draw(0.05));
      box.velocity = Vec3(-5.0 * side, 0, 0);
      box.angular_velocity = draw(3.0);
      box.pose.rotation = dynamics::rotation_by(draw(3.0));
      box.friction = 0.25 * (n % 3);
      box.restitution = 0.3;
      scene.add(box);
    }
    const Vec3 spin = scene.spin(), momentum = scene.momentum();
    const double kinetic = scene.kinetic();
    int rounds = 0;
    for (int i = 0; i < 12; ++i) {
      scene.step();
      rounds += scene.report.rounds;
    }
    INFO("pair " << n);
    met += scene.kinetic() < kinetic * (1.0 - 1e-9) ? 1 : 0;
    opened += rounds > 0 ? 1 : 0;
    CHECK((scene.momentum() - momentum).norm() < 1e-12 * 10.0);
    // What is opened in position does not quite keep it; without friction, where boxes slide along each
    // other, some is.
    CHECK((scene.spin() - spin).norm() < (rounds == 0 ? 1e-12 : 0.05) * spin.norm());
    CHECK(scene.kinetic() <= kinetic * (1.0 + 1e-9));
  }
  CHECK(met >= 50);
  CHECK(opened <= 6);
}

TEST_CASE("a stack of five boxes stands, and the ground carries its weight") {
  auto scene = ground_scene();
  const double half = 0.1;
  for (int k = 0; k < 5; ++k)
    scene.add(test::make_box(Vec3::Constant(half), Vec3(0, half + 2 * half * k, 0)));
  scene.settings.has_sleep = false;
  const double weight = 5.0 * scene.bodies[1].shape->mass * 9.81;
  double carried = 0.0;
  for (int i = 0; i < 960; ++i) {
    scene.step();
    for (const auto& entry : scene.log) {
      if (i >= 480 && (entry.body_a == 1 || entry.body_b == 1)) carried += std::abs(entry.impulse_world.y());
      if (i >= 480) CHECK(entry.kind == ImpulseKind::contact);
    }
  }
  CHECK(carried / 2.0 == Approx(weight).epsilon(1e-3));
  for (int k = 0; k < 5; ++k) {
    const Vec3 place = scene.bodies[static_cast<std::size_t>(k) + 1].pose.translation;
    INFO("box " << k << " at " << place.transpose());
    CHECK(std::abs(place.x()) + std::abs(place.z()) < 5e-3);
    CHECK(place.y() == Approx(half + 2 * half * k).margin(2e-3));
  }
  CHECK(scene.kinetic() < 1e-4);  // of 40 kg: below 3 mm/s
  scene.settings.has_sleep = true;
  for (int i = 0; i < 240; ++i) scene.step();
  for (std::size_t k = 1; k < 6; ++k) CHECK(!scene.bodies[k].is_awake);
  // The lowest is taken away: the others wake and fall.
  scene.bodies.erase(scene.bodies.begin() + 1);
  for (int i = 0; i < 120; ++i) scene.step();
  CHECK(scene.bodies[1].pose.translation.y() == Approx(half).margin(2e-3));
}

TEST_CASE("light boxes carry one of a hundred or a thousand times their mass") {
  struct Tower {
    int light;
    double ratio;
  };
  // A tower is solved on one thread: of more the sanitizers would see the same again.
  for (const Tower& tower : test::kIsSanitized
                                ? std::vector{Tower{1, 1000.0}}
                                : std::vector{Tower{1, 1000.0}, Tower{4, 100.0}, Tower{9, 1000.0}}) {
    INFO(tower.light << " light boxes, " << tower.ratio << " times the mass on top");
    auto scene = ground_scene();
    scene.settings.has_sleep = false;
    const double half = 0.1;
    for (int k = 0; k <= tower.light; ++k)
      scene.add(test::make_box(Vec3::Constant(half), Vec3(0, half + 2 * half * k, 0), true,
                               k < tower.light ? 1000.0 : 1000.0 * tower.ratio));
    double weight = 0.0, carried = 0.0;
    int cut = 0;
    for (const auto& b : scene.bodies)
      if (b.is_dynamic()) weight += b.shape->mass * 9.81;
    for (int i = 0; i < 300; ++i) {
      scene.step();
      if (i >= 180) cut += scene.report.failsafe_steps;
      for (const auto& entry : scene.log)
        if (i >= 180 && (entry.body_a == 1 || entry.body_b == 1))
          carried += std::abs(entry.impulse_world.y());
    }
    CHECK(cut == 0);
    CHECK(carried == Approx(0.5 * weight).epsilon(1e-3));  // in half a second
    for (int k = 0; k <= tower.light; ++k) {
      const Vec3 place = scene.bodies[static_cast<std::size_t>(k) + 1].pose.translation;
      INFO("box " << k << " at " << place.transpose());
      CHECK(std::abs(place.x()) + std::abs(place.z()) < 1e-3);
      CHECK(place.y() == Approx(half + 2 * half * k).margin(2e-3));
    }
  }
}

TEST_CASE("fast spheres and boxes do not pass each other") {
  for (const double speed : {10.0, 100.0, 500.0}) {
    test::Scene scene;
    scene.settings.gravity.setZero();
    scene.add(test::make_box(Vec3(1, 1, 0.01), Vec3::Zero(), false));
    auto& ball = scene.add(test::make_sphere(0.05, Vec3(0.1, 0.2, 3.3)));
    ball.velocity.z() = -speed;
    auto& box = scene.add(test::make_box(Vec3(0.05, 0.06, 0.07), Vec3(-0.3, 0.1, 3.1)));
    box.velocity.z() = -speed;
    box.angular_velocity = Vec3(5, 7, 3);
    auto& miss = scene.add(test::make_sphere(0.05, Vec3(1.06, 0, 3.2)));
    miss.velocity.z() = -speed;
    for (int i = 0; i < 120; ++i) scene.step();
    INFO("speed " << speed);
    CHECK(scene.bodies[1].pose.translation.z() > 0.05);
    CHECK(scene.bodies[2].pose.translation.z() > 0.05);
    CHECK(scene.bodies[3].velocity.z() == Approx(-speed).epsilon(1e-12));
  }
}

}  // namespace shatterbox
