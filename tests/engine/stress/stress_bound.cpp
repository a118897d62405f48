// The bound of a stress by an energy holds for random loads and displacements, whole and cut, and is not far
// off for the worst of them.
#include "engine/stress/stress_bound.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/geometry/box_tets.h"
#include "engine/stress/shell_stress.h"
#include "engine/stress/shell_support.h"
#include "engine/stress/shell_system.h"
#include "engine/stress/solid_stress.h"
#include "tests/engine/stress/meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

namespace {

double worst_of(const std::vector<CellStress>& stresses) {
  double worst = 0.0;
  for (const CellStress& stress : stresses) worst = std::max(worst, worst_stress(stress).principal.first);
  return worst;
}

}  // namespace

TEST_CASE("no stress exceeds what its energy allows") {
  core::Random random(5, 0);
  std::vector<geometry::ShellMesh> meshes;
  meshes.push_back(geometry::make_shell_mesh(grid(8, 7, 1.0, 0.9, 0.35)));
  meshes.push_back(geometry::make_shell_mesh(icosphere(2, 0.04)));
  meshes.push_back(cut_between(meshes[0], 0.413));
  meshes.push_back(cut_between(meshes[0], 0.5000001));  // slivers below the floor of the stiffness
  for (const geometry::ShellMesh& mesh : meshes)
    for (const double thickness : {0.001, 0.05}) {
      ShellProperties properties;
      properties.thickness = thickness;
      const auto stiffness = make_shell_stiffness(mesh.elements, properties);
      const auto contacts = geometry::find_cell_contacts(mesh);
      const double plain_area = least_stressed_area(mesh);
      const double mean_area = least_stressed_area(mesh, contacts);
      const std::vector<double> areas = stressed_areas(mesh, contacts);
      REQUIRE(*std::min_element(areas.begin(), areas.end()) == mean_area);
      REQUIRE(plain_area > 0.0);
      double closest = 0.0;
      const auto check = [&](const VecX& u) {
        const double energy = 0.5 * u.dot(apply_stiffness(*stiffness, mesh, u));
        const auto stresses = cell_stresses(*stiffness, mesh, u);
        const double bound = stress_bound(properties, plain_area, energy);
        REQUIRE(worst_of(stresses) <= bound);
        const auto means = average_stresses(mesh, contacts, stresses);
        REQUIRE(worst_of(means) <= stress_bound(properties, mean_area, energy));
        for (std::size_t c = 0; c < means.size(); ++c)
          if (!(worst_stress(means[c]).principal.first <= stress_bound(properties, areas[c], energy)))
            FAIL("cell " << c << " is above its own bound");
        closest = std::max(closest, worst_of(stresses) / bound);
      };
      for (int trial = 0; trial < 20; ++trial) {
        VecX u(mesh.degree_of_freedom_count());
        for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = random.uniform(-1.0, 1.0) * 1e-3;
        check(u);
        // One unknown alone puts nearly all energy into few cells.
        const auto one = static_cast<Eigen::Index>(random.index(static_cast<std::uint64_t>(u.size())));
        check(VecX::Unit(u.size(), one));
      }
      const auto system = ShellSystem::make(stiffness, mesh).value();
      for (int trial = 0; trial < 10; ++trial) {
        VecX load = VecX::Zero(mesh.degree_of_freedom_count());
        const auto v = static_cast<int>(random.index(mesh.vertex_source.size()));
        for (int axis = 0; axis < 3; ++axis) load(vertex_dof(v) + axis) = random.uniform(-1.0, 1.0);
        check(system->solve(load).displacement);
      }
      CAPTURE(thickness, closest);
      REQUIRE(closest > 0.03);
    }
}

TEST_CASE("a strip bent over its length reaches its bound, anything broader stays below") {
  // Held at x = 0, pushed down at x = 1 all along its end: 6 F l / (b t^2) where it is held.
  const double length = 1.0, thickness = 0.01, force = 3.0;
  for (const double width : {0.1, 0.6}) {
    const geometry::ShellMesh mesh = geometry::make_shell_mesh(grid(60, width > 0.5 ? 12 : 6, length, width));
    ShellProperties properties;
    properties.thickness = thickness;
    properties.poisson_ratio = 0.0;
    const auto& elements = *mesh.elements;
    std::vector<char> vertices(elements.mesh.positions.size(), 0), edges(elements.topology.edges.size(), 0);
    double count = 0.0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      vertices[v] = elements.mesh.positions[v].x() < 1e-9;
      count += elements.mesh.positions[v].x() > length - 1e-9;
    }
    for (std::size_t e = 0; e < edges.size(); ++e)
      edges[e] = vertices[static_cast<std::size_t>(elements.topology.edges[e][0])] &&
                 vertices[static_cast<std::size_t>(elements.topology.edges[e][1])];
    VecX load = VecX::Zero(mesh.degree_of_freedom_count());
    for (std::size_t v = 0; v < vertices.size(); ++v)
      if (elements.mesh.positions[v].x() > length - 1e-9)
        load(vertex_dof(static_cast<int>(v)) + 2) = -force / count;
    const auto stiffness = make_shell_stiffness(mesh.elements, properties);
    const auto system = ShellSystem::make(stiffness, mesh, 0.0, find_support(mesh, vertices, edges)).value();
    const double worst = worst_of(cell_stresses(*stiffness, mesh, system->solve(load).displacement));
    REQUIRE(worst == Approx(bending_bound(thickness, width, length, force)).epsilon(0.05));
    REQUIRE(worst < bending_bound(thickness, 0.09, length, force));
  }
}

TEST_CASE("no energy, no stress") {
  REQUIRE(stress_bound(ShellProperties{}, 1e-4, 0.0) == 0.0);
}

TEST_CASE("no stress of a solid exceeds what its energy allows") {
  core::Random random(6, 0);
  auto box = geometry::make_box_tets(Vec3(0.5, 0.4, 0.3), 0.2);
  REQUIRE(box.ok());
  auto elements = std::make_shared<geometry::SolidElements>();
  elements->mesh = box.value();
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  geometry::SolidMesh mesh = geometry::make_solid_mesh(elements);
  std::vector<geometry::SolidContact> contacts;
  for (const auto& [a, b] : elements->topology.face_tetrahedra)
    if (b >= 0) contacts.push_back({a, b, 1.0});
  for (std::size_t c = 0; c < mesh.cells.size(); c += 3) mesh.cells[c].volume *= random.uniform(0.001, 1.0);
  for (const double nu : {0.0, 0.22, 0.4}) {
    SolidProperties properties;
    properties.poisson_ratio = nu;
    const auto stiffness = make_solid_stiffness(elements, properties);
    const std::vector<double> volumes = stressed_volumes(*stiffness, mesh, contacts);
    double closest = 0.0;
    const auto check = [&](const VecX& u) {
      const double energy = 0.5 * u.dot(apply_stiffness(*stiffness, mesh, u));
      const auto means = average_stresses(mesh, contacts, cell_stresses(*stiffness, mesh, u));
      for (std::size_t c = 0; c < means.size(); ++c) {
        const double first = principal_axes(means[c]).values(0);
        const double bound = stress_bound(*stiffness, volumes[c], energy);
        if (!(first <= bound)) FAIL("cell " << c << " is above its bound");
        closest = std::max(closest, first / bound);
      }
    };
    for (int trial = 0; trial < 20; ++trial) {
      VecX u(mesh.degree_of_freedom_count());
      for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = random.uniform(-1e-3, 1e-3);
      check(u);
    }
    // The worst: all of the mesh strained along one axis and no other.
    VecX u = VecX::Zero(mesh.degree_of_freedom_count());
    for (std::size_t v = 0; v < mesh.vertex_source.size(); ++v)
      u(static_cast<Eigen::Index>(3 * v)) = 1e-3 * elements->mesh.positions[v].x();
    check(u);
    CHECK(closest > 0.02);
  }
}
