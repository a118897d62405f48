#include "engine/geometry/moving_plane.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/random.h"
#include "engine/geometry/closest_points.h"

namespace shatterbox::geometry {
namespace {

using Points = std::array<Vec3, 4>;

Vec3 draw_vector(core::Random& random) {
  const double x = random.uniform(-1, 1);
  const double y = random.uniform(-1, 1);
  const double z = random.uniform(-1, 1);
  return {x, y, z};
}

double distance(const Points& p, bool is_edge_edge) {
  return is_edge_edge ? closest_between_segments(p[0], p[1], p[2], p[3]).distance
                      : closest_on_triangle(p[0], p[1], p[2], p[3]).distance;
}

Vec3 direction(const Points& p, bool is_edge_edge) {
  if (is_edge_edge) {
    const auto c = closest_between_segments(p[0], p[1], p[2], p[3]);
    return c.on_p - c.on_q;
  }
  return p[0] - closest_on_triangle(p[0], p[1], p[2], p[3]).closest;
}

double least_distance(const Points& start, const Points& end, bool is_edge_edge) {
  double least = 1e300;
  for (int k = 0; k <= 200; ++k) {
    const double t = k / 200.0;
    Points now;
    for (std::size_t i = 0; i < 4; ++i) now[i] = (1.0 - t) * start[i] + t * end[i];
    least = std::min(least, distance(now, is_edge_edge));
  }
  return least;
}

}  // namespace

TEST_CASE("features are never told to stay further apart than they do") {
  core::Random random(3);
  int told = 0;
  for (int n = 0; n < 4000; ++n) {
    const bool is_edge_edge = n % 2 == 0;
    const double shake = std::ldexp(1.0, -(n % 12));
    Points start, end;
    for (std::size_t i = 0; i < 4; ++i) {
      start[i] = draw_vector(random);
      end[i] = start[i] + shake * draw_vector(random);
    }
    const double least = separation_by_moving_plane(start, end, is_edge_edge, direction(start, is_edge_edge));
    CHECK(least >= 0.0);
    CHECK(least <= least_distance(start, end, is_edge_edge) + 1e-14);
    told += least > 0.0 ? 1 : 0;
  }
  CHECK(told > 1500);
}

TEST_CASE("what turns together keeps its gap, however small, and however far away it does") {
  core::Random random(5);
  for (int n = 0; n < 600; ++n) {
    const bool is_edge_edge = n % 2 == 0;
    const double far = n % 3 == 0 ? 100.0 : 1.0, gap = n % 3 == 0 ? 1e-9 : 1e-11;
    // Across each other, above each other, or above an edge or a corner, the gap apart along y.
    const double x = n % 5 == 0 ? 1.0 : 0.0, z = n % 7 == 0 ? -1.0 : 0.0;
    Points start = is_edge_edge
                       ? Points{Vec3(-1, gap, 0), Vec3(1, gap, 0), Vec3(-x, 0, x - 1), Vec3(x, 0, 1 - x)}
                       : Points{Vec3(x, gap, z), Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, 0, 2)};
    const Quat turned(Eigen::AngleAxisd(3.0 * random.uniform(), draw_vector(random).normalized()));
    const Quat turn(Eigen::AngleAxisd(0.5 * random.uniform(), draw_vector(random).normalized()));
    const Vec3 place = far * draw_vector(random), way = draw_vector(random);
    Points end;
    for (std::size_t i = 0; i < 4; ++i) {
      start[i] = turned * start[i] + place;
      end[i] = turn * (start[i] - place) + place + way;
    }
    const double least = separation_by_moving_plane(start, end, is_edge_edge, turned * Vec3::UnitY());
    CHECK(least > 0.8 * gap);
    CHECK(least < 1.2 * gap);
  }
}

TEST_CASE("features without a plane are told apart about an edge, and points not at all") {
  const Points line{Vec3(0, 1, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)};
  CHECK(separation_by_moving_plane(line, line, false, Vec3::UnitY()) == Approx(1.0));
  const Points parallel{Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  CHECK(separation_by_moving_plane(parallel, parallel, true, Vec3::UnitY()) == Approx(1.0));
  const Points points{Vec3(0, 1, 0), Vec3(0, 1, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
  CHECK(separation_by_moving_plane(points, points, true, Vec3::UnitY()) == 0.0);
}

}  // namespace shatterbox::geometry
