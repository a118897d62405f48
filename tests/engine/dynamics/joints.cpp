// Joints: bodies held together by areas or about points, against closed forms of statics and of free motion.
#include <catch2/catch.hpp>

#include "bodies.h"

using namespace shatterbox;
using test::Scene;

namespace {

/// Holds two boxes together over a rectangle of `width` (along z) and `height` (along y) across x.
dynamics::Joint join_across_x(const Scene& scene, body::BodyId a, body::BodyId b, const Vec3& middle,
                              double height, double width) {
  dynamics::Joint joint;
  joint.number = static_cast<int>(scene.state.joints.size()) + 1;
  joint.body_a = a;
  joint.body_b = b;
  const auto frame_in = [&](body::BodyId id) {
    const Pose& pose = body::find_body(scene.bodies, id)->pose;
    return Pose{pose.rotation.conjugate(), pose.apply_inverse(middle)};
  };
  joint.frame_a = frame_in(a);
  joint.frame_b = frame_in(b);
  joint.area = height * width;
  joint.moments.y() = height * width * width * width / 12.0;
  joint.moments.z() = width * height * height * height / 12.0;
  joint.moments.x() = joint.moments.y() + joint.moments.z();
  return joint;
}

/// A row of `count` boxes along x, 0.2 m each, joined by their faces; the first one is held if `is_held`.
/// `gap` m between them.
Scene make_row(int count, bool is_held, double gap = 2e-4) {
  Scene scene;
  for (int i = 0; i < count; ++i)
    scene.add(test::make_box(Vec3(0.1 - 0.5 * gap, 0.05, 0.03), Vec3(0.2 * i, 1.0, 0.0), i > 0 || !is_held,
                             2000.0));
  for (int i = 1; i < count; ++i)
    scene.state.joints.push_back(join_across_x(scene, static_cast<body::BodyId>(i + 1),
                                               static_cast<body::BodyId>(i), Vec3(0.2 * i - 0.1, 1.0, 0.0),
                                               0.1, 0.06));
  return scene;
}

double mass_of(const body::Body& b) {
  return b.shape->mass;
}

}  // namespace

TEST_CASE("a cantilever of joined boxes bears its shear and moment, however near they lie") {
  const double gap = GENERATE(2e-4, 1e-5, 1e-6, 0.0);
  CAPTURE(gap);
  Scene scene = make_row(6, true, gap);
  scene.settings.has_sleep = false;
  const double weight = mass_of(scene.bodies[1]) * 9.81, dt = scene.settings.time_step;
  for (int i = 0; i < 60; ++i) scene.step();
  for (int k = 0; k < 5; ++k) {
    const int beyond = 5 - k;  // boxes that hang on this joint
    double moment = 0.0;
    for (int i = 0; i < beyond; ++i) moment += weight * (0.1 + 0.2 * i);
    const dynamics::Joint& joint = scene.state.joints[static_cast<std::size_t>(k)];
    CAPTURE(k, joint.impulse.transpose() / dt, joint.couple.transpose() / dt, beyond * weight, moment);
    CHECK(joint.impulse.y() / dt == Approx(beyond * weight).epsilon(1e-4));
    CHECK(joint.couple.z() / dt == Approx(moment).epsilon(1e-4));
    CHECK(std::abs(joint.impulse.x()) < 1e-4 * beyond * weight * dt);
  }
  // It has not sagged: the tip is where it was.
  CHECK((scene.bodies.back().pose.translation - Vec3(1.0, 1.0, 0.0)).norm() < 1e-7);
}

TEST_CASE("joined boxes tumble as one body and keep their momenta, however near they lie") {
  const double gap = GENERATE(2e-4, 1e-5, 1e-6, 0.0);
  CAPTURE(gap);
  Scene scene = make_row(4, false, gap);
  scene.settings.gravity.setZero();
  const Vec3 centre(0.3, 1.0, 0.0), spin(1.0, 3.0, -7.0);
  for (auto& b : scene.bodies) {
    b.angular_velocity = spin;
    b.velocity = Vec3(1.0, 2.0, 3.0) + spin.cross(b.pose.translation - centre);
  }
  const Vec3 momentum = scene.momentum(), angular = scene.spin();
  const double energy = scene.kinetic();
  double most_apart = 0.0;
  for (int i = 0; i < 240; ++i) {
    scene.step();
    for (std::size_t k = 0; k + 1 < scene.bodies.size(); ++k) {
      const Vec3 mine = scene.bodies[k].pose.apply(Vec3(0.1, 0.0, 0.0));
      const Vec3 next = scene.bodies[k + 1].pose.apply(Vec3(-0.1, 0.0, 0.0));
      most_apart = std::max(most_apart, (mine - next).norm());
    }
  }
  CAPTURE(most_apart, scene.kinetic() / energy - 1.0);
  CHECK((scene.momentum() - momentum).norm() < 1e-12 * momentum.norm());
  CHECK((scene.spin() - angular).norm() < 1e-11 * angular.norm());
  CHECK(scene.kinetic() / energy < 1.0 + 1e-6);
  CHECK(scene.kinetic() / energy > 0.99);
  CHECK(most_apart < 1e-4);
}

TEST_CASE("sheets that are joined and whirl as one are in each other's way nowhere in a step") {
  Scene scene;
  scene.settings.gravity.setZero();
  constexpr double kHalf = 0.02, kGap = 3e-4;  // m
  // A T: the second stands on the first, and its centre goes round in an arc of a radian.
  scene.add(test::make_shell(test::square_mesh(kHalf, 4)));
  scene.add(test::make_shell(test::square_mesh(kHalf, 4)));
  scene.bodies[0].pose.rotation = Quat(core::sqrt(0.5), 0, 0, core::sqrt(0.5));
  scene.bodies[1].pose.translation.x() = kHalf + kGap;
  scene.state.joints.push_back(join_across_x(scene, 1, 2, Vec3(0.5 * kGap, 0, 0), 0.01, 0.01));
  const Vec3 spin(0, 0, 250.0), centre = 0.5 * scene.bodies[1].pose.translation;
  for (auto& b : scene.bodies) {
    b.angular_velocity = spin;
    b.velocity = spin.cross(b.pose.translation - centre);
  }
  for (int i = 0; i < 5; ++i) {
    CHECK(scene.bodies[0].angular_velocity.norm() * scene.settings.time_step > 1.5 * 0.5);
    scene.step();
    CHECK(scene.report.near_bodies == 2);
    CHECK(scene.report.hits == 0);
  }
}

TEST_CASE("a body on a pivot swings with the period of a physical pendulum") {
  Scene scene;
  scene.settings.has_sleep = false;
  scene.add(test::make_sphere(0.01, Vec3(0, 2, 0))).motion = body::Motion::fixed;
  scene.bodies[0].inverse_mass = 0.0;
  scene.bodies[0].inverse_inertia.setZero();
  const double lean = 0.05, arm = 0.5;
  body::Body bar =
      test::make_box(Vec3(0.02, 0.3, 0.02), Vec3(arm * std::sin(lean), 2 - arm * std::cos(lean), 0));
  bar.pose.rotation = Quat(Eigen::AngleAxisd(lean, Vec3::UnitZ()));
  scene.add(bar);
  dynamics::Joint joint = join_across_x(scene, 2, 1, Vec3(0, 2, 0), 0.01, 0.01);
  joint.is_pivot = true;
  scene.state.joints.push_back(joint);
  const auto& b = scene.bodies[1];
  const double inertia = b.shape->inertia(2, 2) + b.shape->mass * arm * arm;
  const double period =
      2.0 * core::kPi * std::sqrt(inertia / (b.shape->mass * 9.81 * arm)) * (1.0 + lean * lean / 16.0);
  // From one crossing of the lowest place to the next but one.
  std::vector<double> crossings;
  double before = b.pose.translation.x();
  for (int i = 1; i <= 1200; ++i) {
    scene.step();
    const double now = b.pose.translation.x();
    if (before > 0.0 && now <= 0.0)
      crossings.push_back((i - now / (now - before)) * scene.settings.time_step);
    before = now;
  }
  REQUIRE(crossings.size() >= 3);
  const double found = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  CHECK(found == Approx(period).epsilon(1e-3));
  CHECK(b.pose.apply(Vec3(0, arm, 0)).isApprox(Vec3(0, 2, 0), 1e-6));
}

TEST_CASE("a heavy ball swings on a light chain alike at any step and wins nothing") {
  constexpr int kLinks = 8;
  constexpr double kPitch = 0.11, kRadius = 0.15;
  const auto swing = [&](int steps_per_second) {
    Scene scene;
    scene.settings.time_step = 1.0 / steps_per_second;
    scene.settings.has_sleep = false;
    scene.add(test::make_sphere(0.02, Vec3(-0.06, 3, 0))).motion = body::Motion::fixed;
    scene.bodies[0].inverse_mass = 0.0;
    scene.bodies[0].inverse_inertia.setZero();
    for (int i = 0; i < kLinks; ++i)
      scene.add(test::make_box(Vec3(0.05, 0.01, 0.01), Vec3(kPitch * (i + 0.5), 3, 0), true, 4000.0));
    scene.add(test::make_sphere(kRadius, Vec3(kPitch * kLinks + kRadius, 3, 0), 8000.0));
    for (int i = 0; i <= kLinks; ++i) {
      dynamics::Joint joint =
          join_across_x(scene, static_cast<body::BodyId>(i + 2), static_cast<body::BodyId>(i + 1),
                        Vec3(kPitch * i, 3, 0), 0.01, 0.01);
      joint.is_pivot = true;
      scene.state.joints.push_back(joint);
    }
    const body::Body& ball = scene.bodies.back();
    REQUIRE(ball.shape->mass > 500.0 * scene.bodies[1].shape->mass);
    const double all =
        ball.shape->mass * 9.81 * (kPitch * kLinks + kRadius);  // J, from the start to the lowest
    const auto energy = [&] {
      double sum = scene.kinetic();
      for (std::size_t i = 1; i < scene.bodies.size(); ++i)
        sum += scene.bodies[i].shape->mass * 9.81 * (scene.bodies[i].pose.translation.y() - 3.0);
      return sum;
    };
    double most = 0.0, apart = 0.0, lowest = 0.0;
    for (int i = 0; i < 2 * steps_per_second; ++i) {
      scene.step();
      most = std::max(most, energy());
      lowest = std::min(lowest, ball.pose.translation.y() - 3.0);
      for (const dynamics::Joint& joint : scene.state.joints) {
        const Pose &a = body::find_body(scene.bodies, joint.body_a)->pose,
                   &b = body::find_body(scene.bodies, joint.body_b)->pose;
        apart =
            std::max(apart, (a.apply(joint.frame_a.translation) - b.apply(joint.frame_b.translation)).norm());
      }
    }
    CAPTURE(steps_per_second, energy() / all, most / all, apart, lowest);
    CHECK(most < 1e-5 * all);
    CHECK(std::abs(energy()) < 1e-4 * all);
    CHECK(apart < 1e-6);
    CHECK(lowest == Approx(-(kPitch * kLinks + kRadius)).epsilon(0.01));
    return ball.pose.translation;
  };
  const Vec3 fine = swing(480);
  CHECK((swing(30) - fine).norm() < 1e-3);
  CHECK((swing(60) - fine).norm() < 1e-3);
  CHECK((swing(240) - fine).norm() < 1e-3);
}

TEST_CASE("a blow on a chain that is straight between two hooks bounces, wins nothing and does not tear it") {
  for (const int rate : {60, 240}) {
    for (const int links : {2, 3, 5}) {
      for (const double speed : {5.0, 20.0, 60.0}) {
        Scene scene;
        scene.settings.time_step = 1.0 / rate;
        scene.settings.has_sleep = false;
        const auto add_hook = [&](double x) {
          scene.add(test::make_sphere(0.02, Vec3(x, 1, 0))).motion = body::Motion::fixed;
          scene.bodies.back().inverse_mass = 0.0;
          scene.bodies.back().inverse_inertia.setZero();
        };
        add_hook(-0.05);
        for (int i = 0; i < links; ++i)
          scene.add(test::make_box(Vec3(0.04, 0.0125, 0.0125), Vec3(0.1 * i + 0.05, 1, 0), true, 7850.0));
        add_hook(0.1 * links + 0.05);
        for (int i = 0; i <= links; ++i) {
          dynamics::Joint joint =
              join_across_x(scene, static_cast<body::BodyId>(i + 2), static_cast<body::BodyId>(i + 1),
                            Vec3(0.1 * i, 1, 0), 0.01, 0.01);
          joint.is_pivot = joint.may_meet = true;
          scene.state.joints.push_back(joint);
        }
        scene.add(test::make_sphere(0.04, Vec3(0.05 * links, 1, 0.2), 7850.0)).velocity = Vec3(0, 0, -speed);
        const auto energy = [&] {
          double sum = scene.kinetic();
          for (const body::Body& b : scene.bodies)
            if (b.is_dynamic()) sum += b.shape->mass * 9.81 * (b.pose.translation.y() - 1.0);
          return sum;
        };
        const double start = energy();
        double most = start, apart = 0.0;
        for (int i = 0; i < rate; ++i) {
          scene.step();
          most = std::max(most, energy());
          for (const dynamics::Joint& joint : scene.state.joints) {
            const Pose &a = body::find_body(scene.bodies, joint.body_a)->pose,
                       &b = body::find_body(scene.bodies, joint.body_b)->pose;
            apart = std::max(
                apart, (a.apply(joint.frame_a.translation) - b.apply(joint.frame_b.translation)).norm());
          }
        }
        CAPTURE(rate, links, speed, most / start, apart);
        CHECK(most < 1.02 * start);
        CHECK(apart < 0.01);  // a tenth of a link
        CHECK(scene.bodies.back().velocity.z() > 0.0);
        CHECK(std::isfinite(energy()));
      }
    }
  }
}

TEST_CASE("a row of joined boxes lies on two feet and sleeps and wakes as one") {
  Scene scene = make_row(5, false);
  for (auto& b : scene.bodies) b.pose.translation.y() = 0.1501;
  scene.add(test::make_plane());
  scene.add(test::make_box(Vec3(0.05, 0.05, 0.05), Vec3(0.0, 0.05, 0.0)));
  scene.add(test::make_box(Vec3(0.05, 0.05, 0.05), Vec3(0.8, 0.05, 0.0)));
  for (int i = 0; i < 480; ++i) scene.step();
  for (int i = 0; i < 5; ++i) {
    CAPTURE(i);
    CHECK(!scene.bodies[static_cast<std::size_t>(i)].is_awake);
    CHECK(scene.bodies[static_cast<std::size_t>(i)].pose.translation.y() == Approx(0.15).epsilon(2e-3));
  }
  scene.bodies[2].velocity = Vec3(0.0, 1.0, 0.0);
  scene.step();
  for (int i = 0; i < 5; ++i) CHECK(scene.bodies[static_cast<std::size_t>(i)].is_awake);
}

TEST_CASE("a ball bounces off a joined row as off one body") {
  Scene joined = make_row(5, false);
  joined.settings.gravity.setZero();
  body::Body ball = test::make_sphere(0.04, Vec3(0.62, 1.2, 0.0), 8000.0);
  ball.velocity = Vec3(0.0, -5.0, 0.0);
  joined.add(ball);
  for (auto& b : joined.bodies) b.friction = 0.0;
  Scene one;
  one.settings.gravity.setZero();
  one.add(test::make_box(Vec3(0.5, 0.05, 0.03), Vec3(0.4, 1.0, 0.0), true, 2000.0 * 0.999));
  one.add(ball);
  for (auto& b : one.bodies) b.friction = 0.0;
  for (int i = 0; i < 48; ++i) {
    joined.step();
    one.step();
  }
  CAPTURE(joined.bodies[5].velocity.transpose(), one.bodies[1].velocity.transpose());
  CHECK(joined.bodies[5].velocity.y() == Approx(one.bodies[1].velocity.y()).epsilon(0.01).margin(0.01));
  CHECK(joined.bodies[2].angular_velocity.z() == Approx(one.bodies[0].angular_velocity.z()).epsilon(0.01));
}

TEST_CASE("Newton's cradle: a blow goes through balls that hang on a beam, asleep or not") {
  for (const bool has_sleep : {true, false}) {
    INFO("sleep " << has_sleep);
    Scene scene;
    scene.settings.has_sleep = has_sleep;
    scene.settings.overrides = {{0, 0, 0.0, 1.0}};
    constexpr double kRadius = 0.05, kLength = 0.4;  // m
    scene.add(test::make_box(Vec3(0.5, 0.01, 0.1), Vec3(0, 0.01, 0), false));
    for (int i = 0; i < 5; ++i) {
      scene.add(test::make_sphere(kRadius, Vec3(0.1001 * i, -kLength, 0), 7800.0));
      dynamics::Joint joint =
          join_across_x(scene, static_cast<body::BodyId>(i + 2), 1, Vec3(0.1001 * i, 0, 0), 0.01, 0.01);
      joint.is_pivot = true;
      scene.state.joints.push_back(joint);
    }
    for (int i = 0; i < 240; ++i) scene.step();
    for (std::size_t k = 1; k < 6; ++k) REQUIRE(scene.bodies[k].is_awake != has_sleep);
    // It swings out, comes back, and hits.
    scene.bodies[1].is_awake = true;
    scene.bodies[1].velocity.x() = -1.0;
    scene.bodies[1].angular_velocity.z() = -1.0 / kLength;
    double first = 0.0, last = 0.0;
    for (int i = 0; i < 240; ++i) {
      first = std::max(first, scene.bodies[1].velocity.x());
      last = std::max(last, scene.bodies[5].velocity.x());
      scene.step();
      if (last > 0.5 * first && first > 0.5) break;
    }
    CHECK(first == Approx(1.0).epsilon(0.05));
    CHECK(last > 0.85 * first);
    for (std::size_t k = 1; k < 5; ++k) CHECK(std::abs(scene.bodies[k].velocity.x()) < 0.12 * first);
  }
}
