#include "engine/geometry/flat_triangles.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "engine/core/index.h"
#include "engine/geometry/edge_topology.h"

namespace shatterbox::geometry {
namespace {

constexpr double kStillFlat = 1e-12;
constexpr int kMostPasses = 16;

using core::at;

/// Numbers of the corners that begin the longest and the shortest edge, with their lengths.
struct Extremes {
  std::size_t longest = 0;
  std::size_t shortest = 0;
  double longest_length = 0.0;
  double shortest_length = 0.0;
};

Extremes find_extremes(const TriangleMesh& mesh, const Triangle& t) {
  std::array<double, 3> length{};
  for (std::size_t i = 0; i < 3; ++i)
    length[i] = (mesh.positions[at(t[(i + 1) % 3])] - mesh.positions[at(t[i])]).norm();
  const auto longest = std::max_element(length.begin(), length.end());
  const auto shortest = std::min_element(length.begin(), length.end());
  return {static_cast<std::size_t>(longest - length.begin()),
          static_cast<std::size_t>(shortest - length.begin()), *longest, *shortest};
}

/// One round over all triangles; what is near a removed triangle waits for the next round.
class Round {
 public:
  Round(TriangleMesh& mesh, std::vector<int>& source, bool divides)
      : mesh_(mesh),
        source_(source),
        divides_(divides),
        topology_(build_edge_topology(mesh.triangles)),
        is_kept_(mesh.triangles.size(), 1),
        is_touched_(mesh.triangles.size(), 0),
        joined_(mesh.positions.size()) {
    std::iota(joined_.begin(), joined_.end(), 0);
  }

  FlatTriangles run() {
    FlatTriangles result;
    for (std::size_t t = 0; t < is_kept_.size(); ++t) {
      if (is_touched_[t] || !take_out(t)) continue;
      is_kept_[t] = 0;
      is_touched_[t] = 1;
      if (result.count++ == 0) result.first = source_[t];
    }
    finish();
    return result;
  }

 private:
  /// Makes good for the loss of triangle t if it is flat; false if it stays for now.
  bool take_out(std::size_t t) {
    const Triangle corners = mesh_.triangles[t];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return true;
    if (flatness(mesh_, corners) >= kStillFlat) return false;
    const Extremes e = find_extremes(mesh_, corners);
    if (e.shortest_length <= kStillFlat * e.longest_length) {
      const int a = corners[e.shortest];
      const int b = corners[(e.shortest + 1) % 3];
      joined_[at(std::max(a, b))] = std::min(a, b);
      return true;
    }
    return !divides_ || divide_neighbour(t, e.longest);
  }

  /// The corner of t that lies on its longest edge becomes a corner of the triangle across that edge.
  bool divide_neighbour(std::size_t t, std::size_t longest) {
    const int edge = topology_.triangle_edges[t][longest];
    if (topology_.triangle_count(edge) != 2) return true;  // a border: nothing to divide
    const auto begin = at(topology_.first_triangle[at(edge)]);
    const int one = topology_.edge_triangles[begin];
    const auto other = at(one == static_cast<int>(t) ? topology_.edge_triangles[begin + 1] : one);
    if (is_touched_[other]) return false;
    is_touched_[other] = 1;
    const int middle = mesh_.triangles[t][(longest + 2) % 3];
    const auto& ends = topology_.edges[at(edge)];
    Triangle& neighbour = mesh_.triangles[other];
    if (std::find(neighbour.begin(), neighbour.end(), middle) != neighbour.end()) return true;
    Triangle second = neighbour;
    std::replace(neighbour.begin(), neighbour.end(), ends[0], middle);
    std::replace(second.begin(), second.end(), ends[1], middle);
    added_.push_back(second);
    added_source_.push_back(source_[other]);
    return true;
  }

  void finish() {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < is_kept_.size(); ++t) {
      if (!is_kept_[t]) continue;
      mesh_.triangles[kept] = mesh_.triangles[t];
      source_[kept++] = source_[t];
    }
    mesh_.triangles.resize(kept);
    source_.resize(kept);
    mesh_.triangles.insert(mesh_.triangles.end(), added_.begin(), added_.end());
    source_.insert(source_.end(), added_source_.begin(), added_source_.end());
    for (Triangle& t : mesh_.triangles)
      for (int& v : t)
        while (joined_[at(v)] != v) v = joined_[at(v)];
  }

  TriangleMesh& mesh_;
  std::vector<int>& source_;
  bool divides_;
  EdgeTopology topology_;  // as the round began
  std::vector<std::uint8_t> is_kept_;
  std::vector<std::uint8_t> is_touched_;
  std::vector<int> joined_;
  std::vector<Triangle> added_;
  std::vector<int> added_source_;
};

}  // namespace

double flatness(const TriangleMesh& mesh, const Triangle& triangle) {
  const double longest = find_extremes(mesh, triangle).longest_length;
  if (longest == 0.0) return 0.0;
  // Divided first, so that the product neither underflows nor overflows.
  const Vec3& origin = mesh.positions[at(triangle[0])];
  const Vec3 a = (mesh.positions[at(triangle[1])] - origin) / longest;
  const Vec3 b = (mesh.positions[at(triangle[2])] - origin) / longest;
  return a.cross(b).norm();
}

FlatTriangles remove_flat_triangles(TriangleMesh& mesh, std::vector<int>& source) {
  FlatTriangles result;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const bool is_last = pass + 1 == kMostPasses;  // flat triangles that pass a corner to and fro: just out
    const FlatTriangles round = Round(mesh, source, !is_last).run();
    if (round.count == 0) break;
    if (result.count == 0) result.first = round.first;
    result.count += round.count;
  }
  return result;
}

}  // namespace shatterbox::geometry
