#include "engine/geometry/weld.h"

#include <catch2/catch.hpp>

namespace shatterbox::geometry {

TEST_CASE("positions equal to the bit become one, in the order of first appearance") {
  TriangleMesh mesh;
  const double almost = 1.0 + 0x1.0p-52;
  mesh.positions = {{1, 0, 0},      {0, 0, 0}, {-0.0, 0, 0},   {1, 0, 0},
                    {almost, 0, 0}, {0, 1, 0}, {0, -0.0, -0.0}};
  mesh.triangles = {{0, 2, 5}, {3, 5, 6}, {4, 1, 5}};
  CHECK(find_equal_positions(mesh.positions) == std::vector<int>{0, 1, 1, 0, 4, 5, 1});
  CHECK(weld_equal_positions(mesh) == 3);
  REQUIRE(mesh.positions.size() == 4);
  CHECK(mesh.positions[2].x() == almost);
  CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {0, 3, 1}, {2, 1, 3}});
  CHECK(weld_equal_positions(mesh) == 0);
}

TEST_CASE("vertices without triangles are dropped") {
  TriangleMesh mesh;
  mesh.positions = {{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{1, 3, 4}};
  CHECK(drop_unused_vertices(mesh) == 2);
  CHECK(mesh.positions.size() == 3);
  CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
  TriangleMesh empty;
  CHECK(drop_unused_vertices(empty) == 0);
}

}  // namespace shatterbox::geometry
