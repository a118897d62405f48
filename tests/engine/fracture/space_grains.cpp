// Grains of solids: where they are, and how they guide cracks.
#include "engine/fracture/space_grains.h"

#include <catch2/catch.hpp>

#include "engine/fracture/decide_solid.h"
#include "engine/fracture/grain_surface.h"
#include "tests/engine/geometry/solids.h"

using namespace shatterbox;
using namespace shatterbox::fracture;

namespace {

material::Material grained(double size, const Vec3& direction = Vec3::Zero()) {
  material::Material m = *material::find_preset("plaster");
  m.grain_size = size;
  m.grain_direction = direction;
  return m;
}

double value_of(const geometry::TetMesh& mesh, int node) {
  // A plane askew to the elements, with no node on it.
  return Vec3(0.31, 0.57, 0.23).dot(mesh.positions[static_cast<std::size_t>(node)]) - 0.5513;
}

std::vector<double> plane_field(const geometry::TetMesh& mesh) {
  std::vector<double> field;
  for (int n = 0; n < static_cast<int>(mesh.positions.size()); ++n) field.push_back(value_of(mesh, n));
  return field;
}

/// An element through which the plane goes.
int crossed_element(const geometry::TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    int above = 0;
    for (const int node : mesh.tetrahedra[t]) above += value_of(mesh, node) > 0.0 ? 1 : 0;
    if (above == 2) return static_cast<int>(t);
  }
  return 0;
}

}  // namespace

TEST_CASE("space grains: seeds keep apart and fill the box as densely as is told") {
  const material::Material even = grained(0.1);
  const auto seeds = scatter_grain_seeds(Vec3::Zero(), Vec3::Constant(1.0), even, 7);
  int inside = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vec3& p = seeds[i].position;
    inside += p.minCoeff() >= 0.0 && p.maxCoeff() <= 1.0 ? 1 : 0;
    CHECK(std::abs(seeds[i].weight - 1.0) <= 0.15);
    for (std::size_t j = 0; j < i; ++j) REQUIRE((seeds[j].position - p).norm() >= 0.07);
  }
  CHECK(inside == Approx(expected_grains(Vec3::Constant(1.0), even)).epsilon(0.1));

  const material::Material longer = grained(0.1, Vec3(0, 0, 4));
  const auto stretched = scatter_grain_seeds(Vec3::Zero(), Vec3(1, 1, 4), longer, 7);
  const Mat3 squeeze = grain_squeeze(longer);
  CHECK((squeeze * Vec3(1, 2, 4) - Vec3(1, 2, 1)).norm() < 1e-12);
  inside = 0;
  for (const GrainSeed& seed : stretched) {
    const Vec3& p = seed.position;
    inside += p.minCoeff() >= 0.0 && p.x() <= 1.0 && p.y() <= 1.0 && p.z() <= 4.0 ? 1 : 0;
  }
  CHECK(inside == Approx(expected_grains(Vec3(1, 1, 4), longer)).epsilon(0.1));
}

TEST_CASE("space grains: every node is in the grain of least energy, long ones are as long as is told") {
  const auto elements = test::make_cube_elements(20, 0.0);
  for (const double length : {1.0, 3.0}) {
    const material::Material m = grained(0.15, Vec3(length, 0, 0));
    const SpaceGrains grains = make_space_grains(elements->mesh, m, 3);
    const Mat3 squeeze = grain_squeeze(m);
    std::vector<std::vector<Vec3>> members(grains.seeds.size());
    for (int n = 0; n < static_cast<int>(elements->mesh.positions.size()); ++n) {
      const Vec3& x = elements->mesh.positions[static_cast<std::size_t>(n)];
      const NodeGrain& own = grains.of_node(n).front();
      for (const GrainSeed& seed : grains.seeds)
        if (seed_energy(seed, squeeze, x) < own.energy) FAIL("node " << n << " is nearer to another grain");
      members[static_cast<std::size_t>(own.grain)].push_back(x);
    }
    double along = 0.0, across = 0.0;
    for (const auto& list : members) {
      if (list.size() < 20) continue;
      Vec3 low = list.front(), high = low, mean = Vec3::Zero();
      for (const Vec3& x : list) mean += x / static_cast<double>(list.size());
      for (const Vec3& x : list) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
      if (low.minCoeff() <= 0.0 || high.maxCoeff() >= 1.0) continue;  // cut off by the border
      for (const Vec3& x : list) {
        along += (x - mean).x() * (x - mean).x();
        across += 0.5 * (x - mean).tail<2>().squaredNorm();
      }
    }
    REQUIRE(across > 0.0);
    CHECK(std::sqrt(along / across) == Approx(length).epsilon(0.25));
  }
}

TEST_CASE("space grains: where boundaries are as tough as grains a crack goes as without them") {
  const auto elements = test::make_cube_elements(10, 0.2);
  const geometry::TetMesh& mesh = elements->mesh;
  const SpaceGrains grains = make_space_grains(mesh, grained(0.25), 5);
  const std::vector<double> plane = plane_field(mesh);
  const std::vector<double> same = follow_grains(grains, mesh, plane, crossed_element(mesh), 1.0);
  std::size_t moved = 0;
  for (std::size_t n = 0; n < plane.size(); ++n) {
    REQUIRE(same[n] != 0.0);
    moved += (same[n] > 0.0) != (plane[n] > 0.0) ? 1 : 0;
  }
  // Only nodes that are near the surface and were put on it.
  CHECK(moved * 20 < plane.size());
}

TEST_CASE("space grains: where boundaries hold hardly, grains stay whole but the one it starts in") {
  const auto elements = test::make_cube_elements(16, 0.2);
  const geometry::TetMesh& mesh = elements->mesh;
  const SpaceGrains grains = make_space_grains(mesh, grained(0.25), 5);
  const int start = crossed_element(mesh);
  const std::vector<double> plane = plane_field(mesh);
  const std::vector<double> field = follow_grains(grains, mesh, plane, start, 0.04);
  std::vector<char> is_start(grains.seeds.size(), 0);
  for (const int node : mesh.tetrahedra[static_cast<std::size_t>(start)])
    is_start[static_cast<std::size_t>(grains.owner(node))] = 1;
  // Nodes that a crack parts from the greater part of their grains.
  const auto count_parted = [&](const std::vector<double>& values) {
    std::vector<int> above(grains.seeds.size(), 0), below(grains.seeds.size(), 0);
    for (std::size_t n = 0; n < values.size(); ++n)
      ++(values[n] > 0.0 ? above : below)[static_cast<std::size_t>(grains.owner(static_cast<int>(n)))];
    int parted = 0;
    for (std::size_t g = 0; g < above.size(); ++g)
      if (!is_start[g]) parted += std::min(above[g], below[g]);
    return parted;
  };
  const int by_plane = count_parted(plane);
  CHECK(by_plane > 100);
  CHECK(count_parted(field) < by_plane / 2);  // by what its edges are rounded
  int crossed = 0, on_boundary = 0;
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    const auto is_above = [&](int node) { return field[static_cast<std::size_t>(node)] > 0.0; };
    if (std::all_of(t.begin(), t.end(), is_above) || std::none_of(t.begin(), t.end(), is_above)) continue;
    ++crossed;
    on_boundary += is_on_boundary(grains, t, field) ? 1 : 0;
  }
  CHECK(on_boundary > crossed / 2);
}
