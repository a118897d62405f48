// Features that turn together, hardly apart: along any fixed direction they seem to close, for what is far
// out turns towards it. Along the normal of a plane that turns with them they do not.
#pragma once

#include <algorithm>
#include <array>

#include "engine/core/vec.h"

namespace shatterbox::geometry {

/// A vector that changes linearly, by its values at both ends.
struct LinearVector {
  Vec3 from, to;

  double size() const { return std::max(from.norm(), to.norm()); }
};

/// The normal p x q of a plane that goes with two such vectors: quadratic, by its Bernstein coefficients.
class MovingNormal {
 public:
  MovingNormal(const LinearVector& p, const LinearVector& q);

  const Vec3& first() const { return first_; }
  /// Nowhere is it longer.
  double longest() const { return longest_; }
  /// Bernstein coefficients of its product with d, a cubic that is nowhere below the least of them.
  std::array<double, 4> times(const LinearVector& d) const;

 private:
  Vec3 first_, middle_, last_;
  double longest_;
};

/// m: at least so far apart two features stay, while their vertices go along straight lines from `start` to
/// `end` (world, m): point 0 and the triangle of points 1 to 3, or the edges of points 0 and 1 and of points
/// 2 and 3. Told along the normals of planes that go with them: the triangle's, that of both edges, and those
/// about one of their edges; `direction` leads from the second feature to the first one now, about. Zero if
/// no such plane tells. The distance along a normal is a cubic over the normal's length; it is bounded by its
/// Bernstein coefficients, less what rounding may have added.
double separation_by_moving_plane(const std::array<Vec3, 4>& start, const std::array<Vec3, 4>& end,
                                  bool is_edge_edge, const Vec3& direction);

}  // namespace shatterbox::geometry
