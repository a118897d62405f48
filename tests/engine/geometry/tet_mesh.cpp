#include "engine/geometry/tet_mesh.h"

#include <catch2/catch.hpp>

#include "engine/geometry/mass_properties.h"
#include "engine/geometry/solid_mesh.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

/// The unit cube about its diagonal: Kuhn's six tetrahedra.
TetMesh cube() {
  TetMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  mesh.tetrahedra = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  return mesh;
}

}  // namespace

TEST_CASE("tet mesh: six tetrahedra fill a cube") {
  const TetMesh mesh = cube();
  for (int t = 0; t < 6; ++t) CHECK(tetrahedron_volume(mesh, t) == Approx(1.0 / 6.0));
  CHECK(total_volume(mesh) == Approx(1.0));
  const TetTopology topology = build_tet_topology(mesh.tetrahedra);
  CHECK(topology.edges.size() == 19);  // 12 of the cube, 6 diagonals of sides, one through the middle
  CHECK(topology.faces.size() == 18);  // 12 outside, 6 inside
  for (std::size_t t = 0; t < 6; ++t)
    for (std::size_t f = 0; f < 4; ++f) {
      const auto& face = topology.faces[static_cast<std::size_t>(topology.tetrahedron_faces[t][f])];
      for (const int v : face) CHECK(v != mesh.tetrahedra[t][f]);
    }
}

TEST_CASE("tet mesh: the border is closed and faces outwards") {
  const TetMesh mesh = cube();
  const TriangleMesh surface = boundary_surface(mesh, build_tet_topology(mesh.tetrahedra));
  CHECK(surface.triangles.size() == 12);
  CHECK(surface.positions.size() == 8);
  CHECK(enclosed_volume(surface) == Approx(1.0));
  CHECK(surface_area(surface) == Approx(6.0));
}

TEST_CASE("solid mesh: uncut, each element is one whole cell") {
  auto elements = std::make_shared<SolidElements>();
  elements->mesh = cube();
  elements->topology = build_tet_topology(elements->mesh.tetrahedra);
  const SolidMesh solid = make_solid_mesh(elements);
  REQUIRE(solid.cells.size() == 6);
  CHECK(solid.degree_of_freedom_count() == 24);
  for (const SolidCell& cell : solid.cells) {
    CHECK(volume_fraction(solid, cell) == Approx(1.0));
    CHECK(cell.centroid == Vec3::Constant(0.25));
  }
}
