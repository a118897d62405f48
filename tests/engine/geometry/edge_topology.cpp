#include "engine/geometry/edge_topology.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/geometry/generators.h"

namespace shatterbox::geometry {

TEST_CASE("two triangles have five edges, one of them shared") {
  const EdgeTopology topology = build_edge_topology({{0, 1, 2}, {2, 1, 3}});
  REQUIRE(topology.edges.size() == 5);
  CHECK(topology.edges == std::vector<std::array<int, 2>>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}});
  CHECK(topology.triangle_edges == std::vector<std::array<int, 3>>{{0, 2, 1}, {2, 3, 4}});
  for (int e = 0; e < 5; ++e) CHECK(topology.is_boundary(e) == (e != 2));
  CHECK(topology.triangle_count(2) == 2);
}

TEST_CASE("an edge may have three triangles, listed in ascending order") {
  const EdgeTopology topology = build_edge_topology({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  REQUIRE(topology.edges[0] == std::array<int, 2>{0, 1});
  CHECK(topology.triangle_count(0) == 3);
  CHECK(std::is_sorted(topology.edge_triangles.begin(), topology.edge_triangles.begin() + 3));
}

TEST_CASE("Euler's formula and the lists agree on a sphere") {
  const TriangleMesh mesh = make_sphere(1.0, {0.2, 0.3, 1}).value();
  const EdgeTopology topology = build_edge_topology(mesh.triangles);
  CHECK(mesh.positions.size() + mesh.triangles.size() - topology.edges.size() == 2);
  CHECK(std::is_sorted(topology.edges.begin(), topology.edges.end()));
  CHECK(topology.edge_triangles.size() == 3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int edge = topology.triangle_edges[t][i];
      const int a = mesh.triangles[t][i];
      const int b = mesh.triangles[t][(i + 1) % 3];
      const std::array<int, 2> ends{std::min(a, b), std::max(a, b)};
      REQUIRE(topology.edges[static_cast<std::size_t>(edge)] == ends);
      const auto begin =
          topology.edge_triangles.begin() + topology.first_triangle[static_cast<std::size_t>(edge)];
      const auto end = begin + topology.triangle_count(edge);
      REQUIRE(std::count(begin, end, static_cast<int>(t)) == 1);
    }
}

TEST_CASE("no triangles, no edges") {
  const EdgeTopology topology = build_edge_topology({});
  CHECK(topology.edges.empty());
  CHECK(topology.first_triangle.size() == 1);
}

}  // namespace shatterbox::geometry
