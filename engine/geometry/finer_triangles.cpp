#include "engine/geometry/finer_triangles.h"

#include <algorithm>
#include <map>
#include <queue>
#include <utility>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using core::at;
using Edge = std::pair<int, int>;  // the lower vertex first

class Divider {
 public:
  Divider(const TriangleMesh& mesh, double longest) : mesh_(mesh), longest_squared_(longest * longest) {
    for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
      const Triangle& corners = mesh_.triangles[at(t)];
      for (std::size_t i = 0; i < 3; ++i) add(corners[i], corners[(i + 1) % 3], t);
    }
  }

  TriangleMesh divide() {
    while (!long_edges_.empty()) {
      const Edge edge = long_edges_.top().second;
      long_edges_.pop();
      halve(edge);
    }
    return std::move(mesh_);
  }

 private:
  static Edge edge_of(int v, int w) { return {std::min(v, w), std::max(v, w)}; }

  void add(int v, int w, int triangle) {
    std::vector<int>& triangles = triangles_[edge_of(v, w)];
    if (triangles.empty()) {
      const double length_squared = (mesh_.positions[at(v)] - mesh_.positions[at(w)]).squaredNorm();
      if (length_squared > longest_squared_) long_edges_.push({length_squared, edge_of(v, w)});
    }
    triangles.push_back(triangle);
  }

  // It is the longest of all of its triangles.
  void halve(const Edge& edge) {
    const auto [from, to] = edge;
    const int middle = static_cast<int>(mesh_.positions.size());
    mesh_.positions.push_back(0.5 * (mesh_.positions[at(from)] + mesh_.positions[at(to)]));
    const std::vector<int> triangles = std::move(triangles_.extract(edge).mapped());
    for (const int t : triangles) {
      Triangle near_to = mesh_.triangles[at(t)];
      const int opposite = near_to[0] + near_to[1] + near_to[2] - from - to;
      std::replace(near_to.begin(), near_to.end(), from, middle);
      Triangle& near_from = mesh_.triangles[at(t)];
      std::replace(near_from.begin(), near_from.end(), to, middle);
      const int added = static_cast<int>(mesh_.triangles.size());
      mesh_.triangles.push_back(near_to);
      std::vector<int>& beyond = triangles_[edge_of(to, opposite)];
      std::replace(beyond.begin(), beyond.end(), t, added);
      add(from, middle, t);
      add(middle, to, added);
      add(middle, opposite, t);
      add(middle, opposite, added);
    }
  }

  TriangleMesh mesh_;
  double longest_squared_;
  std::map<Edge, std::vector<int>> triangles_;  // at each edge
  std::priority_queue<std::pair<double, Edge>> long_edges_;
};

}  // namespace

TriangleMesh divide_long_edges(const TriangleMesh& mesh, double longest) {
  return Divider(mesh, longest).divide();
}

}  // namespace shatterbox::geometry
