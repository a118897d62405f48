#include "engine/geometry/moving_plane.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "engine/core/index.h"

namespace shatterbox::geometry {
namespace {

using core::at;

constexpr double kLostByRounding = 32.0 * std::numeric_limits<double>::epsilon();

constexpr std::array<std::pair<int, int>, 3> kPointTriangle{{{0, 1}, {0, 2}, {0, 3}}};
constexpr std::array<std::pair<int, int>, 4> kEdgeEdge{{{0, 2}, {0, 3}, {1, 2}, {1, 3}}};

class MovingFeatures {
 public:
  MovingFeatures(const std::array<Vec3, 4>& start, const std::array<Vec3, 4>& end, bool is_edge_edge,
                 const Vec3& direction)
      : start_(start), end_(end), direction_(direction) {
    if (is_edge_edge)
      pairs_ = kEdgeEdge;
    else
      pairs_ = kPointTriangle;
    for (const auto* points : {&start, &end})
      for (const Vec3& x : *points) coordinate_ = std::max(coordinate_, x.cwiseAbs().maxCoeff());
  }

  LinearVector between(int i, int j) const {
    return {start_[at(i)] - start_[at(j)], end_[at(i)] - end_[at(j)]};
  }

  /// Along p x q.
  double along_plane(const LinearVector& p, const LinearVector& q) const { return along(p, q, true); }

  /// Along the normal of the plane through an edge that faces the direction.
  double about_edge(const LinearVector& edge) const {
    const Vec3 side = direction_.cross(edge.from);
    const double length = side.norm();
    if (!(length > 0.0)) return 0.0;
    return along(edge, {side / length, side / length}, false);
  }

 private:
  double along(const LinearVector& p, const LinearVector& q, bool is_q_rounded) const {
    const MovingNormal normal(p, q);
    if (!(normal.longest() > 0.0)) return 0.0;
    const double side = normal.first().dot(direction_) > 0.0 ? 1.0 : -1.0;
    const double length_p = p.size(), length_q = q.size();
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [i, j] : pairs_) {
      const LinearVector d = between(i, j);
      // Vertices are rounded on their ways, and products.
      const double length = d.size();
      const double lost = kLostByRounding * (coordinate_ * (length_p * length_q + length_q * length +
                                                            (is_q_rounded ? length_p * length : 0.0)) +
                                             length_p * length_q * length);
      for (const double c : normal.times(d)) least = std::min(least, side * c - lost);
    }
    return std::max(0.0, least / normal.longest());
  }

  const std::array<Vec3, 4>&start_, &end_;
  const Vec3& direction_;
  std::span<const std::pair<int, int>> pairs_;  // a vertex of the first feature, one of the second
  double coordinate_ = 0.0;                     // m, the greatest
};

}  // namespace

MovingNormal::MovingNormal(const LinearVector& p, const LinearVector& q)
    : first_(p.from.cross(q.from)),
      middle_(0.5 * (p.from.cross(q.to) + p.to.cross(q.from))),
      last_(p.to.cross(q.to)),
      longest_(std::max({first_.norm(), middle_.norm(), last_.norm()})) {}

std::array<double, 4> MovingNormal::times(const LinearVector& d) const {
  return {first_.dot(d.from), (first_.dot(d.to) + 2.0 * middle_.dot(d.from)) / 3.0,
          (2.0 * middle_.dot(d.to) + last_.dot(d.from)) / 3.0, last_.dot(d.to)};
}

double separation_by_moving_plane(const std::array<Vec3, 4>& start, const std::array<Vec3, 4>& end,
                                  bool is_edge_edge, const Vec3& direction) {
  const MovingFeatures features(start, end, is_edge_edge, direction);
  if (is_edge_edge) {
    const LinearVector p = features.between(1, 0), q = features.between(3, 2);
    return std::max({features.along_plane(p, q), features.about_edge(p), features.about_edge(q)});
  }
  const LinearVector p = features.between(2, 1), q = features.between(3, 1);
  return std::max({features.along_plane(p, q), features.about_edge(p), features.about_edge(q),
                   features.about_edge(features.between(3, 2))});
}

}  // namespace shatterbox::geometry
