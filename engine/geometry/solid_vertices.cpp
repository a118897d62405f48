#include "engine/geometry/solid_vertices.h"

#include <algorithm>

#include "engine/core/index.h"
#include "engine/geometry/closest_points.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

/// For each of the listed things the owner that its list belongs to.
std::vector<int> owners_of(const std::vector<int>& first) {
  std::vector<int> owners;
  for (Size i = 0; i + 1 < first.size(); ++i)
    owners.insert(owners.end(), at(first[i + 1] - first[i]), static_cast<int>(i));
  return owners;
}

}  // namespace

SolidVertexMaker::SolidVertexMaker(const SolidElements& elements, const TriangleMesh& surface,
                                   const SurfaceCrossings& crossings, const std::vector<Vec3>& positions)
    : elements_(elements),
      crossings_(crossings),
      positions_(positions),
      vertices_(number_vertices(elements, surface, crossings)),
      crossing_edges_(owners_of(crossings.first_edge_crossing)),
      crossing_faces_(owners_of(crossings.first_face_crossing)) {}

SolidVertex SolidVertexMaker::make(int vertex) const {
  const std::vector<Vec3>& mesh = elements_.mesh.positions;
  const Vec3& p = positions_[at(vertex)];
  if (vertex >= vertices_.first_face) {
    const auto& nodes = elements_.topology.faces[at(crossing_faces_[at(vertex - vertices_.first_face)])];
    const Vec3 weights =
        closest_on_triangle(p, mesh[at(nodes[0])], mesh[at(nodes[1])], mesh[at(nodes[2])]).barycentric;
    return make_mean(vertex, nodes.data(), weights.data(), 3);
  }
  if (vertex >= vertices_.first_edge) {
    const auto& nodes = elements_.topology.edges[at(crossing_edges_[at(vertex - vertices_.first_edge)])];
    const Vec3 &a = mesh[at(nodes[0])], &b = mesh[at(nodes[1])];
    const double share = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    const double weights[2] = {1.0 - share, share};
    return make_mean(vertex, nodes.data(), weights, 2);
  }
  if (vertex >= vertices_.first_mesh) {
    const int node = vertex - vertices_.first_mesh;
    const double weight = 1.0;
    return make_mean(vertex, &node, &weight, 1);
  }
  const Tetrahedron& t = elements_.mesh.tetrahedra[at(crossings_.vertex_tetrahedron[at(vertex)])];
  double weights[4];
  for (Size f = 0; f < 4; ++f) {
    const auto& [i, j, k] = kTetrahedronFaces[f];
    const Vec3& a = mesh[at(t[at(i)])];
    const double height = (mesh[at(t[at(j)])] - a).cross(mesh[at(t[at(k)])] - a).dot(a - p);
    weights[f] = std::max(height, 0.0);
  }
  return make_mean(vertex, t.data(), weights, 4);
}

/// Only nodes with a weight, ascending.
SolidVertex SolidVertexMaker::make_mean(int vertex, const int* nodes, const double* weights,
                                        Size count) const {
  SolidVertex result;
  result.position = positions_[at(vertex)];
  double sum = 0.0;
  for (Size k = 0; k < count; ++k) sum += weights[k];
  Size kept = 0;
  for (Size k = 0; k < count; ++k) {
    if (!(weights[k] > 1e-15 * sum)) continue;
    Size place = kept++;
    for (; place > 0 && result.nodes[place - 1] > nodes[k]; --place) {
      result.nodes[place] = result.nodes[place - 1];
      result.weights[place] = result.weights[place - 1];
    }
    result.nodes[place] = nodes[k];
    result.weights[place] = weights[k];
  }
  sum = 0.0;
  for (Size k = 0; k < kept; ++k) sum += result.weights[k];
  for (Size k = 0; k < kept; ++k) result.weights[k] /= sum;
  return result;
}

}  // namespace shatterbox::geometry
