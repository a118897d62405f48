// The stretches of all cracks of a break, and which of them are near a point: for the rules that keep cracks
// apart and let them join.
#pragma once

#include <vector>

#include "engine/core/vec.h"

namespace shatterbox::fracture {

/// A straight stretch, with what the rules need to know about it.
struct CrackStretch {
  Vec3 begin = Vec3::Zero(), end = Vec3::Zero();  // m
  int crack = 0;
  int branch = 0;            // 0 or 1: which of the crack's two tips made it
  int piece = 0;             // that it runs in
  double branch_length = 0;  // m, of the branch up to its middle
};

class CrackSet {
 public:
  void add(const CrackStretch& stretch);
  void clear() { blocks_.clear(); }

  /// Calls visit(stretch, nearest point, distance) for all stretches nearer than `radius`; stops when it
  /// returns false.
  template <class Visit>
  void visit_near(const Vec3& p, double radius, const Visit& visit) const {
    for (const Block& block : blocks_) {
      const double reach = radius + block.radius;
      if ((block.centre - p).squaredNorm() > reach * reach) continue;
      for (const CrackStretch& s : block.stretches) {
        const Vec3 near = nearest_point(s, p);
        const double distance = (near - p).norm();
        if (distance < radius && !visit(s, near, distance)) return;
      }
    }
  }

 private:
  struct Block {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;
    std::vector<CrackStretch> stretches;
  };
  static Vec3 nearest_point(const CrackStretch& s, const Vec3& p) {
    const Vec3 along = s.end - s.begin;
    const double squared = along.squaredNorm();
    const double t = squared > 0.0 ? along.dot(p - s.begin) / squared : 0.0;
    return s.begin + (t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t) * along;
  }
  std::vector<Block> blocks_;
};

}  // namespace shatterbox::fracture
