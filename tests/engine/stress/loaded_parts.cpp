// A part without a load has no stress: leaving it out changes no bit of the others' answer.
#include "engine/stress/loaded_parts.h"

#include <catch2/catch.hpp>

#include "engine/core/index.h"
#include "tests/engine/stress/meshes.h"
#include "tests/engine/stress/solving.h"

using namespace shatterbox;
using namespace shatterbox::stress;
using namespace shatterbox::stress::testing;

namespace {

/// A plate in three strips.
geometry::ShellMesh three_strips() {
  const auto plate = geometry::make_shell_mesh(grid(12, 6, 1.0, 0.5, 0.3));
  return cut_between(cut_between(plate, 0.37), 0.71);
}

VecX push(const geometry::ShellMesh& mesh, double x) {
  const LoadPatch patch = find_load_patch(mesh, Vec3(x, 0.2, 0.0), 0.05);
  return patch_load(mesh, patch, Vec3(0.1, 0.2, -1.0));
}

double middle_x(const geometry::ShellMesh& mesh, const geometry::ShellCell& cell) {
  double sum = 0.0;
  for (int i = 0; i < cell.corner_count; ++i)
    sum += geometry::position_in_element(*mesh.elements, cell.element,
                                         mesh.corners[core::at(cell.first_corner + i)].barycentric)
               .x();
  return sum / cell.corner_count;
}

}  // namespace

TEST_CASE("only parts that are loaded are kept, with all degrees of freedom") {
  const auto mesh = three_strips();
  const VecX left = push(mesh, 0.1), right = push(mesh, 0.9);
  const auto one = loaded_parts(mesh, {&left});
  const auto two = loaded_parts(mesh, {&left, &right});
  REQUIRE(!one.cells.empty());
  for (const auto& cell : one.cells) CHECK(middle_x(mesh, cell) < 0.37);
  for (const auto& cell : two.cells) CHECK(std::abs(middle_x(mesh, cell) - 0.54) > 0.17);
  double area = 0.0;
  for (const auto& cell : two.cells) area += cell.area;
  CHECK(area == Approx(0.5 * (1.0 - 0.34)));
  CHECK(two.degree_of_freedom_count() == mesh.degree_of_freedom_count());
  const VecX nothing = VecX::Zero(mesh.degree_of_freedom_count());
  CHECK(loaded_parts(mesh, {&nothing}).cells.empty());
}

TEST_CASE("the answer of loaded parts is that of the whole, to the bit, and zero elsewhere") {
  const auto mesh = three_strips();
  const auto stiffness = make_shell_stiffness(mesh.elements, properties_of(0.01));
  const VecX load = push(mesh, 0.5);
  const auto loaded = loaded_parts(mesh, {&load});
  REQUIRE(loaded.cells.size() < mesh.cells.size());
  for (const double screening : {0.0, 64.0, 8192.0}) {
    const auto whole = make_system(stiffness, mesh, screening)->solve(load);
    const auto part = make_system(stiffness, loaded, screening)->solve(load);
    CHECK(part.displacement == whole.displacement);
    CHECK(part.compliance == whole.compliance);
    CHECK(part.elastic_compliance == whole.elastic_compliance);
    for (const auto& cell : mesh.cells)
      if (middle_x(mesh, cell) < 0.37)
        for (const int dof : cell_dofs(mesh, cell)) CHECK(part.displacement(dof) == 0.0);
  }
}
