#include "engine/fracture/grains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/core/elementary.h"
#include "engine/core/index.h"
#include "engine/core/random.h"
#include "engine/fracture/flaws.h"
#include "engine/fracture/seed_spacing.h"

namespace shatterbox::fracture {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kVertexLead = 0.1;  // energy lead of a vertex's grain, share of its shortest edge

/// Shortest and longest edge at each vertex, m.
struct VertexScale {
  double shortest = 1e300, longest = 0.0;
};

std::vector<VertexScale> vertex_scales(const geometry::ShellElements& elements) {
  std::vector<VertexScale> scales(elements.mesh.positions.size());
  for (const auto& edge : elements.topology.edges) {
    const double length =
        (elements.mesh.positions[at(edge[0])] - elements.mesh.positions[at(edge[1])]).norm();
    for (const int v : edge) {
      scales[at(v)].shortest = std::min(scales[at(v)].shortest, length);
      scales[at(v)].longest = std::max(scales[at(v)].longest, length);
    }
  }
  return scales;
}

/// The vertex's own grain: the least energy, lowered so that it leads clearly.
struct VertexGrain {
  int grain = 0;
  double energy = 0.0;
};

}  // namespace

Mat3 grain_squeeze(const material::Material& material) {
  const double length = material.grain_direction.norm();
  if (!(length > 0.0)) return Mat3::Identity();
  const Vec3 along = material.grain_direction / length;
  return Mat3::Identity() - (1.0 - 1.0 / length) * along * along.transpose();
}

double seed_energy(const GrainSeed& seed, const Mat3& squeeze, const Vec3& x) {
  return seed.weight * (squeeze * (x - seed.position)).norm();
}

std::vector<GrainSeed> scatter_grain_seeds(const geometry::ShellElements& elements, double spacing,
                                           std::uint64_t seed, const Mat3& squeeze) {
  std::vector<GrainSeed> seeds;
  if (!(spacing > 0.0)) return seeds;
  std::vector<SurfacePoint> darts =
      scatter_on_surface(elements, kDartsPerSeed / (spacing * spacing), core::mix(seed + 0x6772a1));
  std::sort(darts.begin(), darts.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
    return a.key != b.key ? a.key < b.key : a.element < b.element;
  });
  SeedSpacing chosen(kLeastSeedSpacing * spacing, squeeze);
  for (const SurfacePoint& dart : darts) {
    const Vec3 x = position_in_element(elements, dart.element, dart.barycentric);
    if (!chosen.take(x)) continue;
    core::Random random(dart.key, 3);
    seeds.push_back({x, 1.0 + kSeedWeightScatter * random.uniform(-1.0, 1.0)});
  }
  return seeds;
}

GrainField make_grain_field(const geometry::ShellElements& elements, std::vector<GrainSeed> seeds,
                            const Mat3& squeeze) {
  GrainField field;
  field.seeds = std::move(seeds);
  if (field.seeds.empty()) return field;
  const std::vector<VertexScale> scales = vertex_scales(elements);
  const Size vertex_count = elements.mesh.positions.size();

  // A vertex keeps the grains that can win somewhere on the elements about it: those within what the energies
  // can change over an edge, of each of the two.
  std::vector<VertexGrain> winners(vertex_count);
  std::vector<std::vector<int>> kept(vertex_count);
  double greatest_weight = 0.0;
  for (const GrainSeed& seed : field.seeds) greatest_weight = std::max(greatest_weight, seed.weight);
  for (Size v = 0; v < vertex_count; ++v) {
    const Vec3& x = elements.mesh.positions[v];
    int best = 0;
    std::vector<double> energies(field.seeds.size());
    for (Size i = 0; i < field.seeds.size(); ++i) {
      energies[i] = seed_energy(field.seeds[i], squeeze, x);
      if (energies[i] < energies[at(best)]) best = static_cast<int>(i);
    }
    const double least = energies[at(best)];
    double second = 1e300;
    for (Size i = 0; i < energies.size(); ++i) {
      if (static_cast<int>(i) != best) second = std::min(second, energies[i]);
      if (energies[i] <= least + 2.5 * greatest_weight * scales[v].longest)
        kept[v].push_back(static_cast<int>(i));
    }
    const double margin = kVertexLead * scales[v].shortest;
    winners[v] = {best, std::min(least, second - margin)};
  }
  field.first_of_element.push_back(0);
  std::vector<int> candidates;
  for (const geometry::Triangle& triangle : elements.mesh.triangles) {
    candidates.clear();
    for (const int v : triangle) candidates.insert(candidates.end(), kept[at(v)].begin(), kept[at(v)].end());
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    std::vector<GrainEnergy> energies;
    for (const int grain : candidates) {
      GrainEnergy energy{grain, {}};
      for (Size i = 0; i < 3; ++i) {
        const Size v = at(triangle[i]);
        energy.corners[i] = winners[v].grain == grain
                                ? winners[v].energy
                                : seed_energy(field.seeds[at(grain)], squeeze, elements.mesh.positions[v]);
      }
      energies.push_back(energy);
    }
    // Whoever loses to one other grain at all three corners loses everywhere between them.
    for (const GrainEnergy& e : energies) {
      const bool is_beaten = std::any_of(energies.begin(), energies.end(), [&e](const GrainEnergy& f) {
        return f.corners[0] < e.corners[0] && f.corners[1] < e.corners[1] && f.corners[2] < e.corners[2];
      });
      if (!is_beaten) field.energies.push_back(e);
    }
    field.first_of_element.push_back(static_cast<int>(field.energies.size()));
  }
  return field;
}

int grain_at(const GrainField& field, int element, const Vec2& barycentric) {
  if (field.is_empty()) return -1;
  int best = -1;
  double least = 0.0;
  for (int i = field.first_of_element[at(element)]; i < field.first_of_element[at(element) + 1]; ++i) {
    const GrainEnergy& e = field.energies[at(i)];
    const double energy = e.corners[0] * (1.0 - barycentric.x() - barycentric.y()) +
                          e.corners[1] * barycentric.x() + e.corners[2] * barycentric.y();
    if (best >= 0 && energy >= least) continue;
    best = e.grain;
    least = energy;
  }
  return best;
}

double crossing_parameter(double difference_low, double difference_high) {
  return geometry::round_edge_parameter(difference_low / (difference_low - difference_high));
}

std::vector<GrainCrossing> find_grain_crossings(const GrainField& field,
                                                const geometry::ShellElements& elements, int element) {
  std::vector<GrainCrossing> crossings;
  if (field.is_empty()) return crossings;
  const geometry::Triangle& triangle = elements.mesh.triangles[at(element)];
  const int first = field.first_of_element[at(element)];
  const int last = field.first_of_element[at(element) + 1];
  for (Size side = 0; side < 3; ++side) {
    const Size other = (side + 1) % 3;
    const Size low = triangle[side] < triangle[other] ? side : other;
    const Size high = low == side ? other : side;
    // Walks the lower envelope from the low end: the next grain is the one that undercuts the present one
    // first.
    int present = first;
    for (int i = first; i < last; ++i)
      if (field.energies[at(i)].corners[low] < field.energies[at(present)].corners[low]) present = i;
    double reached = 0.0;
    for (;;) {
      const GrainEnergy& p = field.energies[at(present)];
      int next = -1;
      double nearest = 1.0;
      for (int i = first; i < last; ++i) {
        const GrainEnergy& e = field.energies[at(i)];
        const double at_low = e.corners[low] - p.corners[low];
        const double at_high = e.corners[high] - p.corners[high];
        if (!(at_high < 0.0) || !(at_low > at_high)) continue;
        const double parameter = crossing_parameter(at_low, at_high);
        if (parameter > reached && parameter < nearest) {
          nearest = parameter;
          next = i;
        }
      }
      if (next < 0) break;
      const int edge = elements.topology.triangle_edges[at(element)][side];
      crossings.push_back({edge, nearest, p.grain, field.energies[at(next)].grain});
      reached = nearest;
      present = next;
    }
  }
  return crossings;
}

}  // namespace shatterbox::fracture
