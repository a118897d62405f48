// Grains of a solid: where their seeds are, and which of them matter at which node of its elements [BHTF07]
// sec. VII-A.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/fracture/grains.h"
#include "engine/geometry/tet_mesh.h"

namespace shatterbox::fracture {

/// A solid has no more.
inline constexpr double kMostSpaceGrains = 4000.0;

/// Energy of a grain at a node, m.
struct NodeGrain {
  int grain = 0;
  double energy = 0.0;
};

/// Shared by all pieces of one parent.
struct SpaceGrains {
  std::vector<GrainSeed> seeds;
  std::vector<NodeGrain> near;  // of all nodes: those that may win on an edge there, the least energy first
  std::vector<int> first_of_node;  // |nodes of the element mesh| + 1
  std::vector<double> reach;       // |nodes|, m: no other grain's energy is less than this above the least

  std::span<const NodeGrain> of_node(int node) const {
    const auto begin = static_cast<std::size_t>(first_of_node[static_cast<std::size_t>(node)]);
    const auto end = static_cast<std::size_t>(first_of_node[static_cast<std::size_t>(node) + 1]);
    return {near.data() + begin, end - begin};
  }
  /// The grain that a node is in.
  int owner(int node) const { return of_node(node).front().grain; }
};

/// How many grains of a material a box (m) holds, about.
double expected_grains(const Vec3& box, const material::Material& material);

/// Seeds about material.grain_size apart in a box and about it, never nearer than 0.7 of that (squeezed),
/// with weights within 15 % of one.
std::vector<GrainSeed> scatter_grain_seeds(const Vec3& low, const Vec3& high,
                                           const material::Material& material, std::uint64_t seed);

/// The grains of a mesh's material (grain_size above zero).
SpaceGrains make_space_grains(const geometry::TetMesh& mesh, const material::Material& material,
                              std::uint64_t seed);

}  // namespace shatterbox::fracture
