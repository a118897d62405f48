// Surfaces in smaller triangles.
#include "engine/geometry/finer_triangles.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/index.h"
#include "engine/geometry/edge_topology.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"

namespace shatterbox::geometry {
namespace {

using core::at;

double longest_edge(const TriangleMesh& mesh) {
  double longest = 0.0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      longest = std::max(longest, (mesh.positions[at(t[i])] - mesh.positions[at(t[(i + 1) % 3])]).norm());
  return longest;
}

// The sum of the areas as vectors, m2.
Vec3 area_vector(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : mesh.triangles)
    sum += 0.5 * (mesh.positions[at(t[1])] - mesh.positions[at(t[0])])
                     .cross(mesh.positions[at(t[2])] - mesh.positions[at(t[0])]);
  return sum;
}

}  // namespace

TEST_CASE("finer triangles: a box of twelve stays closed, faces outwards, and is the same surface") {
  const TriangleMesh box = make_box_surface(Vec3(0.3, 0.2, 0.05));
  for (const double longest : {0.5, 0.1, 0.011}) {
    INFO(longest << " m");
    const TriangleMesh fine = divide_long_edges(box, longest);
    CHECK(longest_edge(fine) <= longest);
    CHECK(fine.triangles.size() > box.triangles.size());
    CHECK(least_angle(fine) >= 0.5 * least_angle(box));
    CHECK(surface_area(fine) == Approx(surface_area(box)).epsilon(1e-12));
    CHECK(area_vector(fine).norm() < 1e-14);
    const EdgeTopology topology = build_edge_topology(fine.triangles);
    std::size_t closed = 0;
    for (std::size_t e = 0; e < topology.edges.size(); ++e)
      closed += topology.triangle_count(static_cast<int>(e)) == 2 ? 1 : 0;
    CHECK(closed == topology.edges.size());
    const MassProperties before = solid_mass_properties(box, 1.0), after = solid_mass_properties(fine, 1.0);
    CHECK(after.mass == Approx(before.mass).epsilon(1e-12));
  }
}

TEST_CASE("finer triangles: sheets that meet in one edge fit together on it") {
  TriangleMesh fan;
  fan.positions = {{0, 0, 0}, {1, 0, 0}, {0.4, 1, 0}, {0.6, -0.5, 0.8}, {0.5, -0.4, -0.7}};
  fan.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  const TriangleMesh fine = divide_long_edges(fan, 0.07);
  CHECK(longest_edge(fine) <= 0.07);
  CHECK(surface_area(fine) == Approx(surface_area(fan)).epsilon(1e-12));
  // Where they meet every edge has three triangles, and vertices are nowhere twice.
  const EdgeTopology topology = build_edge_topology(fine.triangles);
  std::size_t shared = 0;
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
    shared += topology.triangle_count(static_cast<int>(e)) == 3 ? 1 : 0;
  CHECK(shared == 16);
  std::size_t on_axis = 0;
  for (const Vec3& p : fine.positions) on_axis += p.y() == 0.0 && p.z() == 0.0 ? 1 : 0;
  CHECK(on_axis == shared + 1);
}

TEST_CASE("finer triangles: what is fine enough stays as it is") {
  const TriangleMesh box = make_box_surface(Vec3(0.3, 0.2, 0.05));
  const TriangleMesh same = divide_long_edges(box, 2.0);
  CHECK(same.triangles == box.triangles);
  CHECK(same.positions.size() == box.positions.size());
}

}  // namespace shatterbox::geometry
