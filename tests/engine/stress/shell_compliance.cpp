// Compliances that are found without displacements: against the full solve, in closed form where the motion
// is rigid, and to the bit whatever the company and the threads.
#include <catch2/catch.hpp>

#include "engine/core/parallel.h"
#include "engine/stress/shell_figures.h"
#include "engine/stress/shell_system.h"
#include "tests/engine/stress/meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

namespace {

using std::size_t;

ShellProperties glass() {
  ShellProperties properties;
  properties.thickness = 0.01;
  return properties;
}

/// Slanting unit loads at vertices all over the mesh.
std::vector<VecX> scattered_loads(const geometry::ShellMesh& mesh, int count) {
  std::vector<VecX> loads;
  for (int i = 0; i < count; ++i) {
    loads.push_back(VecX::Zero(mesh.degree_of_freedom_count()));
    const int vertex = (17 * i + 5) % static_cast<int>(mesh.vertex_source.size());
    loads.back().segment<3>(vertex_dof(vertex)) = Vec3(0.2 * i, -0.3, 1.0).normalized();
  }
  return loads;
}

/// Worst differences from the full solve, relative to the compliance of the load itself.
struct Differences {
  double matrix = 0.0, total = 0.0, elastic = 0.0;
};

Differences compare(const ShellSystem& system, const std::vector<VecX>& loads) {
  const std::vector<ShellSolution> solutions = system.solve(loads);
  const Eigen::MatrixXd matrix = system.compliance_matrix(loads, std::vector<int>(loads.size(), 0));
  const std::vector<LoadCompliance> alone = system.compliances(loads);
  Differences worst;
  for (size_t i = 0; i < loads.size(); ++i) {
    const double own = solutions[i].compliance;
    for (size_t j = 0; j < loads.size(); ++j) {
      const double entry = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      worst.matrix = std::max(worst.matrix, std::abs(entry - loads[i].dot(solutions[j].displacement)) / own);
    }
    worst.total = std::max(worst.total, std::abs(alone[i].total / own - 1.0));
    worst.elastic =
        std::max(worst.elastic, std::abs(alone[i].elastic / solutions[i].elastic_compliance - 1.0));
  }
  return worst;
}

}  // namespace

TEST_CASE("compliances without displacements are those of the full solve") {
  const Elements elements = grid(12, 9, 1.0, 0.7, 0.3);
  const auto stiffness = make_shell_stiffness(elements, glass());
  const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
  const geometry::ShellMesh cut = cut_between(whole, 0.4713);
  for (const geometry::ShellMesh* mesh : {&whole, &cut}) {
    const auto structure = ShellStructure::make(stiffness, *mesh);
    const std::vector<VecX> loads = scattered_loads(*mesh, 7);
    const double omega = 2.0 * core::kPi / ShellSystem::make(structure).value()->first_period();
    for (const double screening : {0.0, 0.3 * omega, 3.0 * omega, 300.0 * omega}) {
      const Differences worst = compare(*ShellSystem::make(structure, screening).value(), loads);
      CAPTURE(screening / omega, worst.matrix, worst.total, worst.elastic);
      REQUIRE(worst.matrix < 3e-6);
      REQUIRE(worst.total < 3e-6);
      REQUIRE(worst.elastic < 3e-6);
    }
  }
}

TEST_CASE("compliances of a clamped plate are those of the full solve") {
  const Elements elements = grid(12, 9, 1.0, 0.7, 0.3);
  const auto stiffness = make_shell_stiffness(elements, glass());
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  ShellSupport support;
  for (int i = 0; i <= 12; ++i) support.vertices.push_back(i);
  const auto structure = ShellStructure::make(stiffness, mesh, support);
  std::vector<VecX> loads = scattered_loads(mesh, 5);
  for (VecX& load : loads) load.head(3 * 13).setZero();  // what the support bears moves nothing
  std::erase_if(loads, [](const VecX& load) { return load.norm() == 0.0; });
  REQUIRE(loads.size() > 2);
  for (const double screening : {0.0, 2000.0}) {
    const Differences worst = compare(*ShellSystem::make(structure, screening).value(), loads);
    CAPTURE(screening, worst.matrix, worst.total, worst.elastic);
    REQUIRE(worst.matrix < 3e-6);
    REQUIRE(worst.total < 3e-6);
    REQUIRE(worst.elastic < 3e-6);
  }
}

TEST_CASE(
    "in a long window a free body gives way as a rigid one, and its elastic compliance is the balanced one") {
  const Elements elements = grid(10, 10, 1.0, 1.0);
  const auto stiffness = make_shell_stiffness(elements, glass());
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const auto structure = ShellStructure::make(stiffness, mesh);
  VecX load = VecX::Zero(mesh.degree_of_freedom_count());
  load(vertex_dof(5 * 11 + 5) + 2) = 1.0;
  const double mass = make_shell_figures(*stiffness, mesh).mass.mass;
  const auto balanced = ShellSystem::make(structure).value();
  const double omega = 2.0 * core::kPi / balanced->first_period();
  const double elastic = balanced->solve(load).compliance;
  REQUIRE(balanced->compliances({load}).front().total == Approx(elastic).epsilon(1e-6));
  // Far below the first frequency a factor alone would have no digits left for the elastic part.
  for (const double s : {1e-3 * omega, 1e-5 * omega}) {
    const LoadCompliance answer = ShellSystem::make(structure, s).value()->compliances({load}).front();
    REQUIRE(answer.total == Approx(1.0 / (mass * s * s) + elastic).epsilon(1e-6));
    REQUIRE(answer.elastic == Approx(elastic).epsilon(1e-5));
  }
}

TEST_CASE(
    "compliances have the same bits for one and two threads, alone or in company, and groups do not mix") {
  const Elements elements = icosphere(4);
  const auto stiffness = make_shell_stiffness(elements, glass());
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const auto system = ShellSystem::make(ShellStructure::make(stiffness, mesh), 500.0).value();
  const std::vector<VecX> loads = scattered_loads(mesh, 10);
  const std::vector<int> groups{0, 0, 1, 1, 1, 2, 3, 3, 3, 3};
  core::set_thread_count(1);
  const Eigen::MatrixXd one = system->compliance_matrix(loads, groups);
  const auto alone_one = system->compliances(loads);
  core::set_thread_count(2);
  const Eigen::MatrixXd two = system->compliance_matrix(loads, groups);
  const auto alone_two = system->compliances(loads);
  core::set_thread_count(0);
  REQUIRE(one == two);
  for (size_t i = 0; i < loads.size(); ++i) {
    REQUIRE(alone_one[i].total == alone_two[i].total);
    REQUIRE(alone_one[i].elastic == system->compliances({loads[i]}).front().elastic);
    const auto row = static_cast<Eigen::Index>(i);
    REQUIRE(one(row, row) == Approx(alone_one[i].total).epsilon(1e-9));
    REQUIRE(one(row, row) == system->compliance_matrix({loads[i]}, {0})(0, 0));
    for (size_t j = 0; j < loads.size(); ++j)
      REQUIRE((one(row, static_cast<Eigen::Index>(j)) == 0.0) == (groups[i] != groups[j]));
  }
}
