// NUMERICS cases 13 to 16.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "engine/core/elementary.h"
#include "engine/stress/shell_stress.h"
#include "sandbox/study/shell_models.h"
#include "sandbox/study/stopwatch.h"
#include "sandbox/study/stress_cases.h"

namespace shatterbox::sandbox::study {

using namespace model;
using namespace stress;
using std::size_t;

namespace shell_cases {
namespace {

struct Answered {
  std::shared_ptr<const ShellStiffness> stiffness;
  std::vector<ShellSolution> solutions;
  std::vector<std::vector<CellStress>> stresses;  // of each solution
  StressCase found;
};

Answered answer(const geometry::ShellMesh& mesh, const std::vector<VecX>& loads,
                const ShellProperties& properties, const ShellSupport& support = {}) {
  Answered answered;
  const Stopwatch watch;
  answered.stiffness = make_shell_stiffness(mesh.elements, properties);
  answered.solutions = make_system(answered.stiffness, mesh, 0.0, support)->solve(loads);
  for (const ShellSolution& solution : answered.solutions) {
    if (!solution.is_evaluated()) throw std::runtime_error("the load moves a mechanism of the shell");
    answered.stresses.push_back(cell_stresses(*answered.stiffness, mesh, solution.displacement));
    answered.found.residual = std::max(answered.found.residual, solution.residual);
  }
  answered.found.seconds = watch.seconds();
  answered.found.elements = static_cast<long>(mesh.cells.size());
  return answered;
}

/// L2 error of moments against the free disc's, outside of a radius.
double disc_moment_error(const geometry::ShellMesh& mesh, const ShellProperties& properties,
                         const std::vector<CellStress>& stresses, double least_radius) {
  const double nu = properties.poisson_ratio;
  double error = 0.0, size = 0.0;
  for (size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto& elements = *mesh.elements;
    const Mat3 frame = geometry::facet_frame(elements, static_cast<int>(c));
    const Vec3 centre =
        geometry::position_in_element(elements, static_cast<int>(c), Vec2(1.0 / 3.0, 1.0 / 3.0));
    const double r = centre.norm();
    if (r < least_radius) continue;
    const double c0 = (3.0 + nu) / (1.0 + nu) / 16.0;
    const double slope = (2.0 * core::log(r) + 1.0) / 8.0 - r * r / 16.0 - c0;            // pi D w' / r
    const double curvature = (2.0 * core::log(r) + 3.0) / 8.0 - 3.0 * r * r / 16.0 - c0;  // pi D w''
    const double radial = -(curvature + nu * slope) / core::kPi;
    const double tangential = -(slope + nu * curvature) / core::kPi;
    const Vec2 e = (frame.leftCols<2>().transpose() * centre / r).normalized();
    const PlaneStress m = stresses[c].bending * (properties.thickness * properties.thickness / 6.0);
    const double mr = e.x() * e.x() * m(0) + e.y() * e.y() * m(1) + 2.0 * e.x() * e.y() * m(2);
    const double mt = m(0) + m(1) - mr;
    const double mrt = e.x() * e.y() * (m(1) - m(0)) + (e.x() * e.x() - e.y() * e.y()) * m(2);
    error += mesh.cells[c].area *
             ((mr - radial) * (mr - radial) + (mt - tangential) * (mt - tangential) + 2.0 * mrt * mrt);
    size += mesh.cells[c].area * (radial * radial + tangential * tangential);
  }
  return core::sqrt(error / size);
}

}  // namespace
}  // namespace shell_cases

using namespace shell_cases;

StressCase square_plate(int n, bool is_clamped) {
  const ShellProperties properties = properties_of(0.01);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(grid(n, n, 1.0, 1.0));
  const int middle = vertex_dof((n / 2) * (n + 1) + n / 2) + 2;
  VecX point = VecX::Zero(mesh.degree_of_freedom_count());
  point(middle) = 1.0;
  Answered answered =
      answer(mesh, {point, pressure_load(mesh, 1.0)}, properties, square_support(mesh, is_clamped));
  const double d = bending_stiffness(properties);
  const double w_point = is_clamped ? 0.0056125 : 0.0116008;
  const double w_uniform = is_clamped ? 0.00126532 : 0.00406235;
  const double m = is_clamped ? 0.0229051 : 0.0478865;
  // The moment in the middle: mean over the cells about it.
  double moment = 0.0;
  int count = 0;
  for (size_t c = 0; c < mesh.cells.size(); ++c)
    for (const int v : mesh.cells[c].vertices)
      if (vertex_dof(v) + 2 == middle) {
        moment += 0.5 * (answered.stresses[1][c].bending(0) + answered.stresses[1][c].bending(1));
        ++count;
      }
  moment *= properties.thickness * properties.thickness / 6.0 / count;
  answered.found.deflection = answered.solutions[0].displacement(middle) * d / w_point;
  answered.found.raw = std::abs(moment / m - 1.0);
  answered.found.rim = answered.solutions[1].displacement(middle) * d / w_uniform - 1.0;
  return answered.found;
}

StressCase free_disc(int rings) {
  // w = P r^2 ln r / 8 pi D - P r^4 / 64 pi D - P (3 + nu) r^2 / 32 pi D (1 + nu).
  const ShellProperties properties = properties_of(0.01);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(disc(rings));
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  load(2) = 1.0;
  Answered answered = answer(mesh, {load}, properties);
  const VecX& displacement = answered.solutions[0].displacement;
  double rim = 0.0;
  const int first = 1 + 3 * rings * (rings - 1);
  for (int i = 0; i < 6 * rings; ++i) rim += displacement(vertex_dof(first + i) + 2) / (6.0 * rings);
  const auto means = average_stresses(mesh, geometry::find_cell_contacts(mesh), answered.stresses[0]);
  answered.found.deflection = (displacement(2) - rim) * bending_stiffness(properties) / 0.0302241;
  answered.found.raw = disc_moment_error(mesh, properties, answered.stresses[0], 0.0);
  answered.found.averaged = disc_moment_error(mesh, properties, means, 0.0);
  answered.found.rim = disc_moment_error(mesh, properties, answered.stresses[0], 0.25);
  return answered.found;
}

StressCase pressed_sphere(int level) {
  const ShellProperties properties = properties_of(0.02);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(icosphere(level));
  Answered answered = answer(mesh, {pressure_load(mesh, 1000.0)}, properties);
  const double expected = 1000.0 / (2.0 * properties.thickness);
  double sum = 0.0, area = 0.0, worst = 0.0;
  for (size_t c = 0; c < mesh.cells.size(); ++c) {
    const PlaneStress& membrane = answered.stresses[0][c].membrane;
    const double mean = 0.5 * (membrane(0) + membrane(1));
    sum += mesh.cells[c].area * mean;
    area += mesh.cells[c].area;
    worst = std::max(worst, std::abs(mean / expected - 1.0));
  }
  answered.found.raw = std::abs(sum / area / expected - 1.0);
  answered.found.rim = worst;
  return answered.found;
}

StressCase pinched_sphere(int level, bool has_bending) {
  ShellProperties properties = properties_of(0.05, 0.3);
  properties.has_bending = has_bending;
  const double reissner = core::sqrt(3.0) / 4.0 * core::sqrt(1.0 - 0.09) /
                          (properties.youngs_modulus * properties.thickness * properties.thickness);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(icosphere(level));
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  const int top = vertex_dof(0) + 2, bottom = vertex_dof(11) + 2;
  load(top) = -1.0;
  load(bottom) = 1.0;
  Answered answered = answer(mesh, {load}, properties);
  const VecX& displacement = answered.solutions[0].displacement;
  answered.found.deflection = 0.5 * (displacement(bottom) - displacement(top)) / reissner;
  double most = 0.0;
  for (const CellStress& stress : answered.stresses[0])
    most = std::max(most, worst_stress(stress).principal.first);
  answered.found.concentration = most;
  return answered.found;
}

}  // namespace shatterbox::sandbox::study
