#include "engine/collision/exposed_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/core/index.h"
#include "engine/core/parallel.h"
#include "engine/geometry/crossings.h"

// Why: what touches a surface without crossing it stays, near that point, on one side of it. Where two
// triangles lie in one plane that is a half space, and in a notch less. An edge that touches the inside of
// theirs, and goes on in both directions, stays there only along the surface, up to where the plane or the
// notch ends, or it does; and there a vertex touches a triangle, or two edges touch of which neither lies so.
// Likewise what is nearest. Poses, and straight ways between two of them, are affine maps, which keep flat
// what is flat and a notch a notch.
//
// But only where what is in front of a notch is outside. Of splinters thinner than what a crack takes away
// the faces have changed sides: between them the surface winds about a point -1 times, and behind a notch is
// outside. So nothing else of the surface may pass through the edge (then all of it is alike), and in front
// of its middle the surface must not wind so.

namespace shatterbox::collision {
namespace {

using core::at;
using geometry::Piercing;
using geometry::Triangle;
using Corners = std::array<Vec3, 3>;

// Of the body's size: what stands out by less is flat but for rounding.
constexpr double kFlat = 1e-12;
constexpr std::size_t kEdgesToTask = 64;

bool has(const Triangle& t, int vertex) {
  return t[0] == vertex || t[1] == vertex || t[2] == vertex;
}

Vec3 normal_of(const Corners& c) {
  return (c[1] - c[0]).cross(c[2] - c[0]);
}

// 1 if the edge has two triangles that face one way, -1 if they face opposite ways, 0 if it has not two.
int facing(const Collider& collider, const geometry::EdgeTopology& topology, std::size_t edge) {
  const int first = topology.first_triangle[edge];
  if (topology.first_triangle[edge + 1] != first + 2) return 0;
  const auto along = [&](int k) {
    return geometry::direction_along(collider.triangles[at(topology.edge_triangles[at(k)])],
                                     topology.edges[edge]);
  };
  return -along(first) * along(first + 1);
}

bool is_closed_surface(const Collider& collider, const geometry::EdgeTopology& topology) {
  for (std::size_t e = 0; e < topology.edges.size(); ++e)
    if (facing(collider, topology, e) != 1) return false;
  return true;
}

class ExposedEdges {
 public:
  ExposedEdges(const Collider& collider, const geometry::EdgeTopology& topology)
      : collider_(collider),
        topology_(topology),
        has_inside_(body::is_closed(collider.kind) && is_closed_surface(collider, topology)) {
    if (!has_inside_) return;
    geometry::refit(
        collider.tree, collider.triangles,
        [&](int v) {
          geometry::Box box;
          box.include(collider_.vertices[at(v)]);
          return box;
        },
        boxes_);
  }

  bool is_exposed(std::size_t edge) const {
    const int same_way = facing(collider_, topology_, edge);
    if (same_way == 0) return true;
    const int first = topology_.first_triangle[edge];
    const auto& ends = topology_.edges[edge];
    const int t = topology_.edge_triangles[at(first)], u = topology_.edge_triangles[at(first + 1)];
    const Triangle& corners_u = collider_.triangles[at(u)];
    const Vec3 normal_t = normal_of(corners(t)), normal_u = same_way * normal_of(corners(u));
    const double area_t = normal_t.norm(), area_u = normal_u.norm();
    if (!(area_t > 0.0) || !(area_u > 0.0) || !(normal_t.dot(normal_u) > 0.0)) return true;
    const int opposite = corners_u[0] + corners_u[1] + corners_u[2] - ends[0] - ends[1];
    // Of the edge above what joins the two triangles beyond it; less than nothing in a notch.
    const double height = normal_t.dot(position(ends[0]) - position(opposite)) / std::max(area_t, area_u);
    if (std::abs(height) <= kFlat * collider_.bounding_radius) return false;
    if (height > 0.0 || !has_inside_) return true;
    return is_passed_through(ends, t, u) ||
           !is_outside_in_front(ends, t, u, normal_t / area_t, normal_u / area_u);
  }

 private:
  const Vec3& position(int vertex) const { return collider_.vertices[at(vertex)]; }
  Corners corners(int triangle) const {
    const Triangle& t = collider_.triangles[at(triangle)];
    return {position(t[0]), position(t[1]), position(t[2])};
  }

  // Calls visit(triangle) for all that the segment may meet, until it returns false. False if it did.
  template <class Visit>
  bool each_near(const Vec3& p, const Vec3& q, const Visit& visit) const {
    const double rounding = kFlat * collider_.bounding_radius;
    const Vec3 way = q - p;
    const auto may_meet = [&](const geometry::Box& box) {
      double from = 0.0, to = 1.0;
      for (int k = 0; k < 3; ++k) {
        const double low = box.low[k] - rounding - p[k], high = box.high[k] + rounding - p[k];
        if (std::abs(way[k]) < rounding) {
          if (low > rounding || high < -rounding) return false;
          continue;
        }
        const double x = low / way[k], y = high / way[k];
        from = std::max(from, std::min(x, y));
        to = std::min(to, std::max(x, y));
      }
      return from <= to;
    };
    std::vector<int> stack(1, 0);
    while (!stack.empty()) {
      const int i = stack.back();
      stack.pop_back();
      if (!may_meet(boxes_[at(i)])) continue;
      const auto& node = collider_.tree.nodes[at(i)];
      if (node.count == 0) {
        stack.push_back(node.right);
        stack.push_back(i + 1);
      }
      for (int k = node.begin; k < node.begin + node.count; ++k)
        if (!visit(collider_.tree.order[at(k)])) return false;
    }
    return true;
  }

  // Whether any other triangle may pass through the edge.
  bool is_passed_through(const std::array<int, 2>& ends, int t, int u) const {
    const Vec3 &p = position(ends[0]), &q = position(ends[1]);
    return !each_near(p, q, [&](int other) {
      if (other == t || other == u) return true;
      const Triangle& triangle = collider_.triangles[at(other)];
      const Corners c = corners(other);
      if (has(triangle, ends[0])) return !lies_in(p, q, c);
      if (has(triangle, ends[1])) return !lies_in(q, p, c);
      return geometry::pierce(p, q, c[0], c[1], c[2]) == Piercing::no;
    });
  }

  // Whether a segment from a triangle's corner may lie in the triangle: in no other way do they meet.
  bool lies_in(const Vec3& corner, const Vec3& end, const Corners& c) const {
    const Vec3 normal = normal_of(c), way = end - corner;
    const double area = normal.norm(), rounding = kFlat * collider_.bounding_radius;
    if (std::abs(normal.dot(way)) > rounding * area) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 inward = normal.cross(c[(i + 1) % 3] - c[i]);  // across a side, towards the triangle
      if (inward.dot(corner - c[i]) <= rounding * inward.norm() &&
          inward.dot(way) < -rounding * inward.norm())
        return false;
    }
    return true;
  }

  // Whether the surface surely winds no less than zero times about what is in front of the edge's middle.
  bool is_outside_in_front(const std::array<int, 2>& ends, int t, int u, const Vec3& normal_t,
                           const Vec3& normal_u) const {
    const Vec3 middle = 0.5 * (position(ends[0]) + position(ends[1]));
    for (const double share : {0.5, 0.43, 0.57}) {
      const Vec3 way = 8.0 * collider_.bounding_radius * (share * normal_t + (1.0 - share) * normal_u);
      if (const auto winding = winding_before(middle, middle + way, t, u)) return *winding >= 0;
    }
    return false;
  }

  // How often the surface without these two triangles winds about `from`, if it does not about `to`; none if
  // that is not sure.
  std::optional<int> winding_before(const Vec3& from, const Vec3& to, int t, int u) const {
    int winding = 0;
    const bool is_sure = each_near(from, to, [&](int other) {
      if (other == t || other == u) return true;
      const Corners c = corners(other);
      const Piercing piercing = geometry::pierce(from, to, c[0], c[1], c[2]);
      if (piercing == Piercing::yes) winding += normal_of(c).dot(to - from) > 0.0 ? 1 : -1;
      return piercing != Piercing::perhaps;
    });
    return is_sure ? std::optional(winding) : std::nullopt;
  }

  const Collider& collider_;
  const geometry::EdgeTopology& topology_;
  const bool has_inside_;
  std::vector<geometry::Box> boxes_;  // of the tree's nodes, body space
};

}  // namespace

std::vector<char> find_exposed_edges(const Collider& collider, const geometry::EdgeTopology& topology) {
  std::vector<char> exposed(topology.edges.size(), 1);
  const ExposedEdges edges(collider, topology);
  core::parallel_for(exposed.size(), kEdgesToTask,
                     [&](std::size_t e) { exposed[e] = edges.is_exposed(e) ? 1 : 0; });
  return exposed;
}

}  // namespace shatterbox::collision
