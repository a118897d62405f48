#include "engine/collision/relative_way.h"

#include <cmath>

namespace shatterbox::collision {
namespace {

// Rounding in single precision of what goes so far about a place, and of the few operations on it.
constexpr double kRounding = 2e-6;
// Nothing is gone along with that turns so far that all lengths seen would grow by this.
constexpr double kLeastLength = 0.7;

// No vector grows by more than this.
double size_of(const Mat3& m) {
  return m.norm();
}

BoxLanes lanes(const Vec3& v, double sum) {
  return BoxLanes{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]),
                  static_cast<float>(sum)};
}

// How far a vertex goes at most, m.
double length_of(const BodyWay& way, double reach) {
  return (way.to - way.from).norm() + size_of(way.turned_to - way.turned_from) * reach;
}

bool is_still(const BodyWay& way) {
  return way.from.isZero(0.0) && way.to.isZero(0.0) && way.turned_from.isIdentity(0.0) &&
         way.turned_to.isIdentity(0.0);
}

// As seen by one who goes along with the centre of another.
BodyWay seen_along(const BodyWay& rider, const BodyWay& way) {
  BodyWay seen = way;
  seen.from -= rider.from;
  seen.to -= rider.to;
  return seen;
}

// And turns with it.
BodyWay seen_in(const BodyWay& rider, const BodyWay& way) {
  BodyWay seen;
  seen.centre = way.centre;
  const Vec3 between = way.centre - rider.centre;
  const Vec3 from = between + way.from - rider.from, to = between + way.to - rider.to;
  const bool begins_there = rider.turned_from.isIdentity(0.0);
  const Mat3 back_from = begins_there ? Mat3(Mat3::Identity()) : Mat3(rider.turned_from.inverse()),
             back_to = rider.turned_to.inverse();
  seen.from = back_from * from - between;
  seen.to = back_to * to - between;
  seen.turned_from = back_from * way.turned_from;
  seen.turned_to = back_to * way.turned_to;
  return seen;
}

// How far from a straight line what goes on `seen` is seen at most, m. With A(t) = A0 + t (A1 - A0) the turn
// of the rider and D how far a point is seen to go in all, it is seen at t (1 - t) A(t)^-1 (A1 - A0) D beside
// the even way from its beginning to its end.
double bow_of(const BodyWay& rider, const BodyWay& seen, double reach) {
  const double turned =
      std::sqrt(0.5) * size_of(rider.turned_to - rider.turned_from);  // in one plane, evenly
  return 0.25 * turned / rider.least_length * length_of(seen, reach) * (1.0 + 1e-9);
}

}  // namespace

SeenWay::Shift::Shift(const Vec3& centre_, const Vec3& way_, const Mat3& strain, double reach)
    : centre(lanes(centre_, 0.0)), way(lanes(way_, way_.sum())) {
  const double rounding =
      kRounding * (way_.cwiseAbs().maxCoeff() + size_of(strain) * (centre_.cwiseAbs().maxCoeff() + reach));
  spare = lanes(Vec3::Constant(rounding), 3.0 * rounding);
  for (int k = 0; k < 3; ++k) {
    const Vec3 column = strain.col(k);
    columns[static_cast<std::size_t>(k)] = lanes(column, column.sum());
    sizes[static_cast<std::size_t>(k)] = lanes(column.cwiseAbs(), std::abs(column.sum()));
  }
}

SeenWay::SeenWay(const BodyWay& way, double reach) : stays_(is_still(way)), way_(way) {
  if (stays_) return;
  is_there_ = way.from.isZero(0.0) && way.turned_from.isIdentity(0.0);
  if (!is_there_) from_ = Shift(way.centre, way.from, way.turned_from - Mat3::Identity(), reach);
  to_ = Shift(way.centre, way.to, way.turned_to - Mat3::Identity(), reach);
}

RelativeWays::RelativeWays(const BodyWay& way_a, double reach_a, const BodyWay& way_b, double reach_b) {
  const BodyWay along_a = seen_along(way_a, way_a), along_b = seen_along(way_a, way_b);
  const bool rides_a = way_a.least_length >= way_b.least_length;
  const BodyWay &rider = rides_a ? way_a : way_b, &other = rides_a ? way_b : way_a;
  const double reach = rides_a ? reach_b : reach_a;
  if (rider.least_length >= kLeastLength) {
    const BodyWay seen = seen_in(rider, other);
    bow = bow_of(rider, seen, reach);
    if (length_of(seen, reach) + bow <= length_of(along_a, reach_a) + length_of(along_b, reach_b)) {
      least_length = rider.least_length;
      (rides_a ? b : a) = SeenWay(seen, reach);
      return;
    }
    bow = 0.0;
  }
  a = SeenWay(along_a, reach_a);
  b = SeenWay(along_b, reach_b);
}

}  // namespace shatterbox::collision
