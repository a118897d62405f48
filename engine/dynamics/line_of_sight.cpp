#include "engine/dynamics/line_of_sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/elementary.h"

namespace shatterbox::dynamics {

namespace {

using body::ShapeKind;

/// From `from` (share 0) along `way` to its end (share 1).
struct Segment {
  Vec3 from, way;
};

/// Shares of a segment within a box, as an interval; empty (first > second) if it misses.
std::pair<double, double> within(const Segment& s, const Vec3& low, const Vec3& high) {
  double begin = 0.0, end = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (s.way[axis] == 0.0) {
      if (s.from[axis] < low[axis] || s.from[axis] > high[axis]) return {1.0, 0.0};
      continue;
    }
    const double a = (low[axis] - s.from[axis]) / s.way[axis], b = (high[axis] - s.from[axis]) / s.way[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return {begin, end};
}

/// By the volumes that the segment makes with the triangle's edges. The share at which it goes through; 1 if
/// it does not.
double share_at_triangle(const Segment& s, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const double across = normal.dot(s.way);
  if (across == 0.0) return 1.0;
  const double share = normal.dot(a - s.from) / across;
  if (!(share > 0.0 && share < 1.0)) return 1.0;
  const Vec3 p = s.from + share * s.way;
  const double u = normal.dot((b - a).cross(p - a)), v = normal.dot((c - b).cross(p - b)),
               w = normal.dot((a - c).cross(p - c));
  return u >= 0.0 && v >= 0.0 && w >= 0.0 ? share : 1.0;
}

double share_at_ball(const Segment& s, double radius) {
  const double a = s.way.squaredNorm(), b = s.from.dot(s.way), c = s.from.squaredNorm() - radius * radius;
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0.0) || !(a > 0.0)) return 1.0;
  const double root = core::sqrt(discriminant), begin = std::max(0.0, (-b - root) / a);
  return begin < std::min(1.0, (-b + root) / a) ? begin : 1.0;
}

/// The ball that is swept along the axis: the first of both ends and of the cylinder between them.
double share_at_capsule(const Segment& s, double radius, double half_length) {
  double least = 1.0;
  for (const double end : {-half_length, half_length})
    least = std::min(least, share_at_ball({s.from - Vec3(0.0, end, 0.0), s.way}, radius));
  const double flat = share_at_ball({{s.from.x(), 0.0, s.from.z()}, {s.way.x(), 0.0, s.way.z()}}, radius);
  const bool is_on_side = std::abs(s.from.y() + flat * s.way.y()) <= half_length;
  return is_on_side ? std::min(least, flat) : least;
}

double share_at_plane(const Segment& s) {
  if (s.from.y() < 0.0) return 0.0;
  const double end = s.from.y() + s.way.y();
  return end < 0.0 ? s.from.y() / (s.from.y() - end) : 1.0;
}

double share_at_mesh(const Segment& s, const geometry::TriangleMesh& mesh, const geometry::TriangleTree& tree,
                     const std::vector<geometry::Box>& boxes) {
  double least = 1.0;
  if (tree.nodes.empty()) return least;
  std::vector<int> stack{0};
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    const geometry::Box& box = boxes[static_cast<std::size_t>(node)];
    const auto [begin, end] = within(s, box.low, box.high);
    if (begin > end || begin >= least) continue;
    const geometry::TriangleTree::Node& n = tree.nodes[static_cast<std::size_t>(node)];
    if (n.count == 0) {
      stack.push_back(n.right);
      stack.push_back(node + 1);
      continue;
    }
    for (int k = n.begin; k < n.begin + n.count; ++k) {
      const geometry::Triangle& t =
          mesh.triangles[static_cast<std::size_t>(tree.order[static_cast<std::size_t>(k)])];
      const auto corner = [&](int i) -> const Vec3& {
        return mesh.positions[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])];
      };
      least = std::min(least, share_at_triangle(s, corner(0), corner(1), corner(2)));
    }
  }
  return least;
}

}  // namespace

LineOfSight::LineOfSight(std::span<const body::Body> bodies) {
  for (const body::Body& body : bodies) {
    Screen screen{&body, {}, {}};
    if (body::is_mesh(body.shape->kind)) {
      const geometry::TriangleMesh& mesh = body.shape->surface;
      screen.tree = geometry::build_triangle_tree(mesh.positions, mesh.triangles);
      const auto box_of = [&mesh](int vertex) {
        const Vec3& p = mesh.positions[static_cast<std::size_t>(vertex)];
        return geometry::Box{p, p};
      };
      geometry::refit(screen.tree, mesh.triangles, box_of, screen.boxes);
    }
    screens_.push_back(std::move(screen));
  }
}

double LineOfSight::share_before(const Screen& screen, const Vec3& from, const Vec3& to) {
  const body::Body& body = *screen.body;
  const body::Shape& shape = *body.shape;
  Segment s{body.pose.apply_inverse(from), Vec3::Zero()};
  s.way = body.pose.apply_inverse(to) - s.from;
  if (shape.kind == ShapeKind::plane) return share_at_plane(s);
  if (shape.kind == ShapeKind::sphere) return share_at_ball(s, shape.radius);
  if (shape.kind == ShapeKind::capsule) return share_at_capsule(s, shape.radius, shape.half_length);
  if (shape.kind == ShapeKind::box) {
    const auto [begin, end] = within(s, -shape.half_extent, shape.half_extent);
    return begin < end ? begin : 1.0;
  }
  if (share_at_ball(s, shape.bounding_radius) >= 1.0) return 1.0;
  return share_at_mesh(s, shape.surface, screen.tree, screen.boxes);
}

std::optional<double> LineOfSight::first_hit(const Vec3& from, const Vec3& to) const {
  double least = 1.0;
  for (const Screen& screen : screens_) least = std::min(least, share_before(screen, from, to));
  if (least < 1.0) return least;
  return std::nullopt;
}

bool LineOfSight::is_blocked(const Vec3& from, const Vec3& to) const {
  constexpr double kBefore = 1e-3;  // of the way: the surface on which its end lies does not count
  const Vec3 end = from + (1.0 - kBefore) * (to - from);
  for (const Screen& screen : screens_)
    if (share_before(screen, from, end) < 1.0) return true;
  return false;
}

}  // namespace shatterbox::dynamics
