#include "engine/fracture/space_grains.h"

#include <algorithm>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/fracture/seed_spacing.h"
#include "engine/fracture/space_points.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kSeedsPerCube = 1.3;  // of the spacing, as they come out
constexpr double kNearEdges = 2.5;     // edges, over which the energies of two grains may change

/// How many times longer than wide grains are.
double length_of(const material::Material& material) {
  return std::max(1.0, material.grain_direction.norm());
}

/// Longest edge at each node, m.
std::vector<double> longest_edges(const geometry::TetMesh& mesh) {
  std::vector<double> longest(mesh.positions.size(), 0.0);
  for (const geometry::Tetrahedron& t : mesh.tetrahedra)
    for (const auto& edge : geometry::kTetrahedronEdges) {
      const int a = t[at(edge[0])], b = t[at(edge[1])];
      const double length = (mesh.positions[at(a)] - mesh.positions[at(b)]).norm();
      for (const int v : {a, b}) longest[at(v)] = std::max(longest[at(v)], length);
    }
  return longest;
}

/// Which grains matter at which node.
void find_near(const geometry::TetMesh& mesh, const Mat3& squeeze, SpaceGrains& grains) {
  double greatest_weight = 0.0;
  for (const GrainSeed& s : grains.seeds) greatest_weight = std::max(greatest_weight, s.weight);
  grains.reach = longest_edges(mesh);
  for (double& reach : grains.reach) reach *= kNearEdges * greatest_weight;
  std::vector<std::vector<NodeGrain>> near(mesh.positions.size());
  core::parallel_for(near.size(), 64, [&](Size n) {
    double least = 1e300;
    for (Size g = 0; g < grains.seeds.size(); ++g) {
      const double energy = seed_energy(grains.seeds[g], squeeze, mesh.positions[n]);
      if (energy > least + grains.reach[n]) continue;
      least = std::min(least, energy);
      near[n].push_back({static_cast<int>(g), energy});
    }
    std::erase_if(near[n], [&](const NodeGrain& g) { return g.energy > least + grains.reach[n]; });
    std::sort(near[n].begin(), near[n].end(), [](const NodeGrain& x, const NodeGrain& y) {
      return x.energy != y.energy ? x.energy < y.energy : x.grain < y.grain;
    });
  });
  grains.first_of_node.push_back(0);
  for (const auto& list : near) {
    grains.near.insert(grains.near.end(), list.begin(), list.end());
    grains.first_of_node.push_back(static_cast<int>(grains.near.size()));
  }
}

}  // namespace

double expected_grains(const Vec3& box, const material::Material& material) {
  const double size = material.grain_size;
  return kSeedsPerCube * box.prod() / (size * size * size * length_of(material));
}

std::vector<GrainSeed> scatter_grain_seeds(const Vec3& low, const Vec3& high,
                                           const material::Material& material, std::uint64_t seed) {
  struct Dart {
    std::uint64_t key = 0;
    GrainSeed seed;
  };
  const double spacing = material.grain_size, length = length_of(material);
  const double cube = spacing * core::pow(SpacePoints::kPointsPerCube * length / kDartsPerSeed, 1.0 / 3.0);
  std::vector<Dart> darts;
  // Beyond the border too: a grain there may reach in.
  const Vec3 margin = Vec3::Constant(spacing * length);
  SpacePoints(cube, core::mix(seed + 0x6772a1))
      .visit_box(low - margin, high + margin, [&](const Vec3& place, core::Random random) {
        const std::uint64_t key = random.bits();
        darts.push_back({key, {place, 1.0 + kSeedWeightScatter * random.uniform(-1.0, 1.0)}});
      });
  std::sort(darts.begin(), darts.end(), [](const Dart& a, const Dart& b) { return a.key < b.key; });
  SeedSpacing chosen(kLeastSeedSpacing * spacing, grain_squeeze(material));
  std::vector<GrainSeed> seeds;
  for (const Dart& dart : darts)
    if (chosen.take(dart.seed.position)) seeds.push_back(dart.seed);
  return seeds;
}

SpaceGrains make_space_grains(const geometry::TetMesh& mesh, const material::Material& material,
                              std::uint64_t seed) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& x : mesh.positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  SpaceGrains grains;
  grains.seeds = scatter_grain_seeds(low, high, material, seed);
  find_near(mesh, grain_squeeze(material), grains);
  return grains;
}

}  // namespace shatterbox::fracture
