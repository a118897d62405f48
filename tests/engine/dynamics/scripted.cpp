// Bodies that follow a path: they carry, lift, sweep and press; where there is no room they yield, and
// what stands there and can break they strike.
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "engine/audit/audit.h"
#include "engine/core/parallel.h"
#include "engine/core/random.h"
#include "engine/dynamics/scripted_motion.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox {
namespace {

using body::Between;
using body::Keyframe;

constexpr double kG = 9.81;

void follow(body::Body& b, const std::vector<Keyframe>& keys, Between between = Between::smooth,
            const Vec3& pivot = Vec3::Zero()) {
  b.motion = body::Motion::scripted;
  b.inverse_mass = 0.0;
  b.inverse_inertia.setZero();
  b.script.path = std::make_shared<const body::ScriptedPath>(keys, between, Quat::Identity(), -pivot);
  b.pose = b.script.path->pose_at(0.0);
}

Keyframe at(double time, const Vec3& position, const Vec3& angles = Vec3::Zero()) {
  return {time, position, angles};
}

/// One step, audited.
void step(test::Scene& scene, audit::Audit& audit) {
  scene.settings.has_ways = true;
  audit.begin_step(scene.bodies);
  scene.step();
  audit.end_step(scene.bodies, {}, scene.report.ways, 0.0);
}

/// A closed box of twelve triangles.
geometry::TriangleMesh crate_mesh(const Vec3& half, const Vec3& centre) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(centre +
                             half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

}  // namespace

TEST_CASE("a box on a plate that is drawn away sticks below mu g, and slips above by what is missing") {
  // From rest to rest over L in T the plate has a(t) = A (1 - 2t / T), A = 6L / T2. Above mu g the box slips
  // until t1 = T (1 - mu g / A), and again from t2 = T (1 + mu g / A) / 2 on until it has come to rest.
  constexpr double kTime = 1.0, kFriction = 0.5, kMost = kFriction * kG;
  for (const int rate : {60, 240}) {
    for (const bool is_shell : {false, true}) {
      for (const double share : {0.5, 0.95, 1.5, 2.0}) {
        test::Scene scene;
        scene.settings.time_step = 1.0 / rate;
        const Vec3 half(4, 0.05, 1);
        auto& plate = scene.add(is_shell ? test::make_shell(crate_mesh(half, Vec3::Zero()))
                                         : test::make_box(half, Vec3::Zero()));
        plate.friction = kFriction;
        const double most = share * kMost, length = most * kTime * kTime / 6.0;
        follow(plate, {at(0, Vec3(0, -0.05, 0)), at(kTime, Vec3(length, -0.05, 0))});
        auto& box = scene.add(test::make_box(Vec3(0.2, 0.02, 0.2), Vec3(0, 0.0202, 0)));
        box.friction = kFriction;
        const double t1 = kTime * std::max(0.0, 1.0 - 1.0 / share), t2 = 0.5 * kTime * (1.0 + 1.0 / share);
        const auto way = [&](double t) { return most * (t * t / 2.0 - t * t * t / (3.0 * kTime)); };
        const double behind = way(t1) - 0.5 * kMost * t1 * t1;
        const double speed = most * (t2 - t2 * t2 / kTime);
        const double ahead = share > 1.0 ? speed * speed / (2.0 * kMost) - (length - way(t2)) : 0.0;
        double most_behind = 0.0;
        for (int i = 0; i < 2 * rate; ++i) {
          scene.step();
          most_behind = std::max(most_behind,
                                 scene.bodies[0].pose.translation.x() - scene.bodies[1].pose.translation.x());
          CHECK(scene.report.failsafe_steps == 0);
        }
        INFO((is_shell ? "shell" : "box") << ", " << rate << " steps a second, " << share << " mu g");
        CHECK(scene.bodies[0].pose.translation.x() == Approx(length).epsilon(1e-12));
        CHECK(most_behind == Approx(behind).margin(0.01 * length));
        CHECK(scene.bodies[1].pose.translation.x() == Approx(length - behind + ahead).epsilon(0.01));
        if (share < 1.0) CHECK(most_behind < 1e-3 * length);
      }
    }
  }
}

TEST_CASE("a lift carries its load's weight and what speeds it up, and lets it sleep when it has stopped") {
  test::Scene scene;
  auto& lift = scene.add(test::make_box(Vec3(0.5, 0.05, 0.5), Vec3::Zero()));
  follow(lift, {at(0.5, Vec3(0, 0, 0)), at(2.0, Vec3(0, 1.5, 0))});  // 4 m/s2 at most
  auto& load = scene.add(test::make_box(Vec3::Constant(0.1), Vec3(0, 0.15 + 1e-4, 0)));
  const double mass = load.shape->mass;
  double impulse = 0.0;
  for (int i = 0; i < 480; ++i) {
    scene.step();
    for (const auto& entry : scene.log) impulse += (entry.body_a == 2 ? 1.0 : -1.0) * entry.impulse_world.y();
    const double apart = scene.bodies[1].pose.translation.y() - scene.bodies[0].pose.translation.y();
    CHECK(apart > 0.15);
    CHECK(apart < 0.151);
  }
  CHECK(impulse == Approx(mass * kG * 2.0).epsilon(1e-3));
  CHECK(scene.bodies[0].pose.translation.y() == Approx(1.5).epsilon(1e-12));
  for (int i = 0; i < 240; ++i) scene.step();
  CHECK_FALSE(scene.bodies[1].is_awake);
  CHECK(scene.bodies[0].velocity.norm() == 0.0);
}

TEST_CASE("what stands on a lift that stops dead flies on by v2 / 2g") {
  constexpr double kSpeed = 2.0;
  for (const bool is_plane : {false, true}) {
    test::Scene scene;
    auto& lift =
        scene.add(is_plane ? test::make_plane() : test::make_box(Vec3(0.5, 0.05, 0.5), Vec3::Zero()));
    const double top = is_plane ? 0.0 : 0.05;
    follow(lift, {at(0, Vec3(0, 0, 0)), at(1, Vec3(0, kSpeed, 0))}, Between::straight);
    lift.restitution = 0.0;
    auto& load = scene.add(test::make_box(Vec3::Constant(0.1), Vec3(0, top + 0.1001, 0)));
    load.velocity = Vec3(0, kSpeed, 0);
    load.restitution = 0.0;
    double highest = 0.0;
    for (int i = 0; i < 360; ++i) {
      scene.step();
      highest = std::max(highest, scene.bodies[1].pose.translation.y());
      CHECK(scene.bodies[1].pose.translation.y() - scene.bodies[0].pose.translation.y() > top + 0.1);
    }
    INFO((is_plane ? "plane" : "box"));
    CHECK(highest - (kSpeed + top + 0.1001) == Approx(kSpeed * kSpeed / (2.0 * kG)).epsilon(0.02));
  }
}

TEST_CASE("a press yields to a crate on the floor, rises with its path, and goes on when the crate is gone") {
  for (const int rate : {60, 240, 960}) {
    test::Scene scene;
    scene.settings.time_step = 1.0 / rate;
    scene.add(test::make_plane());
    scene.add(test::make_shell(crate_mesh(Vec3::Constant(0.2), Vec3(0, 0.2002, 0))));
    auto& press = scene.add(test::make_box(Vec3(0.4, 0.1, 0.4), Vec3::Zero()));
    follow(press, {at(0, Vec3(0, 1, 0)), at(1, Vec3(0, 0.2, 0)), at(2, Vec3(0, 0.2, 0)), at(3, Vec3(0, 1, 0)),
                   at(4, Vec3(0, 0.2, 0))});
    audit::Audit audit;
    double lowest = 1.0, fastest = 0.0, unexplained = 0.0;
    long cut = 0;
    for (int i = 0; i < 3 * rate; ++i) {
      Vec3 gained = -scene.momentum();
      step(scene, audit);
      gained += scene.momentum() - scene.bodies[1].shape->mass / rate * scene.settings.gravity;
      for (const auto& entry : scene.log)
        gained -= entry.body_a == 2 ? entry.impulse_world : Vec3(-entry.impulse_world);
      if (scene.bodies[1].is_awake) unexplained = std::max(unexplained, gained.norm());
      lowest = std::min(lowest, scene.bodies[2].pose.translation.y());
      fastest = std::max(fastest, scene.bodies[1].velocity.norm());
      cut += scene.report.failsafe_steps;
      if (i == 2 * rate - 1) {
        CHECK(dynamics::distance_behind(scene.bodies[2]) == Approx(0.3).epsilon(0.01));
        CHECK(scene.bodies[1].pose.translation.y() == Approx(0.2).margin(0.001));
      }
    }
    INFO(rate << " steps a second: lowest " << lowest << " m, crate's fastest " << fastest << " m/s, cut "
              << cut);
    CHECK(unexplained < 1e-9);  // N s
    CHECK(lowest == Approx(0.5).margin(0.002));
    CHECK(lowest > 0.5);
    CHECK(fastest < 1.3);  // the press's own top speed, and what restitution gives
    CHECK(cut <= 2);
    CHECK(scene.bodies[2].pose.translation.y() == Approx(1.0).epsilon(1e-9));
    scene.bodies.erase(scene.bodies.begin() + 1);
    for (int i = 0; i < rate + 1; ++i) step(scene, audit);
    CHECK(scene.bodies[1].pose.translation.y() == Approx(0.2).epsilon(1e-9));
    CHECK(audit.report().crossings == 0);
    CHECK(audit.report().passages == 0);
  }
}

TEST_CASE("a ram strikes what stands still and can break as a free ball of its mass, and pushes on") {
  constexpr double kSpeed = 3.0, kRadius = 0.1, kBounce = 0.4;
  for (const int rate : {30, 60, 240, 960}) {
    for (const double from : {0.5037, 0.61}) {
      test::Scene scene;
      scene.settings.time_step = 1.0 / rate;
      auto& held = scene.add(test::make_shell(test::square_mesh(0.5, 4), false));
      held.may_break = true;
      held.restitution = kBounce;
      auto& ram = scene.add(test::make_sphere(kRadius, Vec3::Zero()));
      ram.restitution = kBounce;
      follow(ram, {at(0, Vec3(0.05, from, 0)), at(1, Vec3(0.05, from - kSpeed, 0))}, Between::straight);
      audit::Audit audit;
      double given = 0.0, before = 0.0, fastest = 0.0;
      int steps = 0;
      // Until it was stopped: then it has been told to wait.
      while (scene.bodies[1].script.blows == 0 && ++steps < rate) {
        step(scene, audit);
        for (const auto& entry : scene.log) given += entry.impulse_world.norm();
      }
      INFO(rate << " steps a second from " << from << " m");
      CHECK(std::abs(steps - (from - kRadius) / kSpeed * rate) < 2.0);
      CHECK(given == Approx(scene.bodies[1].shape->mass * kSpeed * (1.0 + kBounce)).epsilon(0.02));
      CHECK(scene.bodies[1].velocity.y() == Approx(kBounce * kSpeed).epsilon(0.05));
      CHECK_FALSE(scene.bodies[1].is_dynamic());
      // It does not pass, and each blow is that of something twice as heavy.
      for (int i = 0; i < rate; ++i) {
        step(scene, audit);
        double blow = 0.0;
        for (const auto& entry : scene.log) blow += entry.impulse_world.norm();
        fastest = std::max(fastest, scene.bodies[1].velocity.norm());
        if (scene.bodies[1].script.blows > 3 && before == 0.0) before = given;
        given += blow;
        CHECK(scene.bodies[1].pose.translation.y() > kRadius);
      }
      CHECK(before > 0.0);
      CHECK(given > 4.0 * before);
      CHECK(fastest <= kSpeed * (1.0 + 1e-8));
      CHECK(audit.report().crossings == 0);
      CHECK(audit.report().passages == 0);
      // What cannot break is of no concern to it: it goes on through it, as before, to where it is to be.
      scene.bodies.erase(scene.bodies.begin());
      for (int i = 0; i < 3 * rate; ++i) scene.step();
      CHECK(dynamics::distance_behind(scene.bodies[0]) < 1e-12);
      CHECK(scene.bodies[0].script.blows == 0);
    }
  }
}

TEST_CASE("two rams that meet on one held plate strike it from both sides, and a turning one glances off") {
  for (const int rate : {60, 240}) {
    test::Scene scene;
    scene.settings.time_step = 1.0 / rate;
    scene.add(test::make_shell(test::square_mesh(0.5, 4), false)).may_break = true;
    follow(scene.add(test::make_sphere(0.1, Vec3::Zero())),
           {at(0, Vec3(0.02, 0.4, 0)), at(0.3, Vec3(0.02, -0.4, 0))});
    follow(scene.add(test::make_box(Vec3::Constant(0.08), Vec3::Zero())),
           {at(0, Vec3(0.05, -0.4, 0)), at(0.3, Vec3(0.05, 0.4, 0))}, Between::straight);
    follow(scene.add(test::make_box(Vec3(0.3, 0.02, 0.02), Vec3::Zero())),
           {at(0, Vec3(0.4, 0.2, 0.1)), at(1, Vec3(0.4, -0.1, 0.1), Vec3(0, 0, 12))});
    audit::Audit audit;
    for (int i = 0; i < rate; ++i) step(scene, audit);
    INFO(rate << " steps a second");
    CHECK(scene.bodies[1].pose.translation.y() > 0.1);
    CHECK(scene.bodies[2].pose.translation.y() < -0.08);
    for (std::size_t k = 1; k < 4; ++k) CHECK(scene.bodies[k].script.blows > 0);
    CHECK(audit.report().crossings == 0);
    CHECK(audit.report().passages == 0);
  }
}

TEST_CASE("a ram strikes what stands against a wall as a free block of its mass would") {
  // A crate that can break between a ram and a wall: the blow, in N s, that the crate gets from the ram.
  const auto blow_of = [](int rate, bool is_scripted) {
    test::Scene scene;
    scene.settings.time_step = 1.0 / rate;
    scene.settings.gravity.setZero();
    scene.add(test::make_box(Vec3(1, 1, 0.1), Vec3(0, 0, -0.3001), false));
    auto& crate = scene.add(test::make_shell(crate_mesh(Vec3::Constant(0.2), Vec3::Zero())));
    crate.may_break = true;
    auto& ram = scene.add(test::make_box(Vec3::Constant(0.15), Vec3(0, 0, 0.7037)));
    ram.locked.turns = {true, true, true};
    ram.velocity = Vec3(0, 0, -3.0);
    if (is_scripted) {
      ram.locked = {};
      follow(ram, {at(0, Vec3(0, 0, 0.7037)), at(1, Vec3(0, 0, 0.7037 - 3.0))}, Between::straight);
    }
    double given = 0.0;
    for (int i = 0; i < rate / 5 && given == 0.0; ++i) {
      scene.step();
      for (const auto& entry : scene.log)
        if (entry.body_a == 3 || entry.body_b == 3) given += entry.impulse_world.norm();
    }
    return given / (scene.bodies[2].shape->mass * 3.0);
  };
  for (const int rate : {60, 240, 960}) {
    INFO(rate << " steps a second");
    const double scripted = blow_of(rate, true);
    CHECK(scripted == Approx(blow_of(rate, false)).epsilon(0.05));
    CHECK(scripted > 1.0);  // it comes to rest,
    CHECK(scripted < 2.0);  // or bounces
  }
}

TEST_CASE("what a press squeezes keeps the books when the press is held up") {
  // Begun warmer, a crate in flight was opened from another before all was solved anew.
  for (const auto& [seed, rate, warm] :
       {std::tuple(3, 60, 0.95), {15, 60, 0.95}, {15, 60, 0.98}, {16, 240, 0.95}}) {
    test::Scene scene;
    scene.settings.time_step = 1.0 / rate;
    scene.settings.warm_start = warm;
    scene.settings.has_sleep = false;
    scene.add(test::make_plane());
    core::Random random(static_cast<std::uint64_t>(seed));
    for (int k = 0; k < 24; ++k) {
      auto& crate = scene.add(test::make_shell(crate_mesh(Vec3(0.1, 0.02, 0.08), Vec3::Zero())));
      crate.pose.translation = Vec3(0.22 * (k % 4) - 0.3, 0.09 + 0.16 * (k / 8), 0.2 * ((k / 4) % 2));
      crate.pose.rotation =
          Quat(Eigen::AngleAxisd(random.uniform(-0.8, 0.8), Vec3(random.uniform(-1, 1), 2, 1).normalized()));
    }
    auto& press = scene.add(test::make_box(Vec3(0.6, 0.05, 0.6), Vec3::Zero()));
    follow(press, {at(0, Vec3(0, 0.9, 0)), at(0.25, Vec3(0, 0.1, 0)), at(0.5, Vec3(0, 0.9, 0)),
                   at(0.75, Vec3(0, 0.1, 0))});
    audit::Audit audit;
    double unexplained = 0.0, behind = 0.0;
    for (int i = 0; i < rate; ++i) {
      Vec3 gained = -scene.momentum();
      step(scene, audit);
      gained += scene.momentum();
      for (const auto& b : scene.bodies)
        if (b.is_dynamic()) gained -= b.shape->mass / rate * scene.settings.gravity;
      const auto can_move = [&](body::BodyId id) {
        const body::Body* b = body::find_body(scene.bodies, id);
        return b != nullptr && b->is_dynamic();
      };
      for (const auto& entry : scene.log) {
        if (can_move(entry.body_a)) gained -= entry.impulse_world;
        if (can_move(entry.body_b)) gained += entry.impulse_world;
      }
      unexplained = std::max(unexplained, gained.norm());
      behind = std::max(behind, dynamics::distance_behind(scene.bodies.back()));
    }
    INFO(rate << " steps a second, " << behind << " m behind");
    CHECK(behind > 0.05);
    CHECK(unexplained < 1e-9);  // N s
    CHECK(audit.report().crossings == 0);
    CHECK(audit.report().passages == 0);
  }
}

TEST_CASE("a press that something leaves comes on and catches up, no faster than it ever goes") {
  test::Scene scene;
  scene.add(test::make_plane());
  scene.add(test::make_box(Vec3::Constant(0.1), Vec3(0, 0.1001, 0)));
  auto& press = scene.add(test::make_box(Vec3(0.4, 0.05, 0.4), Vec3::Zero()));
  follow(press, {at(0, Vec3(0, 0.6, 0)), at(0.5, Vec3(0, 0.1, 0))});
  for (int i = 0; i < 240; ++i) scene.step();
  CHECK(scene.bodies[2].pose.translation.y() == Approx(0.25).margin(0.001));
  scene.bodies.erase(scene.bodies.begin() + 1);
  double fastest = 0.0;
  for (int i = 0; i < 240; ++i) {
    scene.step();
    fastest = std::max(fastest, scene.bodies[1].velocity.norm());
  }
  CHECK(fastest <= scene.bodies[1].script.path->top_speed() * (1.0 + 1e-8));
  CHECK(scene.bodies[1].pose.translation.y() == Approx(0.1).epsilon(1e-9));
  CHECK(dynamics::distance_behind(scene.bodies[1]) < 1e-12);
}

TEST_CASE("an arm sweeps cards before it at 60 steps a second, and passes none") {
  test::Scene scene;
  scene.settings.time_step = 1.0 / 60.0;
  scene.settings.gravity.setZero();
  auto& arm = scene.add(test::make_box(Vec3(0.5, 0.05, 0.02), Vec3::Zero()));
  // Half a turn about its end in half a second: 9.4 rad/s at most, 0.16 m a step at the tip.
  follow(arm, {at(0.1, Vec3::Zero()), at(0.6, Vec3::Zero(), Vec3(0, -core::kPi, 0))}, Between::smooth,
         Vec3(-0.5, 0, 0));
  constexpr int kCards = 12;
  std::vector<Vec3> places;
  for (int k = 0; k < kCards; ++k) {
    const double turn = core::kPi * (k + 1.0) / (kCards + 2.0);
    auto& card = scene.add(test::make_shell(test::square_mesh(0.04, 2)));
    // Upright, in the way of the arm.
    card.pose.rotation =
        Quat(Eigen::AngleAxisd(-turn, Vec3::UnitY()) * Eigen::AngleAxisd(0.5 * core::kPi, Vec3::UnitX()));
    const double out = 0.35 + 0.2 * (k % 3);
    places.emplace_back(out * std::cos(turn), 0.0, out * std::sin(turn));
    card.pose.translation = places.back();
  }
  audit::Audit audit;
  for (int i = 0; i < 60; ++i) step(scene, audit);
  CHECK(audit.report().crossings == 0);
  CHECK(audit.report().passages == 0);
  CHECK((scene.bodies[0].pose.translation - Vec3(-0.5, 0, 0)).norm() < 1e-9);  // it was not held up
  for (std::size_t k = 0; k < kCards; ++k) {
    INFO("card " << k);
    CHECK((scene.bodies[k + 1].pose.translation - places[k]).norm() > 0.3);
    CHECK(scene.bodies[k + 1].velocity.norm() > 1.0);
  }
}

TEST_CASE("a plate that creeps carries what rests on it, and wakes it") {
  test::Scene scene;
  auto& plate = scene.add(test::make_box(Vec3(0.5, 0.05, 0.5), Vec3::Zero()));
  follow(plate, {at(1.0, Vec3(0, 0, 0)), at(3.0, Vec3(0.001, 0, 0))}, Between::straight);
  scene.add(test::make_box(Vec3::Constant(0.1), Vec3(0, 0.1501, 0)));
  for (int i = 0; i < 230; ++i) scene.step();
  CHECK_FALSE(scene.bodies[1].is_awake);
  for (int i = 0; i < 480; ++i) {
    scene.step();
    if (i > 20 && i < 470) CHECK(scene.bodies[1].is_awake);
  }
  CHECK(scene.bodies[1].pose.translation.x() == Approx(0.001).epsilon(0.03));
  for (int i = 0; i < 240; ++i) scene.step();
  CHECK_FALSE(scene.bodies[1].is_awake);
}

TEST_CASE("scripted bodies give the same bits from a copy of the state, and on any number of threads") {
  const auto make = [] {
    test::Scene scene;
    scene.add(test::make_plane());
    auto& arm = scene.add(test::make_box(Vec3(0.5, 0.05, 0.02), Vec3::Zero()));
    follow(arm, {at(0, Vec3(0, 0.06, 0)), at(1, Vec3(0, 0.06, 0), Vec3(0, 6, 0))});
    auto& press = scene.add(test::make_shell(test::square_mesh(0.5, 2)));
    follow(press, {at(0, Vec3(0, 0.5, 0)), at(1, Vec3(0, 0.0, 0))});
    for (int k = 0; k < 6; ++k) {
      auto& card = scene.add(test::make_shell(test::square_mesh(0.05, 2)));
      card.pose.rotation = Quat(Eigen::AngleAxisd(0.4 * k, Vec3(1, 1, k).normalized()));
      card.pose.translation = Vec3(0.3, 0.2, 0.12 * (k - 3));
    }
    return scene;
  };
  test::Scene scene = make(), other = make();
  for (int i = 0; i < 120; ++i) scene.step();
  test::Scene copy = scene;
  for (int i = 0; i < 120; ++i) {
    scene.step();
    copy.step();
    REQUIRE(scene.hash() == copy.hash());
  }
  core::set_thread_count(1);
  for (int i = 0; i < 240; ++i) other.step();
  core::set_thread_count(0);
  CHECK(scene.hash() == other.hash());
}

}  // namespace shatterbox
