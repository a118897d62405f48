// Bodies for the tests of motion, and one step of the whole motion.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "engine/body/body.h"
#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/dynamics/motion_work.h"
#include "engine/dynamics/step_motion.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"

namespace shatterbox::test {

inline body::Body make_body(std::shared_ptr<body::Shape> shape, const Vec3& position, bool is_dynamic) {
  body::Body b;
  b.shape = shape;
  b.pose.translation = position;
  b.motion = is_dynamic ? body::Motion::dynamic : body::Motion::fixed;
  if (is_dynamic) {
    b.inverse_mass = 1.0 / shape->mass;
    b.inverse_inertia = shape->inertia.inverse();
  }
  return b;
}

inline body::Body make_plane() {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::plane;
  return make_body(shape, Vec3::Zero(), false);
}

inline body::Body make_sphere(double radius, const Vec3& position, double density = 1000.0) {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::sphere;
  shape->radius = shape->bounding_radius = radius;
  shape->mass = density * 4.0 / 3.0 * core::kPi * radius * radius * radius;
  shape->inertia = Mat3::Identity() * (0.4 * shape->mass * radius * radius);
  return make_body(shape, position, true);
}

/// Along y, `half` of its axis on either side of the middle.
inline body::Body make_capsule(double radius, double half, const Vec3& position, double density = 1000.0) {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::capsule;
  shape->radius = radius;
  shape->half_length = half;
  shape->bounding_radius = radius + half;
  const auto mass = geometry::capsule_mass_properties(radius, half, density);
  shape->mass = mass.mass;
  shape->inertia = mass.inertia;
  return make_body(shape, position, true);
}

inline body::Body make_box(const Vec3& half, const Vec3& position, bool is_dynamic = true,
                           double density = 1000.0) {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::box;
  shape->half_extent = half;
  shape->bounding_radius = half.norm();
  shape->mass = density * 8.0 * half.prod();
  const Vec3 s = half.cwiseProduct(half);
  shape->inertia = Vec3(s.y() + s.z(), s.z() + s.x(), s.x() + s.y()).asDiagonal();
  shape->inertia *= shape->mass / 3.0;
  return make_body(shape, position, is_dynamic);
}

/// The same as a solid that ends at its surface.
inline body::Body make_solid_block(const Vec3& half, const Vec3& position, double density = 1000.0) {
  const body::Body box = make_box(half, position, true, density);
  auto shape = std::make_shared<body::Shape>(*box.shape);
  shape->kind = body::ShapeKind::solid;
  shape->surface = geometry::make_box_surface(half);
  shape->topology = geometry::build_edge_topology(shape->surface.triangles);
  return make_body(shape, position, true);
}

/// A shell of 2.5 kg/m2 from a mesh in the world; its centre of mass becomes the body's origin.
inline body::Body make_shell(geometry::TriangleMesh mesh, bool is_dynamic = true) {
  constexpr double kDensity = 2.5;
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::shell;
  Vec3 first = Vec3::Zero();
  const auto corner = [&](const geometry::Triangle& t, int i) -> const Vec3& {
    return mesh.positions[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])];
  };
  const auto mass_of = [&](const geometry::Triangle& t) {
    return 0.5 * kDensity * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
  };
  for (const auto& t : mesh.triangles) {
    shape->mass += mass_of(t);
    first += mass_of(t) / 3.0 * (corner(t, 0) + corner(t, 1) + corner(t, 2));
  }
  const Vec3 centre = first / shape->mass;
  for (Vec3& p : mesh.positions) p -= centre;
  Mat3 second = Mat3::Zero();
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {  // midpoints of edges integrate quadratics exactly
      const Vec3 middle = 0.5 * (corner(t, i) + corner(t, (i + 1) % 3));
      second += mass_of(t) / 3.0 * middle * middle.transpose();
    }
  }
  shape->inertia = second.trace() * Mat3::Identity() - second;
  for (const Vec3& p : mesh.positions) shape->bounding_radius = std::max(shape->bounding_radius, p.norm());
  shape->topology = geometry::build_edge_topology(mesh.triangles);
  shape->surface = std::move(mesh);
  shape->thickness = 1e-3;
  return make_body(shape, centre, is_dynamic);
}

/// A bowl: the part of a sphere below `top` (y, share of the radius), open above.
inline geometry::TriangleMesh bowl_mesh(double radius, int rings, int around, double top = 0.2) {
  geometry::TriangleMesh mesh;
  mesh.positions.push_back(Vec3(0, -radius, 0));
  const double reach = core::acos(-top);
  for (int r = 1; r <= rings; ++r) {
    const double polar = reach * r / rings;
    for (int k = 0; k < around; ++k) {
      const double turn = 2.0 * core::kPi * k / around;
      mesh.positions.push_back(radius * Vec3(core::sin(polar) * core::cos(turn), -core::cos(polar),
                                             core::sin(polar) * core::sin(turn)));
    }
  }
  const auto number = [&](int r, int k) { return 1 + (r - 1) * around + k % around; };
  for (int k = 0; k < around; ++k) mesh.triangles.push_back({0, number(1, k + 1), number(1, k)});
  for (int r = 1; r < rings; ++r) {
    for (int k = 0; k < around; ++k) {
      mesh.triangles.push_back({number(r, k), number(r, k + 1), number(r + 1, k)});
      mesh.triangles.push_back({number(r, k + 1), number(r + 1, k + 1), number(r + 1, k)});
    }
  }
  return mesh;
}

/// A flat square of side 2 `half` in the plane y = 0, `n` x `n` cells.
inline geometry::TriangleMesh square_mesh(double half, int n) {
  geometry::TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      mesh.positions.push_back(Vec3(half * (2.0 * i / n - 1.0), 0, half * (2.0 * j / n - 1.0)));
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

struct Scene {
  std::vector<body::Body> bodies;
  dynamics::ContactSettings settings;
  dynamics::ContactState state;
  body::ImpulseLog log;
  dynamics::ContactReport report;

  body::Body& add(body::Body b) {
    b.id = static_cast<body::BodyId>(bodies.size() + 1);
    bodies.push_back(std::move(b));
    return bodies.back();
  }
  void step() {
    log.clear();
    dynamics::wake_bodies(bodies, settings, state);
    report = dynamics::step_motion(bodies, settings, state, log);
    dynamics::put_to_sleep(bodies, settings, state);
  }
  /// The ways of one step as if nothing touched; `work` knows the pairs.
  void fly(dynamics::MotionWork& work) {
    dynamics::find_candidate_pairs(bodies, settings, state, work);
    work.contacts.clear();
    work.islands.clear();
    for (auto& b : work.bodies) b.is_free = true;
    dynamics::solve_motion(bodies, settings, work);
  }
  double kinetic() const {
    double sum = 0.0;
    for (const auto& b : bodies) sum += body::kinetic_energy(b);
    return sum;
  }
  double energy() const {
    double sum = kinetic();
    for (const auto& b : bodies) {
      if (b.is_dynamic()) sum -= b.shape->mass * settings.gravity.dot(b.pose.translation);
    }
    return sum;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (const auto& b : bodies) {
      if (b.is_dynamic()) sum += b.shape->mass * b.velocity;
    }
    return sum;
  }
  Vec3 spin() const {
    Vec3 sum = Vec3::Zero();
    for (const auto& b : bodies) sum += body::angular_momentum(b);
    return sum;
  }
  std::uint64_t hash() const {
    core::Hash h;
    for (const auto& b : bodies) {
      h.add(b.pose.rotation).add(b.pose.translation).add(b.velocity).add(b.angular_velocity);
      h.add(static_cast<std::uint64_t>(b.is_awake));
    }
    dynamics::add_to_hash(state, h);
    return h.value();
  }
  double lowest() const {
    double y = 1e300;
    for (const auto& b : bodies) {
      for (const Vec3& v : b.shape->surface.positions) y = std::min(y, b.pose.apply(v).y());
    }
    return y;
  }
};

}  // namespace shatterbox::test
