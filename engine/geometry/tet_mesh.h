// A tetrahedral mesh and who shares its faces and edges. Faces and edges are numbered by their sorted
// vertices, so the numbers depend on the mesh alone.
#pragma once

#include <array>
#include <vector>

#include "engine/core/vec.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::geometry {

using Tetrahedron = std::array<int, 4>;  // vertex numbers a, b, c, d with (b - a) x (c - a) . (d - a) > 0

struct TetMesh {
  std::vector<Vec3> positions;          // |V| x 3, m
  std::vector<Tetrahedron> tetrahedra;  // |T| x 4
};

/// Corners of the face opposite to each corner, counter-clockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> kTetrahedronFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
/// Corners of the six edges.
inline constexpr std::array<std::array<int, 2>, 6> kTetrahedronEdges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

struct TetTopology {
  std::vector<std::array<int, 3>> faces;              // |F| x 3, ascending, in lexicographic order
  std::vector<std::array<int, 4>> tetrahedron_faces;  // |T| x 4: face i is opposite to corner i
  std::vector<std::array<int, 2>> face_tetrahedra;    // |F| x 2, ascending; the second is -1 on the border
  std::vector<std::array<int, 2>> edges;              // |E| x 2, ascending, in lexicographic order
  std::vector<std::array<int, 6>> tetrahedron_edges;  // |T| x 6, as in kTetrahedronEdges
};

/// Faces and edges of `tetrahedra`, of which no three may share a face.
TetTopology build_tet_topology(const std::vector<Tetrahedron>& tetrahedra);

/// 1 if a face's vertices in ascending order turn counter-clockwise seen from outside of the tetrahedron, -1
/// otherwise. `face` 0 to 3: opposite to that corner.
int face_direction(const Tetrahedron& tetrahedron, int face);

/// The edges from a tetrahedron's first corner to the others, m, as columns.
Mat3 edge_matrix(const TetMesh& mesh, int tetrahedron);

/// Volume of a tetrahedron, m3; negative if it is inside out.
double tetrahedron_volume(const TetMesh& mesh, int tetrahedron);

/// Sum of the volumes, m3.
double total_volume(const TetMesh& mesh);

/// The border of a mesh, counter-clockwise seen from outside; only the vertices in use, in their order.
TriangleMesh boundary_surface(const TetMesh& mesh, const TetTopology& topology);

}  // namespace shatterbox::geometry
