#include "engine/geometry/winding.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "engine/core/index.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::geometry {
namespace {

using core::at;

/// The walk over the edges, part by part.
class WindingWalk {
 public:
  WindingWalk(const TriangleMesh& mesh, const EdgeTopology& topology)
      : mesh_(mesh), topology_(topology), is_turned_(mesh.triangles.size(), 0) {
    winding_.part.assign(mesh.triangles.size(), -1);
  }

  /// Which triangles to turn; none on a one-sided surface.
  std::vector<std::uint8_t> run(Winding& winding) {
    for (std::size_t seed = 0; seed < is_turned_.size() && winding_.one_sided_triangle < 0; ++seed)
      if (winding_.part[seed] < 0) walk_part(seed);
    if (winding_.one_sided_triangle >= 0) {
      winding_.part_count = 0;
      is_turned_.assign(is_turned_.size(), 0);
    }
    winding = std::move(winding_);
    return std::move(is_turned_);
  }

 private:
  void walk_part(std::size_t seed) {
    std::vector<std::size_t> members{seed};
    winding_.part[seed] = winding_.part_count++;
    for (std::size_t i = 0; i < members.size(); ++i)
      if (!visit_neighbours(members, members[i])) return;
    const auto minority =
        std::count_if(members.begin(), members.end(), [&](std::size_t t) { return is_turned_[t]; });
    if (2 * static_cast<std::size_t>(minority) > members.size())
      for (const std::size_t t : members) is_turned_[t] = !is_turned_[t];
  }

  /// False where the surface turns out to have one side.
  bool visit_neighbours(std::vector<std::size_t>& members, std::size_t t) {
    for (const int edge : topology_.triangle_edges[t]) {
      if (topology_.triangle_count(edge) != 2) continue;
      const auto begin = at(topology_.first_triangle[at(edge)]);
      const int one = topology_.edge_triangles[begin];
      const auto other = at(one == static_cast<int>(t) ? topology_.edge_triangles[begin + 1] : one);
      const auto& ends = topology_.edges[at(edge)];
      const bool agrees =
          direction_along(mesh_.triangles[t], ends) != direction_along(mesh_.triangles[other], ends);
      const bool wanted = agrees ? is_turned_[t] : !is_turned_[t];
      if (winding_.part[other] < 0) {
        winding_.part[other] = winding_.part[t];
        is_turned_[other] = wanted;
        members.push_back(other);
      } else if (static_cast<bool>(is_turned_[other]) != wanted) {
        winding_.one_sided_triangle = static_cast<int>(other);
        return false;
      }
    }
    return true;
  }

  const TriangleMesh& mesh_;
  const EdgeTopology& topology_;
  std::vector<std::uint8_t> is_turned_;
  Winding winding_;
};

/// Per part whether it is, counted.
std::vector<std::uint8_t> find_inside_out(const TriangleMesh& mesh, const EdgeTopology& topology,
                                          Winding& winding) {
  struct Part {
    double volume = 0.0;  // six times
    bool is_open = false;
    Box box;
  };
  std::vector<Part> parts(at(winding.part_count));
  // About a corner of its own: far from the origin rounding would tell.
  std::vector<const Vec3*> origins(parts.size(), nullptr);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const Vec3 &a = mesh.positions[at(corners[0])], &b = mesh.positions[at(corners[1])],
               &c = mesh.positions[at(corners[2])];
    const auto number = at(winding.part[t]);
    if (origins[number] == nullptr) origins[number] = &a;
    const Vec3& origin = *origins[number];
    parts[number].volume += (a - origin).dot((b - origin).cross(c - origin));
    for (const Vec3* corner : {&a, &b, &c}) parts[number].box.include(*corner);
    for (const int edge : topology.triangle_edges[t])
      parts[number].is_open = parts[number].is_open || topology.is_boundary(edge);
  }
  const auto is_in = [](const Box& inner, const Box& outer) {
    return (inner.low.array() >= outer.low.array()).all() && (inner.high.array() <= outer.high.array()).all();
  };
  std::vector<std::uint8_t> is_inside_out(parts.size(), 0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].is_open || !(parts[p].volume < 0.0)) continue;
    bool is_hollow = false;
    for (std::size_t other = 0; other < parts.size(); ++other)
      is_hollow = is_hollow || (other != p && is_in(parts[p].box, parts[other].box));
    if (is_hollow) continue;
    is_inside_out[p] = 1;
    if (winding.inside_out_parts++ > 0) continue;
    const auto first = std::find(winding.part.begin(), winding.part.end(), static_cast<int>(p));
    winding.first_inside_out = static_cast<int>(first - winding.part.begin());
  }
  return is_inside_out;
}

}  // namespace

Winding make_windings_agree(TriangleMesh& mesh, const EdgeTopology& topology) {
  Winding winding;
  const std::vector<std::uint8_t> is_turned = WindingWalk(mesh, topology).run(winding);
  if (winding.one_sided_triangle >= 0) return winding;
  for (std::size_t t = 0; t < is_turned.size(); ++t) {
    if (!is_turned[t]) continue;
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    if (winding.turned_count++ == 0) winding.first_turned = static_cast<int>(t);
  }
  winding.is_closed = std::none_of(topology.edges.begin(), topology.edges.end(),
                                   [&, e = 0](const auto&) mutable { return topology.is_boundary(e++); });
  const std::vector<std::uint8_t> is_inside_out = find_inside_out(mesh, topology, winding);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_inside_out[at(winding.part[t])]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return winding;
}

}  // namespace shatterbox::geometry
