// Solves of solids with closed-form answers (NUMERICS cases 4, 5, 6, 7, 8, 11 and the locking table).
#include <cmath>

#include "tests/engine/stress/solid_meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

using core::at;
using std::size_t;

namespace {

struct Errors {
  double raw = 0.0, averaged = 0.0, deflection = 0.0;
};

SolidStress stress_of(double xx, double yy, double zz, double yz = 0.0, double zx = 0.0, double xy = 0.0) {
  SolidStress stress;
  stress << xx, yy, zz, yz, zx, xy;
  return stress;
}

/// L2 errors of the stress against a field given at the cells' centroids.
Errors field_errors(const SolidStiffness& stiffness, const geometry::SolidMesh& mesh,
                    const VecX& displacement, const std::function<SolidStress(const Vec3&)>& field) {
  std::vector<SolidStress> expected;
  for (const geometry::SolidCell& cell : mesh.cells) expected.push_back(field(cell_centroid(mesh, cell)));
  const auto raw = cell_stresses(stiffness, mesh, displacement);
  return {stress_difference(mesh, raw, expected),
          stress_difference(mesh, average_stresses(mesh, whole_contacts(mesh), raw), expected), 0.0};
}

/// Stress with these principal values along a radius in the plane of two axes, across it, and along the
/// third.
SolidStress polar_stress(double radial, double hoop, double axial, double c, double s) {
  return stress_of(radial * c * c + hoop * s * s, radial * s * s + hoop * c * c, axial, 0.0, 0.0,
                   (radial - hoop) * c * s);
}

/// A sixth of a thick sphere between the cones through a cube's side, inner radius 1, outer 2, inner pressure
/// 1 and Lame's hoop stress on the cones: a free body in balance.
Errors thick_sphere(int n) {
  const double a = 1.0, b = 2.0, p = 1.0;
  const double cubes = p * a * a * a / (b * b * b - a * a * a);
  const auto radial = [&](double r) { return cubes * (1.0 - b * b * b / (r * r * r)); };
  const auto hoop = [&](double r) { return cubes * (1.0 + b * b * b / (2.0 * r * r * r)); };
  const Solids solids = mapped({n, n, n / 2}, [&](const Vec3& x) -> Vec3 {
    return (a + (b - a) * x.z()) * Vec3(2.0 * x.x() - 1.0, 2.0 * x.y() - 1.0, 1.0).normalized();
  });
  const auto stiffness = make_solid_stiffness(solids, solid_properties());
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const VecX load = traction_load(mesh, [&](const Vec3& x, const Vec3& normal) -> Vec3 {
    const double r = x.norm(), outwards = x.dot(normal) / r;
    return (outwards < -0.5 ? -p : outwards > 0.5 ? 0.0 : hoop(r)) * normal;
  });
  const SolidSolution solution = make_solid_system(stiffness, mesh)->solve(load, fine(1e-8));
  REQUIRE(solution.is_evaluated());
  return field_errors(*stiffness, mesh, solution.displacement, [&](const Vec3& x) -> SolidStress {
    const double r = x.norm();
    const Vec3 e = x / r;
    const Mat3 s = hoop(r) * Mat3::Identity() + (radial(r) - hoop(r)) * e * e.transpose();
    return stress_of(s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(2, 0), s(0, 1));
  });
}

/// A quarter of a ring of inner radius 1, n cells round, `rings` through, one thick; u_z = 0 on both faces
/// (plane strain) and symmetry at x = 0 and y = 0.
struct QuarterRing {
  geometry::SolidMesh mesh;
  std::shared_ptr<const SolidStiffness> stiffness;
  std::shared_ptr<const SolidSystem> system;

  QuarterRing(int n, int rings, double outer) {
    const double thickness = 0.5 * core::kPi / n;
    const Solids solids = mapped({rings, n, 2}, [&](const Vec3& x) -> Vec3 {
      const double r = core::pow(outer, x.x());  // as long as wide, everywhere
      const double angle = 0.5 * core::kPi * x.y();
      // Exactly on the planes of symmetry.
      const double c = x.y() == 1.0 ? 0.0 : core::cos(angle), s = core::sin(angle);
      return {r * c, r * s, thickness * (2.0 * x.z() - 1.0)};
    });
    mesh = make_solid_mesh(solids);
    stiffness = make_solid_stiffness(solids, solid_properties());
    SolidSystemOptions options;
    options.support = clamp_where(mesh, [&](const Vec3& x) {
      return (x.x() == 0.0 ? 1 : 0) + (x.y() == 0.0 ? 2 : 0) + (std::abs(x.z()) > 0.99 * thickness ? 4 : 0);
    });
    system = make_solid_system(stiffness, mesh, options);
  }
};

/// Thick cylinder, plane strain, radii 1 and 2, inner pressure 1.
Errors thick_cylinder(int n) {
  const double b = 2.0, nu = 0.3, factor = 1.0 / (b * b - 1.0);
  const QuarterRing ring(n, n / 2, b);
  const VecX load = traction_load(ring.mesh, [&](const Vec3& x, const Vec3& normal) -> Vec3 {
    return std::abs(normal.z()) < 0.5 && x.head<2>().norm() < 1.05 && x.dot(normal) < 0.0
               ? Vec3(-normal)
               : Vec3(Vec3::Zero());
  });
  const SolidSolution solution = ring.system->solve(load, fine(1e-8));
  REQUIRE(solution.is_evaluated());
  return field_errors(*ring.stiffness, ring.mesh, solution.displacement, [&](const Vec3& x) -> SolidStress {
    const double r = x.head<2>().norm();
    const double radial = factor * (1.0 - b * b / (r * r)), hoop = factor * (1.0 + b * b / (r * r));
    return polar_stress(radial, hoop, nu * (radial + hoop), x.x() / r, x.y() / r);
  });
}

struct HoleErrors {
  Errors field;
  double concentration = 0.0;  // relative, of the greatest stress
};

/// An infinite plate under tension 1 along x with a hole of radius 1, cut out at radius 6 with Kirsch's
/// stress.
HoleErrors plate_with_hole(int n) {
  const double outer = 6.0, nu = 0.3;
  const QuarterRing ring(n, (n * 8) / 7, outer);
  const auto kirsch = [&](const Vec3& x) -> SolidStress {
    const double r2 = x.head<2>().squaredNorm(), r = core::sqrt(r2);
    const double c = x.x() / r, s = x.y() / r, c2 = c * c - s * s, s2 = 2.0 * c * s;
    const double q = 1.0 / r2, q2 = q * q;
    const double radial = 0.5 * (1.0 - q) + 0.5 * (1.0 - 4.0 * q + 3.0 * q2) * c2;
    const double hoop = 0.5 * (1.0 + q) - 0.5 * (1.0 + 3.0 * q2) * c2;
    const double shear = -0.5 * (1.0 + 2.0 * q - 3.0 * q2) * s2;
    SolidStress stress = polar_stress(radial, hoop, nu * (radial + hoop), c, s);
    stress(0) -= 2.0 * c * s * shear;
    stress(1) += 2.0 * c * s * shear;
    stress(5) += (c * c - s * s) * shear;
    return stress;
  };
  const VecX load = traction_load(ring.mesh, [&](const Vec3& x, const Vec3& normal) -> Vec3 {
    if (x.head<2>().norm() < 0.9 * outer || std::abs(normal.z()) > 0.5) return Vec3::Zero();
    return stress_tensor(kirsch(x)) * normal;
  });
  const SolidSolution solution = ring.system->solve(load, fine(1e-8));
  REQUIRE(solution.is_evaluated());
  HoleErrors errors;
  errors.field = field_errors(*ring.stiffness, ring.mesh, solution.displacement, kirsch);
  const auto means = average_stresses(ring.mesh, whole_contacts(ring.mesh),
                                      cell_stresses(*ring.stiffness, ring.mesh, solution.displacement));
  // Where Kirsch has the greatest: the cells about the top of the hole.
  double found = 0.0, expected = 0.0;
  for (size_t c = 0; c < means.size(); ++c) {
    const geometry::SolidCell& cell = ring.mesh.cells[c];
    const Vec3 x = cell_centroid(ring.mesh, cell);
    if ((x.head<2>() - Vec2(0.0, 1.0)).norm() > core::kPi / n) continue;
    found += cell.volume * means[c](0);
    expected += cell.volume * kirsch(x)(0);
  }
  errors.concentration = found / expected - 1.0;
  return errors;
}

/// A solid disc of radius 1 and thickness 0.1 that spins: centre and rim of the averaged stress beside plane
/// stress.
struct DiscErrors {
  Errors field;
  double centre = 0.0, rim = 0.0;  // relative
};

DiscErrors spinning_disc(int n) {
  const double thickness = 0.1, spin = 40.0, nu = 0.3;
  const Solids solids = mapped({n, n, 2}, [&](const Vec3& x) -> Vec3 {
    const Vec2 square(2.0 * x.x() - 1.0, 2.0 * x.y() - 1.0);
    const double norm = square.norm(), side = square.cwiseAbs().maxCoeff();
    const Vec2 place = norm > 0.0 ? Vec2(square * (side / norm)) : square;
    return {place.x(), place.y(), thickness * (x.z() - 0.5)};
  });
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const SolidProperties properties = solid_properties(nu);
  const auto stiffness = make_solid_stiffness(solids, properties);
  const VecX load = centrifugal_load(*stiffness, mesh, Vec3(0.0, 0.0, spin), Vec3::Zero());
  const SolidSolution solution = make_solid_system(stiffness, mesh)->solve(load, fine(1e-8));
  REQUIRE(solution.is_evaluated());
  const double unit = properties.density * spin * spin;
  const auto exact = [&](const Vec3& x) -> SolidStress {
    const double r2 = x.head<2>().squaredNorm(), r = std::max(core::sqrt(r2), 1e-12);
    return polar_stress(unit * (3.0 + nu) / 8.0 * (1.0 - r2),
                        unit / 8.0 * ((3.0 + nu) - (1.0 + 3.0 * nu) * r2), 0.0, x.x() / r, x.y() / r);
  };
  DiscErrors errors;
  errors.field = field_errors(*stiffness, mesh, solution.displacement, exact);
  const auto means =
      average_stresses(mesh, whole_contacts(mesh), cell_stresses(*stiffness, mesh, solution.displacement));
  double centre = 0.0, exact_centre = 0.0, rim = 0.0, exact_rim = 0.0;
  const auto hoop_of = [](const SolidStress& stress, const Vec2& e) {
    return stress(0) * e.y() * e.y() + stress(1) * e.x() * e.x() - 2.0 * stress(5) * e.x() * e.y();
  };
  for (size_t c = 0; c < means.size(); ++c) {
    const Vec3 x = cell_centroid(mesh, mesh.cells[c]);
    const double r = x.head<2>().norm(), volume = mesh.cells[c].volume;
    if (r < 0.2) {
      centre += volume * (means[c](0) + means[c](1));
      exact_centre += volume * (exact(x)(0) + exact(x)(1));
    }
    if (r > 0.9) {
      rim += volume * hoop_of(means[c], x.head<2>() / r);
      exact_rim += volume * hoop_of(exact(x), x.head<2>() / r);
    }
  }
  errors.centre = centre / exact_centre - 1.0;
  errors.rim = rim / exact_rim - 1.0;
  return errors;
}

/// A cantilever 4 x 1 x 1 clamped at x = -2 and sheared at x = 2: deflection beside Timoshenko's, stress
/// beside M z / I in the middle half.
Errors cantilever(int n, double poisson_ratio, bool is_ratio_clamped = false) {
  const SolidProperties properties = solid_properties(poisson_ratio);
  const Solids solids = lattice_box(Vec3(2.0, 0.5, 0.5), 1.0 / n);
  const geometry::SolidMesh mesh = make_solid_mesh(solids);
  const auto stiffness = make_solid_stiffness(solids, properties);
  REQUIRE(stiffness->is_poisson_clamped() == is_ratio_clamped);
  SolidSystemOptions options;
  options.support = clamp_where(mesh, [](const Vec3& x) { return x.x() == -2.0 ? 7 : 0; });
  const VecX load = traction_load(mesh, [](const Vec3& x, const Vec3& normal) -> Vec3 {
    return normal.x() > 0.5 && x.x() == 2.0 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, 0.0, 0.0);
  });
  const SolidSolution solution = make_solid_system(stiffness, mesh, options)->solve(load, fine(1e-8));
  REQUIRE(solution.is_evaluated());
  double tip = 0.0;
  int count = 0;
  for (size_t v = 0; v < mesh.vertex_source.size(); ++v)
    if (solids->mesh.positions[v].x() == 2.0) {
      tip += solution.displacement(static_cast<Eigen::Index>(3 * v + 2));
      ++count;
    }
  const double e = properties.youngs_modulus, nu = stiffness->poisson_ratio;
  const double timoshenko = 64.0 / (3.0 * e / 12.0) + 4.0 / (5.0 / 6.0 * e / (2.0 * (1.0 + nu)));
  const auto raw = cell_stresses(*stiffness, mesh, solution.displacement);
  const auto averaged = average_stresses(mesh, whole_contacts(mesh), raw);
  double raw_error = 0.0, averaged_error = 0.0, size = 0.0;
  for (size_t c = 0; c < raw.size(); ++c) {
    const Vec3 x = cell_centroid(mesh, mesh.cells[c]);
    if (std::abs(x.x()) > 1.0) continue;
    const double expected = -(2.0 - x.x()) * x.z() * 12.0;  // pushed up: the top is pressed
    raw_error += mesh.cells[c].volume * (raw[c](0) - expected) * (raw[c](0) - expected);
    averaged_error += mesh.cells[c].volume * (averaged[c](0) - expected) * (averaged[c](0) - expected);
    size += mesh.cells[c].volume * expected * expected;
  }
  return {core::sqrt(raw_error / size), core::sqrt(averaged_error / size), tip / count / timoshenko};
}

}  // namespace

TEST_CASE("thick sphere under inner pressure: Lame") {
  const Errors coarse = thick_sphere(8), middle = thick_sphere(16), fine_one = thick_sphere(32);
  CAPTURE(coarse.raw, coarse.averaged, middle.raw, middle.averaged, fine_one.raw, fine_one.averaged);
  CHECK(fine_one.averaged < 0.03);
  CHECK(fine_one.raw < 0.55 * middle.raw);
  CHECK(fine_one.averaged < 0.55 * middle.averaged);
  CHECK(middle.averaged < 0.55 * coarse.averaged);
}

TEST_CASE("thick cylinder in plane strain under inner pressure: Lame") {
  const Errors coarse = thick_cylinder(8), middle = thick_cylinder(16), fine_one = thick_cylinder(32);
  CAPTURE(coarse.raw, coarse.averaged, middle.raw, middle.averaged, fine_one.raw, fine_one.averaged);
  CHECK(fine_one.averaged < 0.02);
  CHECK(fine_one.raw < 0.03);
  CHECK(fine_one.raw < 0.51 * middle.raw);
  CHECK(middle.raw < 0.51 * coarse.raw);
}

TEST_CASE("a solid plate with a hole: Kirsch's three times the tension") {
  const HoleErrors coarse = plate_with_hole(8), middle = plate_with_hole(16), fine_one = plate_with_hole(32);
  CAPTURE(coarse.concentration, middle.concentration, fine_one.concentration);
  CAPTURE(coarse.field.raw, middle.field.raw, fine_one.field.raw);
  CAPTURE(coarse.field.averaged, middle.field.averaged, fine_one.field.averaged);
  CHECK(std::abs(middle.concentration) < 0.015);  // 0.7 % measured; 5 % asked for
  CHECK(middle.field.raw < 0.025);
  CHECK(middle.field.averaged < 0.015);
  CHECK(fine_one.field.raw < 0.52 * middle.field.raw);
  CHECK(fine_one.field.averaged < 0.52 * middle.field.averaged);
}

TEST_CASE("a solid disc that spins: stress of its centre and its rim") {
  const DiscErrors middle = spinning_disc(16), fine_one = spinning_disc(32);
  CAPTURE(middle.centre, middle.rim, middle.field.averaged, fine_one.centre, fine_one.rim,
          fine_one.field.averaged);
  CHECK(std::abs(fine_one.centre) < 0.01);
  CHECK(std::abs(fine_one.rim) < 0.01);
  CHECK(fine_one.field.averaged < 0.02);
  CHECK(fine_one.field.averaged < 0.55 * middle.field.averaged);
}

TEST_CASE("cantilever of a solid: deflection and stress, and how it locks") {
  for (const double nu : {0.22, 0.30, 0.40}) {
    const Errors two = cantilever(2, nu), four = cantilever(4, nu), eight = cantilever(8, nu);
    CAPTURE(nu, two.deflection, four.deflection, eight.deflection);
    CAPTURE(two.raw, four.raw, eight.raw, two.averaged, four.averaged, eight.averaged);
    CHECK(eight.deflection > (nu < 0.35 ? 0.965 : 0.95));
    CHECK(eight.deflection < 1.0);
    CHECK(1.0 - eight.deflection < 0.6 * (1.0 - four.deflection));
    CHECK(eight.raw < 0.065);
    CHECK(eight.averaged < 0.034);
    CHECK(four.averaged < 0.6 * four.raw);
    CHECK(eight.averaged < 0.4 * four.averaged);
  }
  // Beyond the clamp the answer is that of the clamp: elements that would lock do not.
  CHECK(cantilever(4, 0.499, true).deflection == Approx(cantilever(4, 0.40).deflection));
}
