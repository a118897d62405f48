// Spread loads, groups of a cracked patch, the load of a spin.
#include "engine/stress/shell_load.h"

#include <catch2/catch.hpp>

#include "engine/stress/shell_stress.h"
#include "engine/stress/shell_system.h"
#include "tests/engine/stress/meshes.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

namespace {

using std::size_t;

/// Sum and moment about the origin of the forces on the vertices.
std::pair<Vec3, Vec3> resultant(const geometry::ShellMesh& mesh, const VecX& load) {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (size_t v = 0; v < mesh.vertex_source.size(); ++v) {
    const Vec3 f = load.segment<3>(vertex_dof(static_cast<int>(v)));
    force += f;
    moment += mesh.elements->mesh.positions[static_cast<size_t>(mesh.vertex_source[v])].cross(f);
  }
  return {force, moment};
}

}  // namespace

TEST_CASE("a spread load has the force's resultant and, inside a plate, its moment") {
  const Elements elements = grid(20, 20, 1.0, 1.0, 0.3);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  for (const double radius : {0.2, 0.08, 0.01, 1e-5}) {
    const Vec3 point(0.43, 0.52, 0.01);
    const LoadPatch patch = find_load_patch(mesh, point, radius);
    REQUIRE((patch.centre - Vec3(0.43, 0.52, 0.0)).norm() < 1e-12);
    const auto [force, moment] = resultant(mesh, patch_load(mesh, patch, Vec3(0.0, 1.0, 2.0)));
    REQUIRE((force - Vec3(0.0, 1.0, 2.0)).norm() < 1e-12);
    REQUIRE((moment - patch.centre.cross(Vec3(0.0, 1.0, 2.0))).norm() < 0.02 * radius + 1e-9);
    for (const PatchShare& share : patch.shares)
      REQUIRE(share.corner_weights.sum() == Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("the weights of a patch follow 1 - (r/a)^2") {
  const Elements elements = grid(60, 60, 1.0, 1.0);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const LoadPatch patch = find_load_patch(mesh, Vec3(0.5, 0.5, 0.0), 0.25);
  // Within half the radius: 1 - (1 - 1/4)^2 of the whole.
  double inner = 0.0;
  for (const PatchShare& share : patch.shares) {
    const Vec3 place =
        geometry::position_in_element(*elements, mesh.cells[static_cast<size_t>(share.cell)].element,
                                      Vec2(share.corner_weights(1), share.corner_weights(2)));
    if ((place - patch.centre).norm() < 0.125) inner += share.weight;
  }
  REQUIRE(inner == Approx(7.0 / 16.0).epsilon(0.03));
}

TEST_CASE("a load does not jump to an opposite wall") {
  // Two sheets 2 cm apart in one mesh; the patch is 10 cm wide.
  geometry::TriangleMesh mesh = grid_mesh(10, 10, 1.0, 1.0);
  const int count = static_cast<int>(mesh.positions.size());
  const size_t triangles = mesh.triangles.size();
  for (int v = 0; v < count; ++v)
    mesh.positions.push_back(mesh.positions[static_cast<size_t>(v)] + Vec3(0.0, 0.0, 0.02));
  for (size_t t = 0; t < triangles; ++t) {
    const geometry::Triangle lower = mesh.triangles[t];
    mesh.triangles.push_back({lower[0] + count, lower[1] + count, lower[2] + count});
  }
  const geometry::ShellMesh shell = geometry::make_shell_mesh(make_elements(std::move(mesh)));
  const LoadPatch patch = find_load_patch(shell, Vec3(0.5, 0.5, 0.03), 0.1);
  REQUIRE(patch.shares.size() > 4);
  for (const PatchShare& share : patch.shares) REQUIRE(share.cell >= static_cast<int>(triangles));
}

TEST_CASE("a crack through the patch makes two groups that share the load") {
  const Elements elements = grid(20, 20, 1.0, 1.0, 0.2);
  const geometry::ShellMesh whole = geometry::make_shell_mesh(elements);
  const LoadPatch one = find_load_patch(whole, Vec3(0.51, 0.5, 0.0), 0.15);
  for (const int group : group_patch(one, geometry::find_cell_contacts(whole))) REQUIRE(group == 0);

  const geometry::ShellMesh cut = cut_between(whole, 0.5137);
  const LoadPatch patch = find_load_patch(cut, Vec3(0.5137, 0.5, 0.0), 0.15);
  const std::vector<int> groups = group_patch(patch, geometry::find_cell_contacts(cut));
  REQUIRE(*std::max_element(groups.begin(), groups.end()) == 1);
  REQUIRE(group_weight(patch, groups, 0) + group_weight(patch, groups, 1) == Approx(1.0).epsilon(1e-12));
  REQUIRE(group_weight(patch, groups, 0) == Approx(0.5).epsilon(0.05));
  const VecX sum = group_weight(patch, groups, 0) * group_load(cut, patch, groups, 0, Vec3::UnitZ()) +
                   group_weight(patch, groups, 1) * group_load(cut, patch, groups, 1, Vec3::UnitZ());
  REQUIRE((sum - patch_load(cut, patch, Vec3::UnitZ())).norm() < 1e-12);
  REQUIRE((resultant(cut, group_load(cut, patch, groups, 0, Vec3::UnitZ())).first - Vec3::UnitZ()).norm() <
          1e-12);
}

TEST_CASE("a spinning disc: closed-form hoop and radial stress") {
  const Elements elements = disc(24);
  ShellProperties properties;
  properties.poisson_ratio = 0.3;
  properties.thickness = 0.01;
  const auto stiffness = make_shell_stiffness(elements, properties);
  const geometry::ShellMesh mesh = geometry::make_shell_mesh(elements);
  const VecX load = centrifugal_load(*stiffness, mesh, Vec3(0.0, 0.0, 50.0), Vec3::Zero());
  REQUIRE(resultant(mesh, load).first.norm() < 1e-9 * load.norm());
  const auto system = ShellSystem::make(stiffness, mesh).value();
  const auto stresses = cell_stresses(*stiffness, mesh, system->solve(load).displacement);
  const double unit = properties.density * 2500.0;  // rho omega^2 R^2
  for (size_t c = 0; c < mesh.cells.size(); ++c) {
    const Vec3 x = geometry::position_in_element(*elements, static_cast<int>(c), Vec2(1.0 / 3.0, 1.0 / 3.0));
    const double r = x.norm();
    const double radial = 3.3 / 8.0 * unit * (1.0 - r * r);
    const double hoop = unit / 8.0 * (3.3 - 1.9 * r * r);
    const double mean = 0.5 * (stresses[c].membrane(0) + stresses[c].membrane(1));
    REQUIRE(mean == Approx(0.5 * (radial + hoop)).epsilon(0.05));
    REQUIRE(stresses[c].bending.norm() < 1e-6 * unit);
    if (r < 0.05)
      REQUIRE(worst_stress(stresses[c]).principal.first == Approx(3.3 / 8.0 * unit).epsilon(0.03));
  }
}
