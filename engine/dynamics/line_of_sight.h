// What stands between two points.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/body/body.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::dynamics {

class LineOfSight {
 public:
  /// `bodies` must outlive it, where they are.
  explicit LineOfSight(std::span<const body::Body> bodies);

  /// The share of the way from one point to the other (m, world) at which it first meets a body; 0 if it
  /// begins in one that is not a shell; nothing if it meets none.
  std::optional<double> first_hit(const Vec3& from, const Vec3& to) const;

  /// True if a surface lies between the points (m, world), up to a thousandth of their distance before `to`,
  /// which may lie on a surface itself.
  bool is_blocked(const Vec3& from, const Vec3& to) const;

 private:
  struct Screen {
    const body::Body* body = nullptr;
    geometry::TriangleTree tree;       // of meshes
    std::vector<geometry::Box> boxes;  // body space
  };
  /// The share of the way at which it meets one body; 1 if it does not.
  static double share_before(const Screen& screen, const Vec3& from, const Vec3& to);
  std::vector<Screen> screens_;
};

}  // namespace shatterbox::dynamics
