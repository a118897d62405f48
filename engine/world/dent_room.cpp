#include "engine/world/dent_room.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/collision/collider.h"
#include "engine/core/index.h"
#include "engine/geometry/continuous_tests.h"

namespace shatterbox::world {
namespace {

using core::at;

/// Of what is known to touch: nearer than rounding tells there is no half.
constexpr double kNearestShare = 0.5;

template <int Corners>
std::array<double, 3 * Corners> pack(const std::vector<Vec3>& points,
                                     const std::array<int, Corners>& corners) {
  std::array<double, 3 * Corners> out;
  for (std::size_t i = 0; i < Corners; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[3 * i + axis] = points[at(corners[i])](static_cast<int>(axis));
  return out;
}

std::shared_ptr<const collision::Collider> collider_of(const MovingSurface& surface) {
  body::Shape shape;
  shape.kind = body::ShapeKind::shell;
  shape.surface.positions = surface.start;
  shape.surface.triangles = surface.triangles;
  return collision::make_collider(shape, collision::SurfaceMotion::free);
}

/// A surface against one of a collider, whose vertices go straight too.
class RoomSearch {
 public:
  RoomSearch(const MovingSurface& surface, const body::Body& other, double least_separation)
      : surface_(surface), least_(least_separation) {
    own_ = collider_of(surface);
    theirs_ = collision::make_collider(*other.shape);
    for (const Vec3& p : theirs_->vertices) their_start_.push_back(other.pose.apply(p));
    their_end_ = their_start_;
  }

  /// Against itself.
  RoomSearch(const MovingSurface& surface, double least_separation)
      : surface_(surface),
        least_(least_separation),
        their_start_(surface.start),
        their_end_(surface.end),
        is_itself_(true) {
    own_ = theirs_ = collider_of(surface);
  }

  Room find() {
    std::vector<geometry::Box> own_boxes, their_boxes;
    const auto own_box = [&](int v) { return swept_box(surface_.start, surface_.end, v); };
    const auto their_box = [&](int v) { return swept_box(their_start_, their_end_, v); };
    refit(own_->tree, own_->triangles, own_box, own_boxes);
    refit(theirs_->tree, theirs_->triangles, their_box, their_boxes);
    const double margin = least_ + theirs_->radius;
    const auto box_of = [](const geometry::Triangle& t, const auto& vertex_box) {
      geometry::Box box;
      for (const int v : t) box.include(vertex_box(v));
      return box;
    };
    std::vector<std::pair<int, int>> stack;
    for_each_leaf_pair(own_->tree, own_boxes, theirs_->tree, their_boxes, margin, stack,
                       [&](const auto& a, const auto& b) {
                         for (int i = a.begin; i < a.begin + a.count; ++i)
                           for (int k = b.begin; k < b.begin + b.count; ++k) {
                             const int s = own_->tree.order[at(i)], t = theirs_->tree.order[at(k)];
                             if (overlaps(box_of(own_->triangles[at(s)], own_box),
                                          box_of(theirs_->triangles[at(t)], their_box), margin))
                               test_triangles(s, t);
                           }
                       });
    return room_;
  }

 private:
  static geometry::Box swept_box(const std::vector<Vec3>& start, const std::vector<Vec3>& end, int vertex) {
    geometry::Box box;
    box.include(start[at(vertex)]);
    box.include(end[at(vertex)]);
    return box;
  }

  template <std::size_t First, std::size_t Second>
  bool have_common_vertex(const std::array<int, First>& a, const std::array<int, Second>& b) const {
    return is_itself_ && std::any_of(a.begin(), a.end(),
                                     [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
  }

  void test_triangles(int own, int theirs) {
    for (int i = theirs_->owned_vertex_begin[at(theirs)]; i < theirs_->owned_vertex_begin[at(theirs) + 1];
         ++i)
      test_their_vertex(theirs_->owned_vertices[at(i)], own_->triangles[at(own)]);
    if (theirs_->edges.empty()) return;  // a ball is one vertex
    if (!is_itself_)                     // the other way round is met as well
      for (int i = own_->owned_vertex_begin[at(own)]; i < own_->owned_vertex_begin[at(own) + 1]; ++i)
        test_own_vertex(own_->owned_vertices[at(i)], theirs_->triangles[at(theirs)]);
    for (int i = own_->owned_edge_begin[at(own)]; i < own_->owned_edge_begin[at(own) + 1]; ++i)
      for (int k = theirs_->owned_edge_begin[at(theirs)]; k < theirs_->owned_edge_begin[at(theirs) + 1]; ++k)
        test_edges(own_->edges[at(own_->owned_edges[at(i)])],
                   theirs_->edges[at(theirs_->owned_edges[at(k)])]);
  }

  void test_their_vertex(int vertex, const geometry::Triangle& triangle) {
    if (have_common_vertex(std::array<int, 1>{vertex}, triangle)) return;
    const auto point = pack<1>(their_start_, {vertex}), point_end = pack<1>(their_end_, {vertex});
    const auto start = pack<3>(surface_.start, triangle), end = pack<3>(surface_.end, triangle);
    settle(theirs_->radius, -1.0, triangle, [&](double least) {
      return geometry::test_point_triangle(point.data(), start.data(), point_end.data(), end.data(), least);
    });
  }

  void test_own_vertex(int vertex, const geometry::Triangle& triangle) {
    const auto start = pack<1>(surface_.start, {vertex}), end = pack<1>(surface_.end, {vertex});
    const auto their_start = pack<3>(their_start_, triangle), their_end = pack<3>(their_end_, triangle);
    settle(0.0, 1.0, std::array<int, 1>{vertex}, [&](double least) {
      return geometry::test_point_triangle(start.data(), their_start.data(), end.data(), their_end.data(),
                                           least);
    });
  }

  void test_edges(const std::array<int, 2>& own, const std::array<int, 2>& theirs) {
    if (have_common_vertex(own, theirs)) return;
    const auto start = pack<2>(surface_.start, own), end = pack<2>(surface_.end, own);
    const auto their_start = pack<2>(their_start_, theirs), their_end = pack<2>(their_end_, theirs);
    settle(0.0, 1.0, own, [&](double least) {
      return geometry::test_edge_edge(start.data(), their_start.data(), end.data(), their_end.data(), least);
    });
  }

  /// `sign`: of the test's normal, to point to the surface. `corners`: of it, that meet.
  template <std::size_t Count, class Test>
  void settle(double radius, double sign, const std::array<int, Count>& corners, const Test& test) {
    geometry::ContinuousResult result = test(radius + least_);
    if (!result.hit) return;
    if (result.time_of_impact <= 0.0) {
      const double gap = result.distance - radius;
      result = test(radius + kNearestShare * std::max(0.0, gap));
      if (!result.hit) return;
    }
    if (result.time_of_impact >= room_.share) return;
    room_.share = result.time_of_impact;
    room_.normal = sign * Vec3(result.normal[0], result.normal[1], result.normal[2]);
    room_.approach = 0.0;
    for (const int v : corners)
      room_.approach =
          std::max(room_.approach, -room_.normal.dot(surface_.end[at(v)] - surface_.start[at(v)]));
  }

  const MovingSurface& surface_;
  double least_;
  std::shared_ptr<const collision::Collider> own_, theirs_;
  std::vector<Vec3> their_start_, their_end_;
  bool is_itself_ = false;
  Room room_;
};

/// Whether no point of the surface comes that near to a body on its way.
bool is_far(const MovingSurface& surface, const body::Body& other, double least) {
  geometry::Box box;
  for (const Vec3& p : surface.start) box.include(p);
  for (const Vec3& p : surface.end) box.include(p);
  const Vec3& centre = other.pose.translation;
  const double reach = (1.0 + 1e-9) * (other.shape->bounding_radius + least);
  return (centre.cwiseMax(box.low).cwiseMin(box.high) - centre).norm() > reach;
}

Room room_before_plane(const MovingSurface& surface, const body::Body& plane, double least) {
  Room room;
  const Vec3 normal = plane.pose.rotation * Vec3::UnitY();
  for (std::size_t v = 0; v < surface.start.size(); ++v) {
    const double before = normal.dot(surface.start[v] - plane.pose.translation);
    const double after = normal.dot(surface.end[v] - plane.pose.translation);
    const double wanted = std::min(least, kNearestShare * before);
    if (after >= wanted || after >= before) continue;
    room.share = std::min(room.share, std::max(0.0, before - wanted) / (before - after));
    room.normal = normal;
    room.approach = std::max(room.approach, before - after);
  }
  return room;
}

}  // namespace

Room find_room(const MovingSurface& surface, const body::Body& other, double least_separation) {
  if (other.shape->kind == body::ShapeKind::plane) return room_before_plane(surface, other, least_separation);
  if (is_far(surface, other, least_separation)) return {};
  return RoomSearch(surface, other, least_separation).find();
}

double own_free_share(const MovingSurface& surface, double least_separation) {
  return RoomSearch(surface, least_separation).find().share;
}

}  // namespace shatterbox::world
