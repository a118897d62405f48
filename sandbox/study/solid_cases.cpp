// NUMERICS cases 4 to 8 and 11.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/core/elementary.h"
#include "sandbox/study/solid_models.h"
#include "sandbox/study/stopwatch.h"
#include "sandbox/study/stress_cases.h"

namespace shatterbox::sandbox::study {

using namespace model;
using namespace stress;
using std::size_t;

namespace solid_cases {
namespace {

using Field = std::function<SolidStress(const Vec3&)>;

/// What a solve gave: errors are read off.
struct Solved {
  std::shared_ptr<const SolidStiffness> stiffness;
  SolidSolution solution;
  std::vector<SolidStress> raw, averaged;
  StressCase found;
};

Solved solve_case(const geometry::SolidMesh& mesh, const VecX& load, const SolidProperties& properties,
                  const SolidSupport& support, const SolidSolveSettings& settings) {
  Solved solved;
  const auto contacts = whole_contacts(mesh);
  const Stopwatch watch;
  solved.stiffness = make_solid_stiffness(mesh.elements, properties);
  SolidSystemOptions options;
  options.support = support;
  solved.solution = make_solid_system(solved.stiffness, mesh, options)->solve(load, settings);
  if (!solved.solution.is_evaluated()) throw std::runtime_error(solved.solution.fault);
  solved.raw = cell_stresses(*solved.stiffness, mesh, solved.solution.displacement);
  solved.averaged = average_stresses(mesh, contacts, solved.raw);
  solved.found.seconds = watch.seconds();
  solved.found.elements = static_cast<long>(mesh.cells.size());
  solved.found.iterations = solved.solution.iterations;
  solved.found.residual = solved.solution.residual;
  return solved;
}

/// L2 errors against a field given at the cells' centroids.
void compare_fields(const geometry::SolidMesh& mesh, const Field& field, Solved& solved) {
  std::vector<SolidStress> expected;
  for (const geometry::SolidCell& cell : mesh.cells) expected.push_back(field(cell_centroid(mesh, cell)));
  solved.found.raw = stress_difference(mesh, solved.raw, expected);
  solved.found.averaged = stress_difference(mesh, solved.averaged, expected);
}

SolidStress stress_from(double xx, double yy, double zz, double yz = 0.0, double zx = 0.0, double xy = 0.0) {
  SolidStress stress;
  stress << xx, yy, zz, yz, zx, xy;
  return stress;
}

/// Stress with these principal values along a radius in the plane of two axes, across it, and along the
/// third.
SolidStress polar_stress(double radial, double hoop, double axial, double c, double s) {
  return stress_from(radial * c * c + hoop * s * s, radial * s * s + hoop * c * c, axial, 0.0, 0.0,
                     (radial - hoop) * c * s);
}

/// A quarter of a ring of inner radius 1, n cells round, `rings` through, one thick; u_z = 0 on both faces
/// (plane strain) and symmetry at x = 0 and y = 0.
struct QuarterRing {
  geometry::SolidMesh mesh;
  SolidSupport support;

  QuarterRing(int n, int rings, double outer) {
    const double thickness = 0.5 * core::kPi / n;
    mesh = make_solid_mesh(mapped({rings, n, 2}, [&](const Vec3& x) -> Vec3 {
      const double r = core::pow(outer, x.x());  // as long as wide, everywhere
      const double angle = 0.5 * core::kPi * x.y();
      // Exactly on the planes of symmetry.
      const double c = x.y() == 1.0 ? 0.0 : core::cos(angle), s = core::sin(angle);
      return {r * c, r * s, thickness * (2.0 * x.z() - 1.0)};
    }));
    support = clamp_where(mesh, [&](const Vec3& x) {
      return (x.x() == 0.0 ? 1 : 0) + (x.y() == 0.0 ? 2 : 0) + (std::abs(x.z()) > 0.99 * thickness ? 4 : 0);
    });
  }
};

/// Sums of a stress found and expected over some cells, by volume.
struct Beside {
  double found = 0.0, expected = 0.0;
  void add(double volume, double found_stress, double expected_stress) {
    found += volume * found_stress;
    expected += volume * expected_stress;
  }
  double error() const { return found / expected - 1.0; }
};

/// Along x only: relative L2 error of `stresses` in the cells for which `expected` has a number.
double bending_error(const geometry::SolidMesh& mesh, const std::vector<SolidStress>& stresses,
                     const std::function<double(const Vec3&)>& expected) {
  double error = 0.0, size = 0.0;
  for (size_t c = 0; c < stresses.size(); ++c) {
    const double exact = expected(cell_centroid(mesh, mesh.cells[c]));
    if (std::isnan(exact)) continue;
    error += mesh.cells[c].volume * (stresses[c](0) - exact) * (stresses[c](0) - exact);
    size += mesh.cells[c].volume * exact * exact;
  }
  return core::sqrt(error / size);
}

}  // namespace
}  // namespace solid_cases

using namespace solid_cases;

StressCase thick_sphere(int n, const SolidSolveSettings& solve) {
  const double a = 1.0, b = 2.0, p = 1.0;
  const double cubes = p * a * a * a / (b * b * b - a * a * a);
  const auto radial = [&](double r) { return cubes * (1.0 - b * b * b / (r * r * r)); };
  const auto hoop = [&](double r) { return cubes * (1.0 + b * b * b / (2.0 * r * r * r)); };
  // Between the cones through a cube's side, with Lame's hoop stress on them.
  const geometry::SolidMesh mesh = make_solid_mesh(mapped({n, n, n / 2}, [&](const Vec3& x) -> Vec3 {
    return (a + (b - a) * x.z()) * Vec3(2.0 * x.x() - 1.0, 2.0 * x.y() - 1.0, 1.0).normalized();
  }));
  const VecX load = traction_load(mesh, [&](const Vec3& x, const Vec3& normal) -> Vec3 {
    const double r = x.norm(), outwards = x.dot(normal) / r;
    return (outwards < -0.5 ? -p : outwards > 0.5 ? 0.0 : hoop(r)) * normal;
  });
  Solved solved = solve_case(mesh, load, solid_properties(), {}, solve);
  compare_fields(
      mesh,
      [&](const Vec3& x) -> SolidStress {
        const double r = x.norm();
        const Vec3 e = x / r;
        const Mat3 s = hoop(r) * Mat3::Identity() + (radial(r) - hoop(r)) * e * e.transpose();
        return stress_from(s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(2, 0), s(0, 1));
      },
      solved);
  return solved.found;
}

StressCase thick_cylinder(int n, const SolidSolveSettings& solve) {
  const double b = 2.0, nu = 0.3, factor = 1.0 / (b * b - 1.0);
  const QuarterRing ring(n, n / 2, b);
  const VecX load = traction_load(ring.mesh, [&](const Vec3& x, const Vec3& normal) -> Vec3 {
    return std::abs(normal.z()) < 0.5 && x.head<2>().norm() < 1.05 && x.dot(normal) < 0.0
               ? Vec3(-normal)
               : Vec3(Vec3::Zero());
  });
  Solved solved = solve_case(ring.mesh, load, solid_properties(nu), ring.support, solve);
  compare_fields(
      ring.mesh,
      [&](const Vec3& x) -> SolidStress {
        const double r = x.head<2>().norm();
        const double radial = factor * (1.0 - b * b / (r * r)), hoop = factor * (1.0 + b * b / (r * r));
        return polar_stress(radial, hoop, nu * (radial + hoop), x.x() / r, x.y() / r);
      },
      solved);
  return solved.found;
}

StressCase plate_with_hole(int n, const SolidSolveSettings& solve) {
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
  Solved solved = solve_case(ring.mesh, load, solid_properties(nu), ring.support, solve);
  compare_fields(ring.mesh, kirsch, solved);
  // Where Kirsch has the greatest: the cells about the top of the hole.
  Beside top;
  for (size_t c = 0; c < solved.averaged.size(); ++c) {
    const geometry::SolidCell& cell = ring.mesh.cells[c];
    const Vec3 x = cell_centroid(ring.mesh, cell);
    if ((x.head<2>() - Vec2(0.0, 1.0)).norm() <= core::kPi / n)
      top.add(cell.volume, solved.averaged[c](0), kirsch(x)(0));
  }
  solved.found.concentration = top.error();
  return solved.found;
}

StressCase spinning_disc(int n, const SolidSolveSettings& solve) {
  const double thickness = 0.1, spin = 40.0, nu = 0.3;
  const geometry::SolidMesh mesh = make_solid_mesh(mapped({n, n, 2}, [&](const Vec3& x) -> Vec3 {
    const Vec2 square(2.0 * x.x() - 1.0, 2.0 * x.y() - 1.0);
    const double norm = square.norm(), side = square.cwiseAbs().maxCoeff();
    const Vec2 place = norm > 0.0 ? Vec2(square * (side / norm)) : square;
    return {place.x(), place.y(), thickness * (x.z() - 0.5)};
  }));
  const SolidProperties properties = solid_properties(nu);
  const VecX load = centrifugal_load(*make_solid_stiffness(mesh.elements, properties), mesh,
                                     Vec3(0.0, 0.0, spin), Vec3::Zero());
  Solved solved = solve_case(mesh, load, properties, {}, solve);
  const double unit = properties.density * spin * spin;
  const auto exact = [&](const Vec3& x) -> SolidStress {
    const double r2 = x.head<2>().squaredNorm(), r = std::max(core::sqrt(r2), 1e-12);
    return polar_stress(unit * (3.0 + nu) / 8.0 * (1.0 - r2),
                        unit / 8.0 * ((3.0 + nu) - (1.0 + 3.0 * nu) * r2), 0.0, x.x() / r, x.y() / r);
  };
  compare_fields(mesh, exact, solved);
  const auto hoop_of = [](const SolidStress& stress, const Vec2& e) {
    return stress(0) * e.y() * e.y() + stress(1) * e.x() * e.x() - 2.0 * stress(5) * e.x() * e.y();
  };
  Beside centre, rim;
  for (size_t c = 0; c < solved.averaged.size(); ++c) {
    const Vec3 x = cell_centroid(mesh, mesh.cells[c]);
    const double r = x.head<2>().norm(), volume = mesh.cells[c].volume;
    const SolidStress &found = solved.averaged[c], expected = exact(x);
    if (r < 0.2) centre.add(volume, found(0) + found(1), expected(0) + expected(1));
    if (r > 0.9) rim.add(volume, hoop_of(found, x.head<2>() / r), hoop_of(expected, x.head<2>() / r));
  }
  solved.found.concentration = centre.error();
  solved.found.rim = rim.error();
  return solved.found;
}

StressCase cantilever(int n, double poisson_ratio, const SolidSolveSettings& solve) {
  const SolidProperties properties = solid_properties(poisson_ratio);
  const geometry::SolidMesh mesh = make_solid_mesh(lattice_box(Vec3(2.0, 0.5, 0.5), 1.0 / n));
  const SolidSupport support = clamp_where(mesh, [](const Vec3& x) { return x.x() == -2.0 ? 7 : 0; });
  const VecX load = traction_load(mesh, [](const Vec3& x, const Vec3& normal) -> Vec3 {
    return normal.x() > 0.5 && x.x() == 2.0 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, 0.0, 0.0);
  });
  Solved solved = solve_case(mesh, load, properties, support, solve);
  double tip = 0.0;
  int count = 0;
  for (size_t v = 0; v < mesh.vertex_source.size(); ++v)
    if (mesh.elements->mesh.positions[v].x() == 2.0) {
      tip += solved.solution.displacement(static_cast<Eigen::Index>(3 * v + 2));
      ++count;
    }
  const double e = properties.youngs_modulus, nu = solved.stiffness->poisson_ratio;
  const double timoshenko = 64.0 / (3.0 * e / 12.0) + 4.0 / (5.0 / 6.0 * e / (2.0 * (1.0 + nu)));
  solved.found.deflection = tip / count / timoshenko;
  const auto expected = [](const Vec3& x) {  // pushed up: the top is pressed
    return std::abs(x.x()) > 1.0 ? kNoStress : -(2.0 - x.x()) * x.z() * 12.0;
  };
  solved.found.raw = bending_error(mesh, solved.raw, expected);
  solved.found.averaged = bending_error(mesh, solved.averaged, expected);
  return solved.found;
}

StressCase free_beam(int n, const SolidSolveSettings& solve) {
  const double length = 2.0, inertia = 0.2 * 0.2 * 0.2 * 0.2 / 12.0;
  const Beam beam(0.2 / n);
  Solved solved = solve_case(beam.mesh, beam.hit(0.0), beam.stiffness->properties, {}, solve);
  const auto expected = [&](const Vec3& x) {
    if (std::abs(x.x()) < 0.25) return kNoStress;  // Saint-Venant
    const double from_end = 1.0 - std::abs(x.x());
    return -from_end * from_end / (2.0 * length) * x.z() / inertia;
  };
  solved.found.raw = bending_error(beam.mesh, solved.raw, expected);
  solved.found.averaged = bending_error(beam.mesh, solved.averaged, expected);
  double most = 0.0;
  for (const SolidStress& stress : solved.raw) most = std::max(most, principal_axes(stress).values(0));
  solved.found.concentration = most / (length / 8.0 * 0.1 / inertia) - 1.0;
  return solved.found;
}

}  // namespace shatterbox::sandbox::study
