// Signs and crossings of triangles against the same questions asked in fractions.
#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "engine/audit/exact_sign.h"
#include "engine/audit/triangle_crossing.h"
#include "engine/core/random.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;
using namespace shatterbox::audit;

namespace {

using Point = std::array<mpq_class, 3>;
using ExactTriangle = std::array<Point, 3>;

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
mpq_class dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point exact(const Vec3& v) {
  return {mpq_class(v.x()), mpq_class(v.y()), mpq_class(v.z())};
}
ExactTriangle exact(const Corners& t) {
  return {exact(t[0]), exact(t[1]), exact(t[2])};
}
Point normal_of(const ExactTriangle& t) {
  return cross(minus(t[1], t[0]), minus(t[2], t[0]));
}

/// The part of the polygon where inward . (x - on) >= 0.
std::vector<Point> clip(const std::vector<Point>& polygon, const Point& inward, const Point& on) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const mpq_class da = dot(inward, minus(a, on)), db = dot(inward, minus(b, on));
    if (da >= 0) kept.push_back(a);
    if (sgn(da) * sgn(db) < 0) {
      const mpq_class share = da / (da - db);
      Point p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + share * (b[k] - a[k]);
      kept.push_back(p);
    }
  }
  return kept;
}

/// Clips p by the three planes that stand on the edges of q: what is left of p seen along q's normal.
std::vector<Point> clip_by_edges(std::vector<Point> polygon, const ExactTriangle& q) {
  for (std::size_t i = 0; i < 3; ++i)
    polygon = clip(polygon, cross(normal_of(q), minus(q[(i + 1) % 3], q[i])), q[i]);
  return polygon;
}

bool cross_in_fractions(const Corners& first, const Corners& second) {
  const ExactTriangle p = exact(first), q = exact(second);
  const Point np = normal_of(p), nq = normal_of(q);
  if (dot(np, np) == 0 || dot(nq, nq) == 0) return false;
  const Point along = cross(np, nq);
  if (dot(along, along) == 0) {
    if (dot(np, minus(q[0], p[0])) != 0) return false;
    const auto common = clip_by_edges({p.begin(), p.end()}, q);
    Point area{};
    for (std::size_t i = 2; i < common.size(); ++i) {
      const Point part = cross(minus(common[i - 1], common[0]), minus(common[i], common[0]));
      for (std::size_t k = 0; k < 3; ++k) area[k] += part[k];
    }
    return dot(area, area) > 0;
  }
  // Each triangle's open part on the common line, as an interval of along . x.
  mpq_class low[2], high[2];
  for (int side = 0; side < 2; ++side) {
    const ExactTriangle& t = side == 0 ? p : q;
    const Point& n = side == 0 ? nq : np;
    const Point& on = side == 0 ? q[0] : p[0];
    int least = 1, greatest = -1;
    bool is_first = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const mpq_class da = dot(n, minus(t[i], on)), db = dot(n, minus(t[(i + 1) % 3], on));
      least = std::min(least, sgn(da));
      greatest = std::max(greatest, sgn(da));
      if (sgn(da) * sgn(db) > 0 || (da == 0 && db == 0)) continue;
      const mpq_class share = da / (da - db);
      mpq_class place = dot(along, t[i]) + share * dot(along, minus(t[(i + 1) % 3], t[i]));
      low[side] = is_first ? place : std::min(low[side], place);
      high[side] = is_first ? place : std::max(high[side], place);
      is_first = false;
    }
    if (least >= 0 || greatest <= 0) return false;
  }
  return std::max(low[0], low[1]) < std::min(high[0], high[1]);
}

Corners random_triangle(core::Random& random, int kind) {
  Corners t;
  for (Vec3& c : t)
    for (int k = 0; k < 3; ++k) {
      c[k] = random.uniform(-1.0, 1.0);
      if (kind == 1) c[k] = static_cast<double>(random.index(5)) - 2.0;
      if (kind == 2) c[k] = k == 1 ? 0.1 : 0.25 * static_cast<double>(random.index(9));
    }
  if (kind == 3)  // nearly in one plane
    for (Vec3& c : t) c.y() = 0.1 * c.x() + 0.3 * c.z() + 1e-17 * static_cast<double>(random.index(3));
  return t;
}

}  // namespace

TEST_CASE("audit: signs of volumes and areas are exact") {
  core::Random random(1);
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const double step = i % 2 == 0 ? 0x1p-52 : 0.25;
    const double offset = i % 4 < 2 ? 0.5 : 12345.0;
    std::array<Vec3, 4> x;
    for (Vec3& p : x)
      for (int k = 0; k < 3; ++k) p[k] = offset + step * static_cast<double>(random.index(4));
    const Point d = exact(x[3]);
    const mpq_class volume = dot(minus(exact(x[0]), d), cross(minus(exact(x[1]), d), minus(exact(x[2]), d)));
    const Vec2 a = x[0].head<2>(), b = x[1].head<2>(), c = x[2].head<2>();
    const auto e = [&](const Vec2& p, int k) { return mpq_class(p[k]); };
    const mpq_class area =
        (e(a, 0) - e(c, 0)) * (e(b, 1) - e(c, 1)) - (e(a, 1) - e(c, 1)) * (e(b, 0) - e(c, 0));
    zeros += volume == 0 ? 1 : 0;
    REQUIRE(volume_sign(x[0], x[1], x[2], x[3]) == sgn(volume));
    REQUIRE(area_sign(a, b, c) == sgn(area));
  }
  CHECK(zeros > 100);
}

TEST_CASE("audit: triangles cross if their insides share a point, against fractions") {
  core::Random random(2);
  std::array<int, 4> crossings{};
  const int pairs = static_cast<int>(test::how_many(40000, 8000));
  for (int i = 0; i < pairs; ++i) {
    const int kind = i % 4;
    const Corners p = random_triangle(random, kind), q = random_triangle(random, kind);
    const bool expected = cross_in_fractions(p, q);
    crossings[static_cast<std::size_t>(kind)] += expected ? 1 : 0;
    INFO("pair " << i);
    REQUIRE(triangles_cross(p, q) == expected);
    REQUIRE(triangles_cross(q, {p[2], p[1], p[0]}) == expected);
  }
  for (const int count : crossings) {
    CHECK(count > pairs / 80);
    CHECK(count < pairs / 4 - pairs / 80);
  }
}

TEST_CASE("audit: an edge in a triangle's plane is a hinge only where it runs through the inside") {
  const Corners p{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 0, 4)};
  CHECK(corner_off_hinge(p, {Vec3(1, 1, 1), Vec3(1, 0, 1), Vec3(2, 0, 1)}) == 0);
  CHECK(corner_off_hinge(p, {Vec3(1, 0, 1), Vec3(1, -1, 1), Vec3(9, 0, 1)}) == 1);
  CHECK(corner_off_hinge(p, {Vec3(1, 1, 1), Vec3(1, 0, 0), Vec3(2, 0, 0)}) == -1);  // on the edge
  CHECK(corner_off_hinge(p, {Vec3(1, 1, 1), Vec3(5, 0, 1), Vec3(6, 0, 1)}) == -1);  // beside it
  CHECK(corner_off_hinge(p, {Vec3(1, 1, 1), Vec3(1, 0, 1), Vec3(1, 2, 1)}) == -1);  // one corner touches
}
