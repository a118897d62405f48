#include "engine/geometry/weld.h"

#include <algorithm>
#include <numeric>

namespace shatterbox::geometry {
namespace {

bool lexicographically_less(const Vec3& a, const Vec3& b) {
  if (a.x() != b.x()) return a.x() < b.x();
  if (a.y() != b.y()) return a.y() < b.y();
  return a.z() < b.z();
}

/// Keeps the vertices whose `keep` is themselves, in order, and sends every triangle corner v to keep[v].
int compact(TriangleMesh& mesh, const std::vector<int>& keep) {
  std::vector<int> number(mesh.positions.size(), -1);
  std::size_t kept = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (keep[v] != static_cast<int>(v)) continue;
    number[v] = static_cast<int>(kept);
    mesh.positions[kept++] = mesh.positions[v];
  }
  const int gone = static_cast<int>(mesh.positions.size() - kept);
  mesh.positions.resize(kept);
  for (Triangle& triangle : mesh.triangles)
    for (int& corner : triangle)
      corner = number[static_cast<std::size_t>(keep[static_cast<std::size_t>(corner)])];
  return gone;
}

}  // namespace

std::vector<int> find_equal_positions(const std::vector<Vec3>& positions) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const Vec3& pa = positions[static_cast<std::size_t>(a)];
    const Vec3& pb = positions[static_cast<std::size_t>(b)];
    if (lexicographically_less(pa, pb)) return true;
    if (lexicographically_less(pb, pa)) return false;
    return a < b;
  });
  std::vector<int> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto v = static_cast<std::size_t>(order[i]);
    const bool is_equal =
        i > 0 && !lexicographically_less(positions[static_cast<std::size_t>(order[i - 1])], positions[v]);
    first[v] = is_equal ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

int weld_equal_positions(TriangleMesh& mesh) {
  return compact(mesh, find_equal_positions(mesh.positions));
}

int drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> keep(mesh.positions.size(), -1);
  for (const Triangle& triangle : mesh.triangles)
    for (const int corner : triangle) keep[static_cast<std::size_t>(corner)] = corner;
  return compact(mesh, keep);
}

}  // namespace shatterbox::geometry
