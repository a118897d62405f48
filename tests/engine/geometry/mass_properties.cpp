// Against closed forms: NUMERICS case 24 (volume, centre and inertia of polyhedra by the divergence theorem).
#include "engine/geometry/mass_properties.h"

#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "engine/geometry/generators.h"

namespace shatterbox::geometry {
namespace {

/// Greatest relative difference of inertias.
double difference(const Mat3& a, const Mat3& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.norm();
}

TriangleMesh make_box(const Vec3& half, const Vec3& centre) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(centre + Vec3(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                                           i & 4 ? half.z() : -half.z()));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

const Pose kPose{Quat(0.3, -0.5, 0.7, 0.4).normalized(), Vec3(0.3, -1.2, 2.0)};

TriangleMesh moved(TriangleMesh mesh, const Pose& pose) {
  for (Vec3& p : mesh.positions) p = pose.apply(p);
  return mesh;
}

}  // namespace

TEST_CASE("a solid box is its closed form, wherever it is") {
  const Vec3 half(0.1, 0.25, 0.7);
  const MassProperties truth = box_mass_properties(half, 900.0);
  CHECK(truth.mass == Approx(900.0 * 0.2 * 0.5 * 1.4).epsilon(1e-14));
  CHECK(truth.inertia(0, 0) == Approx(truth.mass / 12.0 * (0.5 * 0.5 + 1.4 * 1.4)).epsilon(1e-14));
  for (const Vec3& centre : {Vec3(0, 0, 0), Vec3(3, -4, 5), Vec3(1000, 1000, -1000)}) {
    const MassProperties mass = solid_mass_properties(make_box(half, centre), 900.0);
    CHECK(mass.mass == Approx(truth.mass).epsilon(1e-11));
    CHECK((mass.centre - centre).norm() < 1e-12 * (1.0 + centre.norm()));
    CHECK(difference(mass.inertia, truth.inertia) < 1e-12 * (1.0 + centre.norm()));
  }
}

TEST_CASE("a tetrahedron is its closed form") {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const double volume = 5.0;
  CHECK(enclosed_volume(mesh) == Approx(volume).epsilon(1e-14));
  const MassProperties mass = solid_mass_properties(mesh, 2.0);
  CHECK(mass.mass == Approx(2.0 * volume).epsilon(1e-14));
  CHECK((mass.centre - Vec3(0.5, 0.75, 1.25)).norm() < 1e-14);
  // About the corner at the origin: the integral of x_i x_j is m a_i a_j / 20, of x_i^2 m a_i^2 / 10.
  const Vec3 a(2, 3, 5);
  const Mat3 product = mass.mass / 20.0 * (a * a.transpose());
  const Vec3 square = mass.mass / 10.0 * a.cwiseProduct(a);
  Mat3 truth = -product;
  truth.diagonal() = Vec3(square.y() + square.z(), square.z() + square.x(), square.x() + square.y());
  CHECK(difference(inertia_about(mass, Vec3::Zero()), truth) < 1e-14);
}

TEST_CASE("the faceted solid torus is Pappus' theorem on polygons") {
  // Between two sections the solid is that between two half planes with straight lines across: a slice at
  // distance r from the axis has the length 2 r tan(pi / n) across the middle, shortened by cos^2: the volume
  // is n sin(2 pi / n) R A, with A the section's area and R its centre's distance.
  const double ring = 0.3;
  const double wire = 0.1;
  const TriangleMesh mesh = make_torus(ring, wire, {0.02, 0.0, 1}).value();
  int around = 0;  // vertices of the first section: those with z = 0 and x > 0
  for (const Vec3& p : mesh.positions) around += p.x() > 0.0 && std::abs(p.z()) < 1e-12 ? 1 : 0;
  const int along = static_cast<int>(mesh.positions.size()) / around;
  const double m = around;
  const double n = along;
  const double section = 0.5 * m * wire * wire * core::sin(2.0 * core::kPi / m);
  const double volume = n * core::sin(2.0 * core::kPi / n) * ring * section;
  // The quads between sections are flat (trapezia), so the sum of the sectors is exact.
  CHECK(enclosed_volume(mesh) == Approx(volume).epsilon(1e-12));

  const MassProperties mass = solid_mass_properties(mesh, 1000.0);
  CHECK(mass.centre.norm() < 1e-12);
  const MassProperties fine = solid_mass_properties(make_torus(ring, wire, {0.002, 0.0, 1}).value(), 1000.0);
  const double smooth = 2.0 * core::kPi * core::kPi * ring * wire * wire * 1000.0;
  CHECK(fine.mass == Approx(smooth).epsilon(1e-3));
  CHECK(fine.inertia(1, 1) == Approx(smooth * (ring * ring + 0.75 * wire * wire)).epsilon(1e-3));
  CHECK(fine.inertia(0, 0) == Approx(smooth * (0.5 * ring * ring + 0.625 * wire * wire)).epsilon(1e-3));
}

TEST_CASE("a thin rectangle, triangle and box of sheet are their closed forms") {
  const TriangleMesh pane = make_pane(0.4, 0.3, {0.05, 0.3, 3}).value();
  const MassProperties mass = shell_mass_properties(pane, 0.004, 2500.0);
  const double m = 0.4 * 0.3 * 0.004 * 2500.0;
  CHECK(mass.mass == Approx(m).epsilon(1e-13));
  CHECK(mass.centre.norm() < 1e-14);
  const Mat3 truth = Vec3(m / 12 * 0.09, m / 12 * 0.16, m / 12 * 0.25).asDiagonal();
  CHECK(difference(mass.inertia, truth) < 1e-12);

  // A hollow box of sheet with half extents h: six rectangles.
  const Vec3 h(0.1, 0.2, 0.3);
  const MassProperties hollow = shell_mass_properties(make_box(h, Vec3(5, 6, 7)), 0.001, 1000.0);
  std::vector<MassProperties> sides;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 flat = h;
      flat[axis] = 0.0;
      MassProperties part;
      part.mass = 4.0 * h[(axis + 1) % 3] * h[(axis + 2) % 3];
      part.centre = Vec3(5, 6, 7);
      part.centre[axis] += side * h[axis];
      const Vec3 second = part.mass / 3.0 * flat.cwiseProduct(flat);
      part.inertia = second.sum() * Mat3::Identity() - Mat3(second.asDiagonal());
      sides.push_back(part);
    }
  const MassProperties sum = combined(sides);
  CHECK(hollow.mass == Approx(sum.mass).epsilon(1e-13));
  CHECK((hollow.centre - sum.centre).norm() < 1e-13);
  CHECK(difference(hollow.inertia, sum.inertia) < 1e-12);
}

TEST_CASE("a sphere of sheet tends to 2/3 m r^2 with the square of the edge") {
  double last = 1.0;
  for (const double h : {0.02, 0.01, 0.005}) {
    const MassProperties mass = shell_mass_properties(make_sphere(0.1, {h, 0.3, 1}).value(), 1.0, 1.0);
    const double truth = 4.0 * core::kPi * 0.01 * 2.0 / 3.0 * 0.01;
    const double error = std::abs(mass.inertia.trace() / 3.0 - truth) / truth;
    CHECK(error < 0.35 * last);
    last = error;
  }
  CHECK(last < 2e-3);
}

TEST_CASE("moving the mesh moves its mass properties") {
  const TriangleMesh mesh = make_ornament({}, {0.006, 0.3, 1}).value().mesh;
  const MassProperties here = shell_mass_properties(mesh, 0.0005, 2500.0);
  const MassProperties there = shell_mass_properties(moved(mesh, kPose), 0.0005, 2500.0);
  const MassProperties expected = transformed(here, kPose);
  CHECK(there.mass == Approx(expected.mass).epsilon(1e-12));
  CHECK((there.centre - expected.centre).norm() < 1e-12);
  CHECK(difference(there.inertia, expected.inertia) < 1e-12);
}

TEST_CASE("parts sum to the whole") {
  const TriangleMesh mesh = make_bowl({}, {0.008, 0.3, 1}).value();
  const MassProperties whole = shell_mass_properties(mesh, 0.004, 2400.0);
  TriangleMesh parts[2];
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    parts[t % 2].positions = mesh.positions;
    parts[t % 2].triangles.push_back(mesh.triangles[t]);
  }
  const MassProperties sum = combined(
      {shell_mass_properties(parts[0], 0.004, 2400.0), shell_mass_properties(parts[1], 0.004, 2400.0)});
  CHECK(sum.mass == Approx(whole.mass).epsilon(1e-13));
  CHECK((sum.centre - whole.centre).norm() < 1e-13);
  CHECK(difference(sum.inertia, whole.inertia) < 1e-12);
}

TEST_CASE("nothing has no mass and no NaN") {
  const MassProperties none = shell_mass_properties({}, 1.0, 1.0);
  CHECK(none.mass == 0.0);
  CHECK(none.inertia == Mat3::Zero());
  CHECK(combined({}).mass == 0.0);
  CHECK(MassSum(Vec3(1, 2, 3)).properties().centre == Vec3(1, 2, 3));
}

TEST_CASE("scale from micrometres to megametres keeps the relative error") {
  for (const double scale : {1e-6, 1e6}) {
    TriangleMesh box = make_box(scale * Vec3(1, 2, 3), scale * Vec3(4, 5, 6));
    const MassProperties mass = solid_mass_properties(box, 1.0);
    CHECK(difference(mass.inertia, box_mass_properties(scale * Vec3(1, 2, 3), 1.0).inertia) < 1e-12);
  }
  const MassProperties sphere = sphere_mass_properties(0.03, 7850.0);
  CHECK(sphere.mass == Approx(7850.0 * 4.0 / 3.0 * core::kPi * 2.7e-5).epsilon(1e-14));
  CHECK(sphere.inertia(1, 1) == Approx(0.4 * sphere.mass * 9e-4).epsilon(1e-14));
}

TEST_CASE(
    "a capsule weighs and turns as its polyhedron of many sides does and as a sphere if it has no middle") {
  const double radius = 0.03, half_length = 0.07;
  const MassProperties capsule = capsule_mass_properties(radius, half_length, 900.0);
  const MassProperties polyhedron =
      solid_mass_properties(make_capsule_surface(radius, half_length, 256), 900.0);
  CHECK(capsule.mass == Approx(polyhedron.mass).epsilon(1e-3));
  CHECK(polyhedron.mass < capsule.mass);  // its corners lie on the capsule
  CHECK(difference(polyhedron.inertia, capsule.inertia) < 1e-3);
  CHECK(polyhedron.centre.norm() < 1e-12);
  const MassProperties ball = capsule_mass_properties(radius, 0.0, 900.0),
                       sphere = sphere_mass_properties(radius, 900.0);
  CHECK(ball.mass == Approx(sphere.mass).epsilon(1e-14));
  CHECK(difference(ball.inertia, sphere.inertia) < 1e-14);
}

}  // namespace shatterbox::geometry
