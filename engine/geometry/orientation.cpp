#include "engine/geometry/orientation.h"

#include <cmath>
#include <limits>
#include <utility>

namespace shatterbox::geometry {
namespace {

using Exact3 = std::array<Expansion, 3>;
using Corners = std::array<Vec3, 3>;

struct Volume {
  double value, bound;  // six times the volume, and how far rounding may have taken it
};

Volume volume_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double xy = u.x() * v.y(), yx = u.y() * v.x();
  const double yz = u.y() * v.z(), zy = u.z() * v.y();
  const double zx = u.z() * v.x(), xz = u.x() * v.z();
  const double value = (yz - zy) * w.x() + (zx - xz) * w.y() + (xy - yx) * w.z();
  const double size = (std::abs(yz) + std::abs(zy)) * std::abs(w.x()) +
                      (std::abs(zx) + std::abs(xz)) * std::abs(w.y()) +
                      (std::abs(xy) + std::abs(yx)) * std::abs(w.z());
  // [She97] has (7 + 56 e) e, e half of this epsilon.
  return {value, 4.0 * std::numeric_limits<double>::epsilon() * size};
}

Exact3 exact_difference(const Vec3& p, const Vec3& q) {
  return {Expansion::difference(p.x(), q.x()), Expansion::difference(p.y(), q.y()),
          Expansion::difference(p.z(), q.z())};
}

Exact3 exact_cross(const Exact3& u, const Exact3& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

Expansion exact_dot(const Exact3& u, const Exact3& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

Exact3 exact_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return exact_cross(exact_difference(b, a), exact_difference(c, a));
}

Expansion exact_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return exact_dot(exact_normal(a, b, c), exact_difference(d, a));
}

/// Sign of the product with (e, e^2, e^3).
int leading_sign(const Exact3& v) {
  for (const Expansion& x : v)
    if (const int sign = x.sign(); sign != 0) return sign;
  return 0;
}

/// Where the edge a-b, moved against the surface's motion, meets the triangle's plane, as fractions of one
/// denominator: without the motion, and what each axis of the motion adds.
struct ExactPassage {
  std::array<Expansion, 4> numerators;
  Expansion denominator;  // positive
};

ExactPassage exact_passage(const Vec3& a, const Vec3& b, const Corners& triangle) {
  const Exact3 normal = exact_normal(triangle[0], triangle[1], triangle[2]);
  Expansion height = exact_dot(normal, exact_difference(triangle[0], a));
  Expansion slope = exact_dot(normal, exact_difference(b, a));
  if (slope.sign() > 0) return {{std::move(height), normal[0], normal[1], normal[2]}, std::move(slope)};
  const Expansion zero;
  return {{zero - height, zero - normal[0], zero - normal[1], zero - normal[2]}, zero - slope};
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Volume volume = volume_of(a, b, c, d);
  if (volume.value > volume.bound) return 1;
  if (volume.value < -volume.bound) return -1;
  return exact_volume(a, b, c, d).sign();
}

double oriented_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Volume volume = volume_of(a, b, c, d);
  return std::abs(volume.value) > 1e4 * volume.bound ? volume.value : exact_volume(a, b, c, d).estimate();
}

int side_of_surface(const Corners& triangle, const Vec3& p) {
  const int sign = orientation(triangle[0], triangle[1], triangle[2], p);
  return sign != 0 ? sign : -leading_sign(exact_normal(triangle[0], triangle[1], triangle[2]));
}

int side_of_face(const Corners& face, const Vec3& p) {
  const int sign = orientation(face[0], face[1], face[2], p);
  return sign != 0 ? sign : leading_sign(exact_normal(face[0], face[1], face[2]));
}

int turn_of_edges(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& q) {
  const int sign = orientation(a, b, p, q);
  if (sign != 0) return sign;
  return leading_sign(exact_cross(exact_difference(q, p), exact_difference(b, a)));
}

int passage_of_edge(const Vec3& a, const Vec3& b, const Corners& triangle) {
  const int side_a = side_of_surface(triangle, a);
  if (side_a == side_of_surface(triangle, b)) return 0;
  for (std::size_t i = 0; i < 3; ++i)
    // From behind to the front, the triangle's sides turn to the left.
    if (turn_of_edges(a, b, triangle[i], triangle[(i + 1) % 3]) != -side_a) return 0;
  return -side_a;
}

int passage_of_surface_edge(const Vec3& p, const Vec3& q, const Corners& face) {
  const int side_p = side_of_face(face, p);
  if (side_p == side_of_face(face, q)) return 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (turn_of_edges(face[i], face[(i + 1) % 3], p, q) != -side_p) return 0;
  return -side_p;
}

bool is_passed_before(const Vec3& a, const Vec3& b, const Corners& first, const Corners& second) {
  const auto passage = [&](const Corners& t, double& place, double& error) {
    const Volume at_a = volume_of(t[0], t[1], t[2], a);
    const Volume at_b = volume_of(t[0], t[1], t[2], b);
    const double way = std::abs(at_a.value - at_b.value);
    const double bound = at_a.bound + at_b.bound;
    if (way <= 4.0 * bound) return false;
    place = std::abs(at_a.value) / way;
    error = 4.0 * bound / way;
    return true;
  };
  double place_1 = 0.0, place_2 = 0.0, error_1 = 0.0, error_2 = 0.0;
  if (passage(first, place_1, error_1) && passage(second, place_2, error_2) &&
      std::abs(place_1 - place_2) > error_1 + error_2 + 1e-15)
    return place_1 < place_2;
  const ExactPassage one = exact_passage(a, b, first);
  const ExactPassage two = exact_passage(a, b, second);
  for (std::size_t i = 0; i < 4; ++i) {
    const int sign = (one.numerators[i] * two.denominator - two.numerators[i] * one.denominator).sign();
    if (sign != 0) return sign < 0;
  }
  return false;
}

}  // namespace shatterbox::geometry
