// The plane of one element: its facet frame and the maps between barycentric weights, plane coordinates and
// space.
#pragma once

#include <deque>
#include <vector>

#include "engine/core/elementary.h"
#include "engine/core/vec.h"
#include "engine/geometry/shell_mesh.h"

namespace shatterbox::fracture {

struct ElementPlane {
  Vec3 origin = Vec3::Zero();
  Mat3 frame = Mat3::Identity();     // columns e1, e2, normal
  Mat2 from_weights = Mat2::Zero();  // plane coordinates of corners 1 and 2
  Mat2 to_weights = Mat2::Zero();
  double scale = 0.0;  // m, sqrt(2 area); 0 for an element without area: nothing is cut there

  Vec2 flat(const Vec2& barycentric) const { return from_weights * barycentric; }
  Vec2 weights(const Vec2& flat_point) const { return to_weights * flat_point; }
  Vec3 space(const Vec2& flat_point) const {
    return origin + frame.col(0) * flat_point.x() + frame.col(1) * flat_point.y();
  }
  Vec3 middle() const { return space(flat(Vec2(1.0 / 3.0, 1.0 / 3.0))); }
  Vec3 direction(const Vec2& d) const { return frame.col(0) * d.x() + frame.col(1) * d.y(); }
  Vec2 flat_direction(const Vec3& d) const { return {frame.col(0).dot(d), frame.col(1).dot(d)}; }
};

inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

inline ElementPlane make_element_plane(const geometry::ShellElements& elements, int element) {
  ElementPlane plane;
  const geometry::Triangle& t = elements.mesh.triangles[static_cast<std::size_t>(element)];
  const auto corner = [&](std::size_t i) -> const Vec3& {
    return elements.mesh.positions[static_cast<std::size_t>(t[i])];
  };
  plane.origin = corner(0);
  plane.frame = facet_frame(elements, element);
  plane.from_weights.col(0) = plane.flat_direction(corner(1) - corner(0));
  plane.from_weights.col(1) = plane.flat_direction(corner(2) - corner(0));
  const double determinant = plane.from_weights.determinant();
  if (!(determinant > 1e-14 * plane.from_weights.squaredNorm())) return plane;
  plane.to_weights = plane.from_weights.inverse();
  plane.scale = core::sqrt(determinant);
  return plane;
}

/// The planes of a mesh, each made when it is first asked for: cracks go through few elements. The elements
/// must outlive it; one thread at a time.
class ElementPlanes {
 public:
  explicit ElementPlanes(const geometry::ShellElements& elements)
      : elements_(elements), places_(elements.mesh.triangles.size(), -1) {}

  const ElementPlane& of(int element) const {
    int& place = places_[static_cast<std::size_t>(element)];
    if (place < 0) {
      place = static_cast<int>(made_.size());
      made_.push_back(make_element_plane(elements_, element));
    }
    return made_[static_cast<std::size_t>(place)];
  }

 private:
  const geometry::ShellElements& elements_;
  mutable std::vector<int> places_;  // in `made_`; -1: not made
  mutable std::deque<ElementPlane> made_;
};

/// `d` turned by a right angle to its left.
inline Vec2 left_of(const Vec2& d) {
  return {-d.y(), d.x()};
}

}  // namespace shatterbox::fracture
