#include "engine/geometry/vertex_fans.h"

#include <algorithm>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using core::at;

/// Takes out of `rest` the triangles reachable from its first one over edges at v.
std::vector<std::size_t> take_fan(const TriangleMesh& mesh, std::vector<std::size_t>& rest, int v) {
  std::vector<std::size_t> members{rest.front()};
  rest.erase(rest.begin());
  const auto shares_edge = [&](const Triangle& a, const Triangle& b) {
    return std::any_of(a.begin(), a.end(),
                       [&](int w) { return w != v && std::find(b.begin(), b.end(), w) != b.end(); });
  };
  for (std::size_t i = 0; i < members.size(); ++i)
    for (auto r = rest.begin(); r != rest.end();) {
      if (shares_edge(mesh.triangles[members[i]], mesh.triangles[*r])) {
        members.push_back(*r);
        r = rest.erase(r);
      } else {
        ++r;
      }
    }
  return members;
}

}  // namespace

SplitFans split_vertex_fans(TriangleMesh& mesh, std::vector<int>& source) {
  std::vector<std::vector<std::size_t>> around(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) around[at(v)].push_back(t);
  SplitFans result;
  const int vertices = static_cast<int>(mesh.positions.size());
  for (int v = 0; v < vertices; ++v) {
    std::vector<std::size_t> rest = around[at(v)];
    bool is_split = false;
    for (int fan = 0; !rest.empty(); ++fan) {
      const std::vector<std::size_t> members = take_fan(mesh, rest, v);
      if (fan == 0) continue;
      is_split = true;
      const int copy = static_cast<int>(mesh.positions.size());
      mesh.positions.push_back(Vec3(mesh.positions[at(v)]));
      source.push_back(source[at(v)]);
      for (const std::size_t t : members)
        std::replace(mesh.triangles[t].begin(), mesh.triangles[t].end(), v, copy);
    }
    if (is_split && result.count++ == 0) result.first = source[at(v)];
  }
  return result;
}

}  // namespace shatterbox::geometry
