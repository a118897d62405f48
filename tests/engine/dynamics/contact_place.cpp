// Contacts whose bodies turn: where they are against where the features are in truth, and what that is worth.
#include "engine/dynamics/contact_place.h"

#include <catch2/catch.hpp>

#include "engine/collision/analytic_contact.h"
#include "tests/engine/draw.h"
#include "tests/engine/dynamics/bodies.h"

namespace shatterbox::dynamics {
namespace {

/// A body of the step, its start, and where it has gone.
struct Turner {
  body::Body body;
  WorkBody work;
  Moved moved;
  Pose now;

  Turner(body::Body of, double turn, core::Random& random) : body(std::move(of)) {
    work.shape = body.shape.get();
    work.start = body.pose;
    const Quat by(Eigen::AngleAxisd(turn, test::draw_vector(random).normalized()));
    moved = {0.05 * test::draw_vector(random), by.toRotationMatrix()};
    now = {by * body.pose.rotation, body.pose.translation + moved.way};
  }
};

geometry::TriangleMesh lone_triangle(const Vec3& p, const Vec3& q, const Vec3& r) {
  geometry::TriangleMesh mesh;
  mesh.positions = {p, q, r};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

}  // namespace

TEST_CASE("a vertex over a face and an edge over an edge have their true gap wherever their bodies turn") {
  core::Random random(23);
  for (int n = 0; n < 200; ++n) {
    INFO("try " << n);
    const bool is_edges = n % 2 == 0;
    // The face lies flat; a corner, or an edge, of the other stands over it.
    const Turner below(test::make_shell(lone_triangle(Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, 0, 1))), 0.3,
                       random);
    const Turner above(
        is_edges ? test::make_shell(lone_triangle(Vec3(0.2, 0.1, -2), Vec3(-0.3, 0.1, 0), Vec3(0, 1, -1)))
                 : test::make_shell(lone_triangle(Vec3(0, 0.1, 0), Vec3(1, 1, 0), Vec3(0, 1, 1))),
        0.3, random);
    const collision::FeatureKind kind =
        is_edges ? collision::FeatureKind::edge_edge : collision::FeatureKind::vertex_triangle;
    const auto a = collision::make_collider(*above.body.shape),
               b = collision::make_collider(*below.body.shape);
    const collision::FeaturePair features{kind, 0.0F, 0, 0};
    const auto start = collision::gather(features, *a, above.work.start, *b, below.work.start);
    const auto found = collision::contact_here(features, start, collision::measure(start, Vec3::UnitY()));
    REQUIRE(found.normal_of == (is_edges ? collision::NormalOf::edges : collision::NormalOf::face_b));
    const PlacedContact placed = place_contact(above.work, above.moved, below.work, below.moved, found);
    const auto end = collision::gather(features, *a, above.now, *b, below.now);
    const Vec3 across = is_edges ? (end.points[1] - end.points[0]).cross(end.points[3] - end.points[2])
                                 : (end.points[2] - end.points[1]).cross(end.points[3] - end.points[1]);
    const Vec3 normal = across.normalized() * (across.dot(placed.normal) < 0.0 ? -1.0 : 1.0);
    CHECK((placed.normal - normal).norm() < 1e-12);
    CHECK(placed.gap == Approx(normal.dot(end.points[0] - end.points[3])).margin(1e-12));
    CHECK(above.now.translation + placed.arm_a ==
          above.now.translation + above.moved.turn * (found.on_a - above.work.start.translation));
  }
}

TEST_CASE("a ball has its true gap over a face, a box and a ball wherever they turn") {
  core::Random random(29);
  for (int n = 0; n < 100; ++n) {
    INFO("try " << n);
    const Turner ball(test::make_sphere(0.2, Vec3(0.1, 0.35, 0.05)), 0.3, random);
    const Turner box(test::make_box(Vec3(1, 0.1, 1), Vec3::Zero()), 0.3, random);
    const Turner other(test::make_sphere(0.1, Vec3(0, 0, 0)), 0.3, random);
    const Turner face(test::make_shell(lone_triangle(Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, 0, 1))), 0.3,
                      random);
    for (const Turner* solid : {&box, &other}) {
      const auto found = collision::find_ball_contact(*ball.work.shape, ball.work.start, *solid->work.shape,
                                                      solid->work.start);
      const auto now =
          collision::find_ball_contact(*ball.work.shape, ball.now, *solid->work.shape, solid->now);
      const PlacedContact placed = place_contact(ball.work, ball.moved, solid->work, solid->moved, found);
      CHECK(placed.gap == Approx(now.gap).margin(1e-12));
      CHECK((placed.normal - now.normal).norm() < 1e-12);
    }
    const auto a = collision::make_collider(*ball.body.shape), b = collision::make_collider(*face.body.shape);
    const collision::FeaturePair features{collision::FeatureKind::vertex_triangle, 0.0F, 0, 0};
    const auto start = collision::gather(features, *a, ball.work.start, *b, face.work.start);
    const auto found = collision::contact_here(features, start, collision::measure(start, Vec3::UnitY()));
    const PlacedContact placed = place_contact(ball.work, ball.moved, face.work, face.moved, found);
    const Vec3 normal = face.moved.turn * Vec3::UnitY();
    CHECK(placed.gap ==
          Approx(normal.dot(ball.now.translation - face.now.apply(Vec3::Zero())) - 0.2).margin(1e-12));
    CHECK((placed.arm_a + 0.2 * normal).norm() < 1e-12);
  }
}

TEST_CASE("axes that turn keep across each other, and what was given as it is in the world") {
  core::Random random(31);
  for (int n = 0; n < 100; ++n) {
    SolverContact c;
    c.found.normal = test::draw_vector(random).normalized();
    c.tangent_start = c.found.normal.cross(test::draw_vector(random)).normalized();
    reset_axes(c);
    c.impulse = test::draw_vector(random);
    const auto given = [&] {
      return Vec3(c.impulse[0] * c.normal + c.impulse[1] * c.tangent_u + c.impulse[2] * c.tangent_v);
    };
    const Vec3 before = given();
    turn_axes(c, n == 0 ? Vec3(-c.normal) : test::draw_vector(random).normalized());
    CHECK((given() - before).norm() < 1e-12);
    CHECK(std::abs(c.normal.dot(c.tangent_u)) < 1e-12);
    CHECK((c.normal.cross(c.tangent_u) - c.tangent_v).norm() < 1e-12);
    CHECK(c.tangent_u.norm() == Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("a row of dominoes falls at 60 steps a second and none is held back on its way") {
  // Each turns by a tenth of a radian a step while it slides down on the face of the next.
  for (const int rate : {60, 120, 240}) {
    test::Scene scene;
    scene.settings.time_step = 1.0 / rate;
    scene.add(test::make_plane());
    for (int i = 0; i < 8; ++i) {
      auto domino = test::make_box(Vec3(0.004, 0.024, 0.012), Vec3(0.02 * i, 0.02402, 0), true, 1200.0);
      domino.friction = 0.2;
      if (i == 0) domino.angular_velocity.z() = -10.0;
      scene.add(domino);
    }
    int hits = 0, cut = 0;
    for (int i = 0; i < 2 * rate; ++i) {
      scene.step();
      hits += scene.report.hits;
      cut += scene.report.failsafe_steps;
    }
    INFO(rate << " steps a second: " << hits << " hits on the way");
    CHECK(cut == 0);
    const Vec3 last = scene.bodies.back().pose.rotation * Vec3::UnitY();
    CHECK(last.y() < 0.5);
  }
}

}  // namespace shatterbox::dynamics
