// A solid that may be cut: the material of well-shaped tetrahedra ("elements"), divided into cells. Each cell
// owns a copy of its element's four vertices; copies of neighbouring cells are one where their material
// touches. This is the virtual node algorithm [MBF04].
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "engine/geometry/tet_mesh.h"

namespace shatterbox::geometry {

/// The uncut tetrahedra of a solid in material space (the body space of the unbroken body). Never changed;
/// shared by all pieces that come from it.
struct SolidElements {
  TetMesh mesh;
  TetTopology topology;  // empty of copies (copy_elements), of which several may share a face
};

/// A connected part of one element's material.
struct SolidCell {
  int element = 0;
  std::array<int, 4> vertices{};  // degrees of freedom: virtual vertices at the element's corners
  double volume = 0.0;            // m3, of the material
  // Weights of corners 1, 2, 3 at the material's centroid; corner 0 has 1 - sum.
  Vec3 centroid = Vec3::Constant(0.25);
  int grain = -1;  // number of the grain, -1 without grains
};

struct SolidMesh {
  std::shared_ptr<const SolidElements> elements;
  std::vector<SolidCell> cells;
  std::vector<int> vertex_source;  // |V|: the element mesh's vertex that a virtual vertex is a copy of

  int degree_of_freedom_count() const { return 3 * static_cast<int>(vertex_source.size()); }
};

/// Two cells whose material touches over `area` m2 of an element's face or of a closed facet inside an
/// element.
struct SolidContact {
  int cell_a = 0, cell_b = 0;
  double area = 0.0;
};

/// The uncut solid: one cell a tetrahedron.
SolidMesh make_solid_mesh(std::shared_ptr<const SolidElements> elements);

/// Volume of a cell's material as a share of its element's.
double volume_fraction(const SolidMesh& mesh, const SolidCell& cell);

}  // namespace shatterbox::geometry
