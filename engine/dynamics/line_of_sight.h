// Whether bodies stand between two points.
#pragma once

#include <span>
#include <vector>

#include "engine/body/body.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::dynamics {

class LineOfSight {
 public:
  /// `bodies` must outlive it, where they are.
  explicit LineOfSight(std::span<const body::Body> bodies);

  /// True if a surface lies between the points (m, world), up to a thousandth of their distance before `to`,
  /// which may lie on a surface itself.
  bool is_blocked(const Vec3& from, const Vec3& to) const;

 private:
  struct Screen {
    const body::Body* body = nullptr;
    geometry::TriangleTree tree;       // of meshes
    std::vector<geometry::Box> boxes;  // body space
  };
  std::vector<Screen> screens_;
};

}  // namespace shatterbox::dynamics
