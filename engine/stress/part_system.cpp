#include "engine/stress/part_system.h"

#include <algorithm>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/stress/solid_period.h"

namespace shatterbox::stress {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kRigidLoad = 1e-12;  // of a load, left after balancing: nothing but rounding

/// Three vertices of a part that are not nearly in line, the first ones in order; -1 where there are none.
std::array<int, 3> first_anchors(const std::vector<Vec3>& positions, const std::vector<int>& vertices) {
  constexpr double kLeastAngle = 1e-3;
  std::array<int, 3> anchors{-1, -1, -1};
  for (const int v : vertices) {
    const auto from_first = [&](int vertex) -> Vec3 {
      return positions[at(vertex)] - positions[at(anchors[0])];
    };
    if (anchors[0] < 0) {
      anchors[0] = v;
    } else if (anchors[1] < 0) {
      if (from_first(v).squaredNorm() > 0.0) anchors[1] = v;
    } else {
      const double area = from_first(anchors[1]).cross(from_first(v)).norm();
      if (area > kLeastAngle * from_first(anchors[1]).norm() * from_first(v).norm()) {
        anchors[2] = v;
        break;
      }
    }
  }
  return anchors;
}

}  // namespace

double PartSystem::seconds() const {
  return stiffness->length * core::sqrt(stiffness->properties.density / stiffness->properties.youngs_modulus);
}

PartSystem::PartSystem(std::shared_ptr<const SolidStiffness> of, const geometry::SolidMesh& mesh,
                       const SolidSystemOptions& options)
    : stiffness(std::move(of)) {
  const double length = stiffness->length;
  rows = assemble_stiffness(*stiffness, mesh);
  mass = lumped_mass(*stiffness, mesh) / (stiffness->properties.density * length * length * length);
  null_space = options.null_space;
  std::vector<Vec3> positions(mesh.vertex_source.size());
  for (Size v = 0; v < positions.size(); ++v)
    positions[v] = mesh.elements->mesh.positions[at(mesh.vertex_source[v])] / length;
  std::vector<char> is_clamped(at(mesh.degree_of_freedom_count()), 0);
  for (const int dof : options.support.dofs) is_clamped[at(dof)] = 1;

  single.resize(rows.entries.size());
  core::parallel_chunks(single.size(), Size{1} << 15, [&](Size begin, Size end) {
    for (Size i = begin; i < end; ++i) single[i] = static_cast<float>(rows.entries[i]);
  });
  system.rows = &rows;
  system.single = &single;
  system.hold_of.assign(positions.size(), -1);
  for (Size v = 0; v < positions.size(); ++v) {
    const Vec3 free(is_clamped[3 * v] == 0, is_clamped[3 * v + 1] == 0, is_clamped[3 * v + 2] == 0);
    if (free == Vec3::Ones()) continue;
    system.hold_of[v] = static_cast<int>(system.holds.size());
    system.holds.push_back({static_cast<int>(v), free.asDiagonal()});
  }
  const std::vector<int> part_of_dof = part_of_dofs(mesh);
  if (null_space == NullSpace::paper) add_anchors(positions, options, is_clamped, part_of_dof);
  rigid = RigidModes(part_of_dof, positions, {}, mass, is_clamped);
  if (is_relieved()) system.project = [this](VecX& residual) { rigid.balance(residual); };
  invert_diagonal(system);
  std::vector<Mat3> allowed(positions.size(), Mat3::Identity());
  std::vector<double> vertex_mass(positions.size());
  for (Size v = 0; v < positions.size(); ++v) {
    if (system.hold_of[v] >= 0) allowed[v] = system.holds[at(system.hold_of[v])].allowed;
    vertex_mass[v] = mass(static_cast<Eigen::Index>(3 * v));
  }
  coarse = CoarseModes(rows, positions, allowed, vertex_mass);
  system.coarse = &coarse;
  system.coarse_factor = coarse.factor(0.0);
}

/// [BHTF07] sec. V: X1 is fixed; X2 keeps its direction from X1; X3 keeps the plane of the three.
void PartSystem::add_anchors(const std::vector<Vec3>& positions, const SolidSystemOptions& options,
                             const std::vector<char>& is_clamped, const std::vector<int>& part_of_dof) {
  int parts = 0;
  for (const int part : part_of_dof) parts = std::max(parts, part + 1);
  std::vector<std::vector<int>> vertices(at(parts));
  std::vector<char> is_held(at(parts), 0);
  for (Size v = 0; v < positions.size(); ++v) {
    const int part = part_of_dof[3 * v];
    if (part < 0) continue;
    vertices[at(part)].push_back(static_cast<int>(v));
    if (is_clamped[3 * v] != 0 || is_clamped[3 * v + 1] != 0 || is_clamped[3 * v + 2] != 0)
      is_held[at(part)] = 1;
  }
  std::vector<std::array<int, 3>> anchors = options.anchors;
  for (const auto& three : anchors) is_held[at(part_of_dof[3 * at(three[0])])] = 1;
  for (Size part = 0; part < vertices.size(); ++part)
    if (is_held[part] == 0) anchors.push_back(first_anchors(positions, vertices[part]));
  const auto hold = [&](int vertex, const Mat3& allowed) {
    system.hold_of[at(vertex)] = static_cast<int>(system.holds.size());
    system.holds.push_back({vertex, allowed});
  };
  for (const auto& [x1, x2, x3] : anchors) {
    if (x3 < 0) continue;
    const Vec3 along = (positions[at(x2)] - positions[at(x1)]).normalized();
    const Vec3 normal = along.cross(positions[at(x3)] - positions[at(x1)]).normalized();
    hold(x1, Mat3::Zero());
    hold(x2, along * along.transpose());
    hold(x3, Mat3::Identity() - normal * normal.transpose());
  }
}

VecX PartSystem::scaled(const VecX& load) const {
  VecX b = load / stiffness->force_unit();
  for (Size v = 0; v < rows.size(); ++v) {
    const auto first = static_cast<Eigen::Index>(3 * v);
    if (rows.first[v] == rows.first[v + 1])
      b.segment<3>(first).setZero();
    else if (system.hold_of[v] >= 0)
      b.segment<3>(first) = (system.holds[at(system.hold_of[v])].allowed * b.segment<3>(first)).eval();
  }
  return b;
}

SolidSolution PartSystem::solution_of(const GradientResult& result, const VecX& load, const VecX& rigid_part,
                                      const VecX& inertia) const {
  SolidSolution solution;
  solution.iterations = result.iterations;
  solution.residual = result.residual;
  VecX x = result.x, image = result.image;
  if (!std::isfinite(x.squaredNorm()) || !std::isfinite(result.residual)) {
    solution.fault = "the solve left the range of numbers";
    solution.residual = 1.0;
    solution.displacement = VecX::Zero(x.size());
    return solution;
  }
  if (!result.is_converged)
    solution.fault = "the solve did not settle in " + std::to_string(result.iterations) + " iterations";
  if (inertia.size() > 0) image -= inertia.cwiseProduct(x);
  solution.elastic_compliance = std::max(0.0, x.dot(image)) * stiffness->force_unit() * stiffness->length;
  if (is_relieved()) rigid.remove_motion(x);
  solution.displacement = x * stiffness->length;
  solution.compliance = load.dot(solution.displacement);
  if (rigid_part.size() > 0) {
    solution.rigid_displacement = rigid_part * stiffness->length;
    solution.compliance += load.dot(solution.rigid_displacement);
  }
  return solution;
}

std::vector<SolidSolution> PartSystem::solve(const std::vector<VecX>& loads,
                                             const SolidSolveSettings& settings,
                                             const std::vector<VecX>& guesses) const {
  const double screening = settings.screening * seconds();
  const double screening_squared = screening * screening;
  const bool is_screened = screening_squared > 0.0;

  BlockSystem screened;
  VecX inertia;
  if (is_screened) {
    inertia = screening_squared * mass;
    screened.rows = system.rows;
    screened.single = system.single;
    screened.hold_of = system.hold_of;
    screened.holds = system.holds;
    screened.inertia.resize(rows.size());
    for (Size v = 0; v < rows.size(); ++v) screened.inertia[v] = inertia(static_cast<Eigen::Index>(3 * v));
    invert_diagonal(screened);
    screened.coarse = &coarse;
    screened.coarse_factor = coarse.factor(screening_squared);
  }

  // A screened load's rigid part is answered in closed form, R R^T / s^2: only what bends is left to iterate.
  std::vector<VecX> work(loads.size()), rigid_parts(loads.size()), begins(loads.size());
  core::parallel_for(loads.size(), 1, [&](Size l) {
    work[l] = scaled(loads[l]);
    if (l < guesses.size() && guesses[l].size() > 0) begins[l] = guesses[l] / stiffness->length;
    if (!is_relieved()) return;
    if (begins[l].size() > 0) rigid.remove_motion(begins[l]);
    const VecX whole = work[l];
    rigid.balance(work[l]);
    if (is_screened) {
      const VecX resultant = whole - work[l];  // M R R^T b
      rigid_parts[l] = VecX::Zero(whole.size());
      for (Eigen::Index i = 0; i < whole.size(); ++i)
        if (mass(i) > 0.0) rigid_parts[l](i) = resultant(i) / inertia(i);
    }
    if (!(work[l].norm() > kRigidLoad * whole.norm())) work[l].setZero();
  });
  GradientSettings gradients;
  gradients.tolerance = settings.tolerance;
  gradients.most_iterations = settings.most_iterations;
  if (gradients.most_iterations == 0)
    gradients.most_iterations =
        1000 + static_cast<int>(40.0 * core::pow(static_cast<double>(rows.size()), 1.0 / 3.0));
  const std::vector<GradientResult> results =
      solve_by_gradients(is_screened ? screened : system, work, gradients, begins);
  std::vector<SolidSolution> solutions(loads.size());
  for (Size l = 0; l < loads.size(); ++l)
    solutions[l] = solution_of(results[l], loads[l], rigid_parts[l], inertia);
  return solutions;
}

VecX PartSystem::balance(const VecX& load) const {
  VecX b = scaled(load);
  rigid.balance(b);
  return b * stiffness->force_unit();
}

double PartSystem::first_period() const {
  const double squared = lowest_frequency_squared(system, mass, rigid);
  return squared > 0.0 ? 2.0 * core::kPi / core::sqrt(squared) * seconds() : 0.0;
}

bool PartSystem::can_move() const {
  return std::any_of(system.inverse.begin(), system.inverse.end(), [](double e) { return e != 0.0; });
}

double PartSystem::vibrating_moment(const VecX& displacement) const {
  VecX x = displacement / stiffness->length;
  rigid.remove_motion(x);
  return (mass.array() * x.array().square()).sum();
}

}  // namespace shatterbox::stress
