#include "engine/audit/surface.h"
#include "engine/body/polyhedron.h"
#include "engine/core/index.h"

#include <algorithm>
#include <numeric>

namespace shatterbox::audit {
namespace {

using core::at;

constexpr int kLeafSize = 4;

void add_owners(Surface& surface) {
  std::vector<bool> vertex_is_owned(surface.vertices.size(), false);
  std::vector<bool> edge_is_owned(surface.topology.edges.size(), false);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<bool, 3> corners{}, edges{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto vertex = at(surface.triangles[t][i]), edge = at(surface.topology.triangle_edges[t][i]);
      corners[i] = !vertex_is_owned[vertex];
      edges[i] = !edge_is_owned[edge];
      vertex_is_owned[vertex] = edge_is_owned[edge] = true;
    }
    surface.owns_corner.push_back(corners);
    surface.owns_edge.push_back(edges);
  }
}

void add_tree(Surface& surface) {
  std::vector<Vec3> centres;
  for (const auto& t : surface.triangles)
    centres.push_back(surface.vertices[at(t[0])] + surface.vertices[at(t[1])] + surface.vertices[at(t[2])]);
  surface.order.resize(surface.triangles.size());
  std::iota(surface.order.begin(), surface.order.end(), 0);
  if (surface.order.empty()) return;
  surface.nodes.push_back({0, static_cast<int>(surface.order.size()), -1, -1});
  for (std::size_t i = 0; i < surface.nodes.size(); ++i) {
    const Surface::Node node = surface.nodes[i];
    if (node.end - node.begin <= kLeafSize) continue;
    Bounds bounds;
    for (int k = node.begin; k < node.end; ++k) bounds.include(centres[at(surface.order[at(k)])]);
    int axis = 0;
    (bounds.high - bounds.low).maxCoeff(&axis);
    const int middle = (node.begin + node.end) / 2;
    const auto first = surface.order.begin();
    std::nth_element(first + node.begin, first + middle, first + node.end, [&](int a, int b) {
      return centres[at(a)][axis] < centres[at(b)][axis] ||
             (centres[at(a)][axis] == centres[at(b)][axis] && a < b);
    });
    surface.nodes[i].left = static_cast<int>(surface.nodes.size());
    surface.nodes[i].right = surface.nodes[i].left + 1;
    surface.nodes.push_back({node.begin, middle, -1, -1});
    surface.nodes.push_back({middle, node.end, -1, -1});
  }
}

}  // namespace

std::shared_ptr<const Surface> make_surface(const std::shared_ptr<const body::Shape>& shape) {
  auto surface = std::make_shared<Surface>();
  surface->shape = shape;
  geometry::TriangleMesh mesh = body::find_polyhedron(*shape);
  surface->vertices = std::move(mesh.positions);
  surface->triangles = std::move(mesh.triangles);
  surface->topology = geometry::build_edge_topology(surface->triangles);
  add_owners(*surface);
  add_tree(*surface);
  return surface;
}

std::vector<Vec3> place_surface(const Surface& surface, const Pose& pose) {
  std::vector<Vec3> positions;
  positions.reserve(surface.vertices.size());
  for (const Vec3& v : surface.vertices) positions.push_back(pose.apply(v));
  return positions;
}

void include_way(const MovingSurface& other, MovingSurface& way) {
  for (std::size_t t = 0; t < way.triangles.size(); ++t) way.triangles[t].include(other.triangles[t]);
  for (std::size_t i = 0; i < way.nodes.size(); ++i) way.nodes[i].include(other.nodes[i]);
}

MovingSurface move_surface(const Surface& surface, std::vector<Vec3> start, std::vector<Vec3> end) {
  MovingSurface moving;
  moving.start = std::move(start);
  moving.end = std::move(end);
  moving.triangles.resize(surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const int v : surface.triangles[t]) {
      moving.triangles[t].include(moving.start[at(v)]);
      moving.triangles[t].include(moving.end[at(v)]);
    }
  moving.nodes.resize(surface.nodes.size());
  for (std::size_t i = surface.nodes.size(); i-- > 0;) {
    const Surface::Node& node = surface.nodes[i];
    if (node.left >= 0) {
      moving.nodes[i].include(moving.nodes[at(node.left)]);
      moving.nodes[i].include(moving.nodes[at(node.right)]);
      continue;
    }
    for (int k = node.begin; k < node.end; ++k)
      moving.nodes[i].include(moving.triangles[at(surface.order[at(k)])]);
  }
  return moving;
}

}  // namespace shatterbox::audit
