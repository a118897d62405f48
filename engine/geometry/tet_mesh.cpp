#include "engine/geometry/tet_mesh.h"

#include <algorithm>
#include <cassert>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// One face or edge of one tetrahedron: its vertices, ascending, and where it was found.
template <Size kCorners>
struct FoundPart {
  std::array<int, kCorners> vertices;
  int tetrahedron, number;
};

template <Size kCorners, Size kParts>
std::vector<FoundPart<kCorners>> sorted_parts(const std::vector<Tetrahedron>& tetrahedra,
                                              const std::array<std::array<int, kCorners>, kParts>& corners) {
  std::vector<FoundPart<kCorners>> parts;
  parts.reserve(kParts * tetrahedra.size());
  for (Size t = 0; t < tetrahedra.size(); ++t)
    for (Size p = 0; p < kParts; ++p) {
      FoundPart<kCorners> part{{}, static_cast<int>(t), static_cast<int>(p)};
      for (Size k = 0; k < kCorners; ++k) part.vertices[k] = tetrahedra[t][at(corners[p][k])];
      std::sort(part.vertices.begin(), part.vertices.end());
      parts.push_back(part);
    }
  std::sort(parts.begin(), parts.end(), [](const FoundPart<kCorners>& p, const FoundPart<kCorners>& q) {
    for (Size k = 0; k < kCorners; ++k)
      if (p.vertices[k] != q.vertices[k]) return p.vertices[k] < q.vertices[k];
    return p.tetrahedron < q.tetrahedron;
  });
  return parts;
}

}  // namespace

TetTopology build_tet_topology(const std::vector<Tetrahedron>& tetrahedra) {
  TetTopology topology;
  topology.tetrahedron_faces.resize(tetrahedra.size());
  for (const FoundPart<3>& face : sorted_parts(tetrahedra, kTetrahedronFaces)) {
    if (topology.faces.empty() || topology.faces.back() != face.vertices) {
      topology.faces.push_back(face.vertices);
      topology.face_tetrahedra.push_back({face.tetrahedron, -1});
    } else {
      assert(topology.face_tetrahedra.back()[1] < 0);
      topology.face_tetrahedra.back()[1] = face.tetrahedron;
    }
    topology.tetrahedron_faces[at(face.tetrahedron)][at(face.number)] =
        static_cast<int>(topology.faces.size()) - 1;
  }
  topology.tetrahedron_edges.resize(tetrahedra.size());
  for (const FoundPart<2>& edge : sorted_parts(tetrahedra, kTetrahedronEdges)) {
    if (topology.edges.empty() || topology.edges.back() != edge.vertices)
      topology.edges.push_back(edge.vertices);
    topology.tetrahedron_edges[at(edge.tetrahedron)][at(edge.number)] =
        static_cast<int>(topology.edges.size()) - 1;
  }
  return topology;
}

int face_direction(const Tetrahedron& tetrahedron, int face) {
  const auto& corners = kTetrahedronFaces[at(face)];
  Size least = 0;
  for (Size k = 1; k < 3; ++k)
    if (tetrahedron[at(corners[k])] < tetrahedron[at(corners[least])]) least = k;
  const int next = tetrahedron[at(corners[(least + 1) % 3])];
  return next < tetrahedron[at(corners[(least + 2) % 3])] ? 1 : -1;
}

Mat3 edge_matrix(const TetMesh& mesh, int tetrahedron) {
  const Tetrahedron& t = mesh.tetrahedra[at(tetrahedron)];
  Mat3 edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = mesh.positions[at(t[at(i + 1)])] - mesh.positions[at(t[0])];
  return edges;
}

double tetrahedron_volume(const TetMesh& mesh, int tetrahedron) {
  const Tetrahedron& t = mesh.tetrahedra[at(tetrahedron)];
  const Vec3& a = mesh.positions[at(t[0])];
  return (mesh.positions[at(t[1])] - a)
             .cross(mesh.positions[at(t[2])] - a)
             .dot(mesh.positions[at(t[3])] - a) /
         6.0;
}

double total_volume(const TetMesh& mesh) {
  double sum = 0.0;
  for (Size t = 0; t < mesh.tetrahedra.size(); ++t) sum += tetrahedron_volume(mesh, static_cast<int>(t));
  return sum;
}

TriangleMesh boundary_surface(const TetMesh& mesh, const TetTopology& topology) {
  TriangleMesh surface;
  std::vector<int> number(mesh.positions.size(), -1);
  for (Size t = 0; t < mesh.tetrahedra.size(); ++t)
    for (Size f = 0; f < 4; ++f) {
      if (topology.face_tetrahedra[at(topology.tetrahedron_faces[t][f])][1] >= 0) continue;
      const auto& corners = kTetrahedronFaces[f];
      surface.triangles.push_back({mesh.tetrahedra[t][at(corners[0])], mesh.tetrahedra[t][at(corners[1])],
                                   mesh.tetrahedra[t][at(corners[2])]});
      for (const int v : surface.triangles.back()) number[at(v)] = 0;
    }
  for (Size v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      number[v] = static_cast<int>(surface.positions.size());
      surface.positions.push_back(mesh.positions[v]);
    }
  for (Triangle& triangle : surface.triangles)
    for (int& v : triangle) v = number[at(v)];
  return surface;
}

}  // namespace shatterbox::geometry
