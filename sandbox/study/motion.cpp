#include "sandbox/study/motion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/core/elementary.h"
#include "sandbox/study/small_world.h"
#include "sandbox/study/spin_top.h"
#include "sandbox/study/stopwatch.h"

namespace shatterbox::sandbox::study {

namespace motion {
namespace {

constexpr double kGravity = 9.81;  // m/s2

world::World make_world(int rate, const material::Material& material, bool has_gravity = true) {
  world::WorldSettings settings;
  settings.steps_per_second = rate;
  settings.has_sleep = false;
  if (!has_gravity) settings.gravity.setZero();
  world::World world(settings);
  add_material(world, material);
  return world;
}

/// A free asymmetric box of moments in the ratio of about 1 : 2 : 2.6 spins for 10 s: Jacobi's functions.
Measured spin_freely(int rate) {
  world::World world = make_world(rate, plain_material(0.5, 0.3), false);
  auto box = box_description(Vec3(0.3, 0.2, 0.1), Vec3::Zero());
  box.angular_velocity = Vec3(0.6, 0.0, 2.4);
  add_body(world, box);
  // Ascending moments are about x, y, z here.
  const SpinTop top(world.bodies()[0].shape->inertia.diagonal(), 0.6, 2.4);
  const Vec3 momentum = body::angular_momentum(world.bodies()[0]);
  Measured measured;
  double worst = 0.0, lost = 0.0;
  const long tenths = 100;
  measured.seconds = 0.0;
  for (long i = 1; i <= tenths; ++i) {
    measured.seconds += advance(world, 0.1);
    const body::Body& body = world.bodies()[0];
    const Vec3 exact = top.spin_at(world.time());
    const Vec3 found = body.pose.rotation.conjugate() * body.angular_velocity;
    worst = std::max(worst, (found - exact).norm() / exact.norm());
    lost = std::max(lost, (body::angular_momentum(body) - momentum).norm() / momentum.norm());
  }
  measured.errors = {worst, lost};
  return measured;
}

/// A thrown, spinning box after 2 s in the air: the parabola.
Measured throw_box(int rate) {
  world::World world = make_world(rate, plain_material(0.5, 0.3));
  const Vec3 start(1.0, 50.0, 2.0), speed(3.0, 10.0, -2.0), gravity(0.0, -kGravity, 0.0);
  auto box = box_description(Vec3(0.1, 0.2, 0.3), start);
  box.velocity = speed;
  box.angular_velocity = Vec3(1.0, 2.0, 3.0);
  add_body(world, box);
  Measured measured;
  measured.seconds = advance(world, 2.0);
  const body::Body& body = world.bodies()[0];
  const Vec3 exact = start + 2.0 * speed + 2.0 * gravity;
  const double way = (exact - start).norm();
  measured.errors = {(body.pose.translation - exact).norm() / way,
                     (body.velocity - speed - 2.0 * gravity).norm() / speed.norm()};
  return measured;
}

/// A box on an incline for a second: how far it slid beyond, or short of, g (sin - mu cos) t^2 / 2.
Measured slide_down(int rate, double friction) {
  const double angle = core::kPi / 6.0;
  world::World world = make_world(rate, plain_material(friction, 0.0));
  const Quat turn(Eigen::AngleAxisd(-angle, Vec3::UnitZ()));  // down towards +x
  auto floor = floor_description();
  floor.pose.rotation = turn;
  add_body(world, floor);
  const Vec3 half(0.2, 0.05, 0.2);
  auto box = box_description(half, turn * Vec3(0.0, half.y() + 5e-4 * 2.0 * half.norm(), 0.0));
  box.pose.rotation = turn;
  add_body(world, box);
  const Vec3 start = box.pose.translation;
  Measured measured;
  measured.seconds = advance(world, 1.0);
  const Vec3 moved = turn.conjugate() * (world.bodies()[1].pose.translation - start);
  const double pull = kGravity * core::sin(angle), brake = kGravity * friction * core::cos(angle);
  const double exact = 0.5 * std::max(0.0, pull - brake);
  const double along = std::abs(moved.x() - exact), across = std::abs(moved.y());
  if (exact > 0.0) {
    measured.errors = {along / exact, across};
    return measured;
  }
  const Vec3 before = world.bodies()[1].pose.translation;
  advance(world, 1.0);
  measured.errors = {along, across, (world.bodies()[1].pose.translation - before).norm()};
  return measured;
}

/// A ball of restitution 0.8 falls from `height`: height and energy 1.9 s later, after three bounces.
Measured bounce(int rate, double height) {
  const double e = 0.8, radius = 0.1, end = 1.9;
  world::World world = make_world(rate, plain_material(0.0, e));
  add_body(world, floor_description());
  // It touches at the gap that is kept, so that is where the floor is for it.
  const double ground = radius + 5e-4 * 2.0 * radius;
  add_body(world, ball_description(radius, Vec3(0.0, ground + height, 0.0)));
  Measured measured;
  measured.seconds = advance(world, end);
  double speed = std::sqrt(2.0 * kGravity * height), time = speed / kGravity;
  while (time + 2.0 * e * speed / kGravity < end) {
    speed *= e;
    time += 2.0 * speed / kGravity;
  }
  speed *= e;
  const double since = world.time() - time;
  const double exact = speed * since - 0.5 * kGravity * since * since;
  const body::Body& ball = world.bodies()[1];
  const double found = ball.pose.translation.y() - ground;
  const double energy = kGravity * found + 0.5 * ball.velocity.squaredNorm();
  const double exact_energy = 0.5 * speed * speed;
  measured.errors = {std::abs(found - exact) / height, std::abs(energy / exact_energy - 1.0)};
  return measured;
}

/// A ball sent sliding without spin: it rolls from 2 v / 7 mu g on, at 5/7 of its speed.
Measured roll(int rate, double speed) {
  const double friction = 0.2, radius = 0.1;
  world::World world = make_world(rate, plain_material(friction, 0.0));
  add_body(world, floor_description());
  auto ball = ball_description(radius, Vec3(0.0, radius * (1.0 + 1e-3), 0.0));
  ball.velocity = Vec3(speed, 0.0, 0.0);
  add_body(world, ball);
  Measured measured;
  measured.seconds = advance(world, 1.0);
  const double until = 2.0 * speed / (7.0 * friction * kGravity);
  const double exact =
      speed * until - 0.5 * friction * kGravity * until * until + 5.0 / 7.0 * speed * (1.0 - until);
  const body::Body& body = world.bodies()[1];
  const double slip = body.velocity.x() + radius * body.angular_velocity.z();
  measured.errors = {std::abs(body.pose.translation.x() / exact - 1.0),
                     std::abs(body.velocity.x() / (5.0 / 7.0 * speed) - 1.0), std::abs(slip) / speed};
  return measured;
}

/// The worst errors of eight starts from `first` to a tenth more: an instant lies early in one's step and
/// late in another's.
Measured worst_of_starts(const std::function<Measured(double)>& measure, double first) {
  Measured worst = measure(first);
  for (int i = 1; i < 8; ++i) {
    const Measured next = measure(first * (1.0 + 0.1 * i / 7.0));
    worst.seconds += next.seconds;
    for (std::size_t e = 0; e < worst.errors.size(); ++e)
      worst.errors[e] = std::max(worst.errors[e], next.errors[e]);
  }
  worst.seconds /= 8.0;
  return worst;
}

Plan make_plan(bool is_quick) {
  const std::vector<int> rates = is_quick ? std::vector<int>{60, 120, 240, 480}
                                          : std::vector<int>{30, 60, 120, 240, 480, 960, 1920, 3840};
  Plan plan;
  Table top = rate_table("top", "a free asymmetric box spins for 10 s, against Jacobi's elliptic functions",
                         {"spin", "angular momentum"});
  top.theory = {4.0};  // of the composition [free_motion.h]
  add_rates(plan, top, rates, spin_freely);
  add_rates(plan,
            rate_table("throw", "a spinning box thrown, after 2 s, against the parabola", {"place", "speed"}),
            rates, throw_box);
  Table incline = rate_table("incline",
                             "a box slides down 30 degrees at friction 0.3 for a second, against "
                             "g (sin - mu cos) t^2 / 2",
                             {"way", "lift, m"});
  add_rates(plan, incline, rates, [](int rate) { return slide_down(rate, 0.3); });
  Table stuck = rate_table("stick", "the same box at friction 0.6 > tan 30 degrees must not move",
                           {"way, m", "lift, m", "drift of the next second, m"});
  stuck.is_relative = false;
  add_rates(plan, stuck, rates, [](int rate) { return slide_down(rate, 0.6); });
  Table ball = rate_table(
      "bounce",
      "a ball of restitution 0.8 dropped from 1 to 1.1 m (worst of 8), 1.9 s later, against its parabolas",
      {"height", "energy"});
  add_rates(plan, ball, rates,
            [](int rate) { return worst_of_starts([rate](double h) { return bounce(rate, h); }, 1.0); });
  Table rolling = rate_table(
      "roll", "a ball sent sliding at 2 to 2.2 m/s (worst of 8) rolls at 5/7 of it, after a second",
      {"place", "speed", "slip"});
  rolling.theory = {2.0};  // a constant force, but for one piece of a step
  add_rates(plan, rolling, rates,
            [](int rate) { return worst_of_starts([rate](double v) { return roll(rate, v); }, 2.0); });
  return plan;
}

}  // namespace
}  // namespace motion

Study motion_study() {
  return {"motion", "closed-form motion against the step: top, throw, incline, bounce, roll",
          motion::make_plan};
}

}  // namespace shatterbox::sandbox::study
