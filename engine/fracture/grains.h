// Grains [BHTF07 VII-A]: seeds with weights, energies k_i |x - p_i|, linear inside each element; a point
// belongs to the grain of least energy. The lower envelope of linear functions has convex cells that agree
// across element edges.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"
#include "engine/material/material.h"

namespace shatterbox::fracture {

struct GrainSeed {
  Vec3 position = Vec3::Zero();  // material space, m
  double weight = 1.0;           // k: a larger one makes a smaller grain
};

/// What makes grains long: distances are measured after it has shortened them along the material's
/// grain_direction.
Mat3 grain_squeeze(const material::Material& material);

/// Energy of a seed's grain at a place, m.
double seed_energy(const GrainSeed& seed, const Mat3& squeeze, const Vec3& x);

/// Energy of one grain at one element's three corners, m.
struct GrainEnergy {
  int grain = 0;
  std::array<double, 3> corners{};
};

/// Which grains matter in which element. Shared by all pieces of one parent.
struct GrainField {
  std::vector<GrainSeed> seeds;
  std::vector<GrainEnergy> energies;  // of all elements
  std::vector<int> first_of_element;  // |T| + 1

  bool is_empty() const { return seeds.empty(); }
};

/// Where the grain boundary between two grains crosses an edge.
struct GrainCrossing {
  int edge = 0;            // of the element mesh
  double parameter = 0.0;  // along the edge, from its lower-numbered vertex; the same from both sides
  int grain_a = 0, grain_b = 0;
};

/// Seeds about `spacing` metres apart on the surface, never nearer than 0.7 spacing (squeezed), with weights
/// within 15 % of one. They do not depend on the triangles.
std::vector<GrainSeed> scatter_grain_seeds(const geometry::ShellElements& elements, double spacing,
                                           std::uint64_t seed, const Mat3& squeeze = Mat3::Identity());

/// The field of `seeds`. At every vertex the least energy is lowered a little where a second one is near it,
/// so that no boundary passes within about a twentieth of an edge of a vertex.
GrainField make_grain_field(const geometry::ShellElements& elements, std::vector<GrainSeed> seeds,
                            const Mat3& squeeze = Mat3::Identity());

/// The grain at a point of an element; -1 without grains.
int grain_at(const GrainField& field, int element, const Vec2& barycentric);

/// Where boundaries cross the three edges of an element: edge by edge, ascending parameters.
std::vector<GrainCrossing> find_grain_crossings(const GrainField& field,
                                                const geometry::ShellElements& elements, int element);

/// The parameter at which two linear functions on an edge are equal, from the values at its lower- and
/// higher-numbered vertex; rounded to a fixed grid so that 1 - parameter is exact. The signs of the
/// differences at the ends must differ.
double crossing_parameter(double difference_low, double difference_high);

}  // namespace shatterbox::fracture
