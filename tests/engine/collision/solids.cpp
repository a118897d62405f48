// Broad phase, spheres, boxes and planes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "engine/collision/analytic_contact.h"
#include "engine/collision/broad_phase.h"
#include "engine/core/random.h"

namespace shatterbox::collision {
namespace {

body::Shape box(const Vec3& half) {
  body::Shape shape;
  shape.kind = body::ShapeKind::box;
  shape.half_extent = half;
  return shape;
}

body::Shape sphere(double radius) {
  body::Shape shape;
  shape.kind = body::ShapeKind::sphere;
  shape.radius = radius;
  return shape;
}

Pose at(double x, double y, double z) {
  Pose pose;
  pose.translation = Vec3(x, y, z);
  return pose;
}

}  // namespace

TEST_CASE("sort and sweep finds what brute force finds") {
  // Many that move, few, none.
  const double share = GENERATE(0.7, 0.1, 0.0);
  core::Random random(4);
  std::vector<SweptBound> bounds(120);
  for (auto& bound : bounds) {
    Vec3 centre;
    for (int i = 0; i < 3; ++i) centre[i] = random.uniform(-1, 1);
    const double half = random.uniform(0.01, 0.2);
    bound.box = {centre - Vec3::Constant(half), centre + Vec3::Constant(half)};
    bound.is_moving = random.uniform() < share;
  }
  std::vector<std::pair<int, int>> expected, found;
  for (int i = 0; i < 120; ++i) {
    for (int j = i + 1; j < 120; ++j) {
      const auto &a = bounds[static_cast<std::size_t>(i)], &b = bounds[static_cast<std::size_t>(j)];
      if ((a.is_moving || b.is_moving) && geometry::overlaps(a.box, b.box)) expected.emplace_back(i, j);
    }
  }
  for (const auto& pair : find_overlapping_pairs(bounds)) found.emplace_back(pair.a, pair.b);
  CHECK(found == expected);
}

TEST_CASE("gaps and directions of spheres and boxes, apart and overlapping") {
  for (const double gap : {0.25, -0.01}) {
    std::vector<Contact> contacts;
    find_analytic_contacts(sphere(0.5), at(0, 0, 0), sphere(1.0), at(1.5 + gap, 0, 0), 1.0, contacts);
    REQUIRE(contacts.size() == 1);
    CHECK(contacts[0].gap == Approx(gap));
    CHECK((contacts[0].normal - Vec3(-1, 0, 0)).norm() < 1e-12);
    contacts.clear();
    find_analytic_contacts(box(Vec3(1, 1, 1)), at(0, 0, 0), sphere(0.5), at(0.2, 1.5 + gap, 0.1), 1.0,
                           contacts);
    REQUIRE(contacts.size() == 1);
    CHECK(contacts[0].gap == Approx(gap));
    CHECK((contacts[0].normal - Vec3(0, -1, 0)).norm() < 1e-12);
    contacts.clear();
    find_analytic_contacts(box(Vec3(1, 1, 1)), at(0, 2 + gap, 0), box(Vec3(2, 1, 0.5)), at(0, 0, 0), 1.0,
                           contacts);
    REQUIRE(contacts.size() == 4);
    for (const auto& c : contacts) {
      CHECK(c.gap == Approx(gap));
      CHECK((c.normal - Vec3(0, 1, 0)).norm() < 1e-12);
      CHECK(std::abs(c.on_a.z()) == Approx(0.5));
      CHECK(std::abs(c.on_a.x()) == Approx(1.0));
    }
  }
}

TEST_CASE("crossed edges of two boxes touch with their edges") {
  Pose upper = at(0, 2.0 * std::sqrt(2.0) + 0.1, 0);
  upper.rotation = Quat(std::cos(0.392699), 0, 0, std::sin(0.392699));
  Pose lower = at(0, 0, 0);
  lower.rotation = Quat(std::cos(0.392699), std::sin(0.392699), 0, 0);
  std::vector<Contact> contacts;
  find_analytic_contacts(box(Vec3(1, 1, 1)), upper, box(Vec3(1, 1, 1)), lower, 1.0, contacts);
  REQUIRE(contacts.size() == 1);
  CHECK(contacts[0].gap == Approx(0.1).epsilon(1e-4));
  CHECK((contacts[0].normal - Vec3(0, 1, 0)).norm() < 1e-4);
}

TEST_CASE("boxes that an axis tells apart by however little have a gap") {
  core::Random random(7);
  const auto direction = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
  int by_edges = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto any = [&] { return random.uniform(0.01, 0.1); };
    const body::Shape a = box(Vec3(any(), any(), any())), b = box(Vec3(any(), any(), any()));
    Pose pose_a, pose_b;
    for (Pose* pose : {&pose_a, &pose_b})
      pose->rotation = Quat(Eigen::AngleAxisd(random.uniform(0.0, 3.0), direction().normalized()));
    const Mat3 ra = pose_a.rotation.toRotationMatrix(), rb = pose_b.rotation.toRotationMatrix();
    const auto gap_along = [&](const Vec3& axis, const Vec3& way) {
      return std::abs(axis.dot(way)) - (ra.transpose() * axis).cwiseAbs().dot(a.half_extent) -
             (rb.transpose() * axis).cwiseAbs().dot(b.half_extent);
    };
    const auto gaps = [&](const Vec3& way) {
      double faces = -1e300, all = -1e300;
      for (int i = 0; i < 3; ++i)
        faces = std::max({faces, gap_along(ra.col(i), way), gap_along(rb.col(i), way)});
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const Vec3 cross = ra.col(i).cross(rb.col(j));
          if (cross.norm() > 1e-3) all = std::max(all, gap_along(cross.normalized(), way));
        }
      return std::pair(faces, std::max(all, faces));
    };
    // Out along a line until no face has them in each other by more than 1e-8.
    const Vec3 line = direction().normalized();
    double near = 0.0, far = 1.0;
    for (int k = 0; k < 80; ++k) {
      const double middle = 0.5 * (near + far);
      (gaps(middle * line).first < -1e-8 ? near : far) = middle;
    }
    pose_a.translation = far * line;
    Vec3 normal;
    const double gap = analytic_gap(a, pose_a, b, pose_b, normal);
    const auto [faces, all] = gaps(pose_a.translation);
    CHECK(std::abs(gap - all) < 1e-14);
    CHECK(std::abs(normal.norm() - 1.0) < 1e-12);
    CHECK(std::abs(gap_along(normal, pose_a.translation) - gap) < 1e-14);
    by_edges += faces < 0.0 && all > 1e-8 ? 1 : 0;
  }
  CHECK(by_edges > 100);
}

}  // namespace shatterbox::collision
