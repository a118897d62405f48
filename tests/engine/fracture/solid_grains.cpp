// Grains of a solid: the lower envelope of energies.
#include "engine/geometry/solid_grains.h"

#include <catch2/catch.hpp>

#include "engine/fracture/split_solid.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/solid_surface.h"
#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

std::vector<double> grain_volumes(const SolidComplex& complex, std::size_t grains) {
  std::vector<double> volumes(grains, 0.0);
  for (const SolidPart& cell : complex.cells) volumes[static_cast<std::size_t>(cell.grain)] += cell.volume;
  return volumes;
}

void open_boundaries(SolidComplex& complex) {
  for (SolidFacet& facet : complex.facets)
    if (facet.parts[0] < 0 && facet.kind == FacetKind::grain && facet.tag >= 0) facet.kind = FacetKind::crack;
}

bool is_closed(const TriangleMesh& mesh) {
  const EdgeTopology topology = build_edge_topology(mesh.triangles);
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
    if (topology.triangle_count(static_cast<int>(e)) != 2) return false;
  return true;
}

}  // namespace

TEST_CASE("solid grains: linear energies give the exact regions on any mesh, in any order") {
  for (const auto& order : {std::array{0, 1, 2}, std::array{2, 0, 1}, std::array{1, 2, 0}}) {
    SolidComplex complex = make_solid_complex(test::make_cube_elements(3, 0.2));
    GrainEnergies energies;
    for (const int axis : order) {
      energies.emplace_back();
      for (const Vec3& p : complex.elements->mesh.positions) energies.back().push_back(p[axis]);
    }
    divide_into_grains(complex, energies, 10, 1e-9);
    settle(complex);
    CHECK(are_cells_closed(complex));
    for (const double volume : grain_volumes(complex, 3)) CHECK(volume == Approx(1.0 / 3.0).epsilon(1e-9));
    open_boundaries(complex);
    const auto split = fracture::split_solid(complex);
    REQUIRE(split.pieces.size() == 3);
    for (const auto& piece : split.pieces) {
      const SolidSurface surface = extract_surface(piece.complex);
      CHECK(is_closed(surface.mesh));
      CHECK(enclosed_volume(surface.mesh) == Approx(1.0 / 3.0).epsilon(1e-9));
    }
  }
}

TEST_CASE("solid grains: cells about seeds, closed they are one piece, open as many as there are grains") {
  core::Random random(4);
  SolidComplex complex = make_solid_complex(test::make_cube_elements(6, 0.2));
  GrainEnergies energies;
  for (int g = 0; g < 12; ++g) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    energies.emplace_back();
    for (const Vec3& p : complex.elements->mesh.positions)
      energies.back().push_back((p - Vec3(x, y, z)).norm());
  }
  divide_into_grains(complex, energies, 0);
  settle(complex);
  CHECK(are_cells_closed(complex));
  CHECK(total_volume(complex) == Approx(1.0).epsilon(1e-13));
  const auto whole = fracture::split_solid(complex);
  REQUIRE(whole.pieces.size() == 1);
  CHECK(whole.pieces[0].mesh.vertex_source.size() == complex.elements->mesh.positions.size());
  const std::vector<double> volumes = grain_volumes(complex, 12);
  open_boundaries(complex);
  const auto split = fracture::split_solid(complex);
  // Energies are linear in the elements: a grain's border is as fine as these, and all grains are in one
  // part.
  REQUIRE(split.pieces.size() == 12);
  double sum = 0.0;
  for (const auto& piece : split.pieces) {
    const SolidSurface surface = extract_surface(piece.complex);
    CHECK(is_closed(surface.mesh));
    const int grain = piece.complex.cells[0].grain;
    CHECK(enclosed_volume(surface.mesh) == Approx(volumes[static_cast<std::size_t>(grain)]));
    for (const int g : surface.triangle_grains) CHECK(g == grain);
    sum += enclosed_volume(surface.mesh);
  }
  CHECK(sum == Approx(1.0).epsilon(1e-12));
}
