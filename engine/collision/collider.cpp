#include "engine/collision/collider.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/collision/exposed_edges.h"
#include "engine/core/index.h"
#include "engine/geometry/edge_topology.h"

namespace shatterbox::collision {
namespace {

using core::at;
using geometry::Triangle;

// Rows of a table from (row, value) pairs given in any order; values stay in the order given within a row.
void fill_rows(std::size_t rows, const std::vector<std::pair<int, int>>& entries, std::vector<int>& begin,
               std::vector<int>& values) {
  begin.assign(rows + 1, 0);
  for (const auto& entry : entries) ++begin[at(entry.first) + 1];
  for (std::size_t i = 0; i < rows; ++i) begin[i + 1] += begin[i];
  values.resize(entries.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (const auto& [row, value] : entries) values[at(next[at(row)]++)] = value;
}

void add_box_surface(const Vec3& half_extent, Collider& collider) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign((corner & 1) ? 1.0 : -1.0, (corner & 2) ? 1.0 : -1.0, (corner & 4) ? 1.0 : -1.0);
    collider.vertices.push_back(half_extent.cwiseProduct(sign));
  }
  collider.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                        {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
}

void add_owners(Collider& collider, const geometry::EdgeTopology& topology, SurfaceMotion motion) {
  const std::size_t triangle_count = collider.triangles.size();
  std::vector<int> owner(collider.vertices.size(), -1);
  std::vector<std::pair<int, int>> vertex_entries, edge_entries;
  for (std::size_t t = 0; t < triangle_count; ++t) {
    for (const int v : collider.triangles[t]) {
      if (owner[at(v)] >= 0) continue;
      owner[at(v)] = static_cast<int>(t);
      vertex_entries.emplace_back(static_cast<int>(t), v);
    }
  }
  std::vector<char> is_owned(collider.edges.size(), 1);
  if (motion == SurfaceMotion::rigid) is_owned = find_exposed_edges(collider, topology);
  for (std::size_t e = 0; e < collider.edges.size(); ++e) {
    if (is_owned[e] == 0) continue;
    edge_entries.emplace_back(topology.edge_triangles[at(topology.first_triangle[e])], static_cast<int>(e));
  }
  fill_rows(triangle_count, vertex_entries, collider.owned_vertex_begin, collider.owned_vertices);
  fill_rows(triangle_count, edge_entries, collider.owned_edge_begin, collider.owned_edges);
}

void add_neighbours(Collider& collider, const geometry::EdgeTopology& topology) {
  std::vector<std::pair<int, int>> neighbour_entries, opposite_entries;
  for (std::size_t e = 0; e < collider.edges.size(); ++e) {
    const auto [v, w] = collider.edges[e];
    neighbour_entries.emplace_back(v, w);
    neighbour_entries.emplace_back(w, v);
    for (int k = topology.first_triangle[e]; k < topology.first_triangle[e + 1]; ++k) {
      const Triangle& t = collider.triangles[at(topology.edge_triangles[at(k)])];
      const int opposite = t[0] + t[1] + t[2] - v - w;
      if (opposite != v && opposite != w) opposite_entries.emplace_back(static_cast<int>(e), opposite);
    }
  }
  fill_rows(collider.vertices.size(), neighbour_entries, collider.neighbour_begin, collider.neighbours);
  fill_rows(collider.edges.size(), opposite_entries, collider.opposite_begin, collider.opposites);
}

void add_leaf_vertices(Collider& collider) {
  const geometry::TriangleTree& tree = collider.tree;
  std::vector<int>& vertices = collider.leaf_vertices;
  collider.leaf_vertex_begin.reserve(tree.nodes.size() + 1);
  for (const auto& node : tree.nodes) {
    const auto first = static_cast<std::ptrdiff_t>(vertices.size());
    collider.leaf_vertex_begin.push_back(static_cast<int>(first));
    for (int k = node.begin; k < node.begin + node.count; ++k)
      for (const int v : collider.triangles[at(tree.order[at(k)])])
        if (std::find(vertices.begin() + first, vertices.end(), v) == vertices.end()) vertices.push_back(v);
  }
  collider.leaf_vertex_begin.push_back(static_cast<int>(vertices.size()));
}

}  // namespace

std::shared_ptr<const Collider> make_collider(const body::Shape& shape, SurfaceMotion motion) {
  auto collider = std::make_shared<Collider>();
  collider->kind = shape.kind;
  geometry::EdgeTopology topology;
  switch (shape.kind) {
    case body::ShapeKind::plane:
      return collider;
    case body::ShapeKind::sphere:
      collider->radius = shape.radius;
      collider->vertices = {Vec3::Zero()};
      collider->triangles = {{0, 0, 0}};
      topology.first_triangle = {0};
      break;
    case body::ShapeKind::capsule:
      collider->radius = shape.radius;
      collider->vertices = {Vec3(0.0, -shape.half_length, 0.0), Vec3(0.0, shape.half_length, 0.0)};
      // Without area: what is nearest to it is on its edge.
      collider->triangles = {{0, 1, 1}};
      topology.edges = {{0, 1}};
      topology.triangle_edges = {{0, 0, 0}};
      topology.first_triangle = {0, 1};
      topology.edge_triangles = {0};
      break;
    case body::ShapeKind::box:
      add_box_surface(shape.half_extent, *collider);
      topology = geometry::build_edge_topology(collider->triangles);
      break;
    case body::ShapeKind::shell:
    case body::ShapeKind::solid:
      collider->vertices = shape.surface.positions;
      collider->triangles = shape.surface.triangles;
      topology =
          shape.topology.edges.empty() ? geometry::build_edge_topology(collider->triangles) : shape.topology;
      break;
  }
  collider->edges = topology.edges;
  collider->triangle_edges = topology.triangle_edges;
  collider->tree = geometry::build_triangle_tree(collider->vertices, collider->triangles);
  add_leaf_vertices(*collider);
  add_neighbours(*collider, topology);
  double reach_squared = 0.0;
  for (const Vec3& v : collider->vertices) reach_squared = std::max(reach_squared, v.squaredNorm());
  for (const Vec3& v : collider->vertices) collider->box.include(v);
  collider->box.low.array() -= collider->radius;
  collider->box.high.array() += collider->radius;
  collider->bounding_radius = std::sqrt(reach_squared) + collider->radius;
  add_owners(*collider, topology, motion);
  return collider;
}

}  // namespace shatterbox::collision
