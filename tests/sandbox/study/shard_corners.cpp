// Corners of polygons that are known, their sides made rough, their insides cut into triangles.
#include "sandbox/study/shard_corners.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/elementary.h"
#include "engine/core/random.h"
#include "engine/geometry/mass_properties.h"

using namespace shatterbox;

namespace {

/// A fan about the origin: each side of a polygon in so many parts, moved by up to `rough` m.
geometry::TriangleMesh fan(const std::vector<Vec3>& corners, int parts, double rough, std::uint64_t seed) {
  core::Random random(seed);
  geometry::TriangleMesh mesh;
  mesh.positions.push_back(Vec3::Zero());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 along = corners[(i + 1) % corners.size()] - corners[i];
    for (int k = 0; k < parts; ++k) {
      const double shift = k == 0 ? 0.0 : random.uniform(-rough, rough);
      mesh.positions.push_back(corners[i] + k * along / parts +
                               shift * Vec3::UnitY().cross(along).normalized());
    }
  }
  const int count = static_cast<int>(mesh.positions.size()) - 1;
  for (int k = 0; k < count; ++k) mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % count});
  return mesh;
}

std::vector<Vec3> regular(int sides) {
  std::vector<Vec3> corners;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * core::kPi * (i + 0.3) / sides;
    corners.emplace_back(std::cos(angle), 0.0, std::sin(angle));
  }
  return corners;
}

}  // namespace

TEST_CASE("a shard has the corners of the polygon that it is about") {
  for (int sides = 3; sides <= 7; ++sides)
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const auto smooth = fan(regular(sides), 9, 0.0, seed), rough = fan(regular(sides), 9, 0.01, seed);
      const double tolerance = 0.05 * std::sqrt(geometry::surface_area(smooth));
      CHECK(sandbox::study::count_corners(smooth, tolerance) == sides);
      CHECK(sandbox::study::count_corners(rough, tolerance) == sides);
    }
  // A long one.
  const std::vector<Vec3> slab{{3, 0, 0.2}, {3, 0, -0.2}, {-3, 0, -0.2}, {-3, 0, 0.2}};
  CHECK(sandbox::study::count_corners(fan(slab, 20, 0.01, 3), 0.05) == 4);
}

TEST_CASE("a closed surface has no outline") {
  geometry::TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  CHECK(sandbox::study::count_corners(mesh, 0.01) == 0);
}
