#include "engine/body/body.h"

#include <catch2/catch.hpp>

using namespace shatterbox;

namespace {

body::Body make_box(body::BodyId id, const Vec3& half_extent, double density) {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::box;
  shape->half_extent = half_extent;
  shape->mass = 8.0 * density * half_extent.prod();
  const Vec3 squares = half_extent.cwiseProduct(half_extent);
  for (int i = 0; i < 3; ++i) shape->inertia(i, i) = shape->mass / 3.0 * (squares.sum() - squares[i]);
  body::Body body;
  body.id = id;
  body.inverse_mass = 1.0 / shape->mass;
  body.inverse_inertia = shape->inertia.inverse();
  body.shape = shape;
  return body;
}

}  // namespace

TEST_CASE("kinetic energy and angular momentum follow from rigid motion") {
  body::Body body = make_box(1, Vec3(0.1, 0.2, 0.3), 1000.0);
  body.pose.translation = Vec3(1.0, 2.0, 3.0);
  body.pose.rotation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  body.velocity = Vec3(1.0, -2.0, 0.5);
  // A spin about the body's own z axis meets only the moment of inertia about that axis.
  body.angular_velocity = body.pose.rotation * Vec3(0.0, 0.0, 5.0);
  const double mass = body.shape->mass;
  const double about_z = mass / 3.0 * (0.01 + 0.04);
  CHECK(body::kinetic_energy(body) ==
        Approx(0.5 * mass * body.velocity.squaredNorm() + 0.5 * about_z * 25.0).epsilon(1e-14));
  const Vec3 expected = mass * body.pose.translation.cross(body.velocity) + about_z * body.angular_velocity;
  CHECK((body::angular_momentum(body) - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("a fixed body has no energy and no momentum") {
  body::Body body = make_box(1, Vec3::Constant(0.1), 1000.0);
  body.velocity = Vec3(1, 0, 0);
  body.inverse_mass = 0.0;
  CHECK(body::kinetic_energy(body) == 0.0);
  CHECK(body::angular_momentum(body).norm() == 0.0);
}

TEST_CASE("bodies are found by id, and only those that are there") {
  std::vector<body::Body> bodies;
  for (const body::BodyId id : {2u, 5u, 9u}) bodies.push_back(make_box(id, Vec3::Ones(), 1.0));
  REQUIRE(body::find_body(bodies, 5) == &bodies[1]);
  REQUIRE(body::find_body(bodies, 9) == &bodies[2]);
  CHECK(body::find_body(bodies, 4) == nullptr);
  CHECK(body::find_body(bodies, 10) == nullptr);
}
