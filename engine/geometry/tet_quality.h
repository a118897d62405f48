// How well-shaped the tetrahedra of a mesh are: dihedral angles and aspects.
#pragma once

#include <array>

#include "engine/geometry/tet_mesh.h"

namespace shatterbox::geometry {

/// Aspect is the longest edge over the least height: 1.22 for a regular tetrahedron, unbounded for a flat
/// one.
struct TetQuality {
  int count = 0;                       // tetrahedra; of none all is zero
  double volume = 0.0;                 // m3, their sum
  double least_volume = 0.0;           // m3; not positive if one is flat or inside out
  double least_dihedral = 0.0;         // radians, of all edges of all tetrahedra
  double greatest_dihedral = 0.0;      // radians
  double hundredth_dihedral = 0.0;     // radians: a hundredth of the tetrahedra have a lesser least angle
  double median_least_dihedral = 0.0;  // radians: half of them do; a regular tetrahedron has 1.23
  double worst_aspect = 0.0;           // of all
  double median_aspect = 0.0;          // of all
  double mean_edge_length = 0.0;       // m, each edge as often as tetrahedra have it
  std::array<int, 18> dihedral_histogram{};  // of six angles a tetrahedron, by tens of degrees
};

/// The shape of one tetrahedron: its six dihedral angles (as kTetrahedronEdges, radians) and its aspect.
struct TetShape {
  std::array<double, 6> dihedrals{};
  double aspect = 0.0;
};
TetShape tetrahedron_shape(const std::array<Vec3, 4>& corners);

TetQuality measure_quality(const TetMesh& mesh);

}  // namespace shatterbox::geometry
