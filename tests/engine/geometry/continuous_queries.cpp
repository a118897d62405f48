#include "tests/engine/geometry/continuous_queries.h"

#include <cmath>

#include "engine/core/random.h"
#include "engine/core/vec.h"

namespace shatterbox::test {
namespace {

using core::Random;
using Points = std::array<Vec3, 4>;

Vec3 random_vector(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

Points random_points(Random& random, double size) {
  Points points;
  for (Vec3& p : points) p = random_vector(random, size);
  return points;
}

double power_of_ten(Random& random, int low, int high) {
  const int exponent = low + static_cast<int>(random.index(static_cast<std::uint64_t>(high - low + 1)));
  return std::pow(10.0, exponent) * random.uniform(0.2, 1.0);
}

/// A point of the second feature by random weights, now and then on its border.
Vec3 point_on_second(Random& random, const Points& x, bool is_edge_edge) {
  double u = random.uniform(), v = random.uniform();
  if (random.index(4) == 0) u = 0.0;
  if (random.index(8) == 0) v = random.index(2) == 0 ? 0.0 : 1.0;
  if (is_edge_edge) return x[2] + v * (x[3] - x[2]);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return x[1] + u * (x[2] - x[1]) + v * (x[3] - x[1]);
}

/// Moves the first feature so that it lies `offset` away from the second one.
void bring_near(Random& random, Points& x, bool is_edge_edge, const Vec3& offset) {
  const Vec3 target = point_on_second(random, x, is_edge_edge) + offset;
  if (!is_edge_edge) {
    x[0] = target;
    return;
  }
  const Vec3 on_first = x[0] + random.uniform() * (x[1] - x[0]);
  const Vec3 shift = target - on_first;
  x[0] += shift;
  x[1] += shift;
}

Vec3 across_of(const Points& x, bool is_edge_edge) {
  const Vec3 n = is_edge_edge ? (x[1] - x[0]).cross(x[3] - x[2]) : (x[2] - x[1]).cross(x[3] - x[1]);
  return n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3::UnitZ();
}

/// Both ends of straight paths that pass through `middle` at `time`, at the velocities `way`.
void spread_in_time(const Points& middle, const Points& way, double time, Points& start, Points& end) {
  for (std::size_t i = 0; i < 4; ++i) {
    start[i] = middle[i] - time * way[i];
    end[i] = middle[i] + (1.0 - time) * way[i];
  }
}

void on_lattice(Random& random, Points& x) {
  for (Vec3& p : x)
    for (int k = 0; k < 3; ++k) p[k] = 0.5 * static_cast<double>(random.index(5)) - 1.0;
}

void in_one_plane(Random& random, Points& start, Points& end) {
  const bool is_lattice = random.index(2) == 0;
  const Vec3 tilt(static_cast<double>(random.index(3)), 1.0, static_cast<double>(random.index(3)));
  for (Points* x : {&start, &end}) {
    for (Vec3& p : *x) {
      double u = random.uniform(-1.0, 1.0), v = random.uniform(-1.0, 1.0);
      if (is_lattice) {
        u = std::floor(4.0 * u) / 4.0;
        v = std::floor(4.0 * v) / 4.0;
      } else {  // few digits, so that the plane is met exactly
        u = std::floor(0x1p20 * u) * 0x1p-20;
        v = std::floor(0x1p20 * v) * 0x1p-20;
      }
      p = Vec3(u, tilt.x() * u + tilt.z() * v, v);
    }
  }
}

void parallel_edges(Random& random, bool is_edge_edge, Points& start, Points& end) {
  start = random_points(random, 1.0);
  const Vec3 along = start[3] - start[2];
  if (is_edge_edge) start[1] = start[0] + random.uniform(0.5, 2.0) * along;
  const double gap = random.index(2) == 0 ? 0.0 : power_of_ten(random, -15, -3);
  bring_near(random, start, is_edge_edge, gap * random_vector(random, 1.0));
  const Vec3 way = random_vector(random, 1.0), other_way = random_vector(random, 1e-6);
  end = start;
  for (std::size_t i = 0; i < (is_edge_edge ? 2U : 1U); ++i) end[i] += random.index(2) == 0 ? way : other_way;
  if (random.index(3) == 0) end[0] += 0.3 * along;
}

void sliding(Random& random, bool is_edge_edge, Points& start, Points& end) {
  start = random_points(random, 1.0);
  const Vec3 normal = across_of(start, is_edge_edge);
  const double height = random.index(3) == 0 ? 0.0 : power_of_ten(random, -16, -4);
  bring_near(random, start, is_edge_edge, height * normal);
  Vec3 way = random_vector(random, 1.0);
  way -= way.dot(normal) * normal;
  const double sink = random.index(2) == 0 ? 0.0 : power_of_ten(random, -16, -4) * random.uniform(-1.0, 1.0);
  end = start;
  for (std::size_t i = 0; i < (is_edge_edge ? 2U : 1U); ++i) end[i] += way + sink * normal;
}

void passing(Random& random, bool is_edge_edge, double size, double speed, double gap, Points& start,
             Points& end) {
  Points middle = random_points(random, size), way = random_points(random, speed);
  bring_near(random, middle, is_edge_edge, gap * across_of(middle, is_edge_edge));
  spread_in_time(middle, way, random.uniform(), start, end);
}

void turning(Random& random, bool is_edge_edge, Points& start, Points& end) {
  start = random_points(random, 1.0);
  bring_near(random, start, is_edge_edge, power_of_ten(random, -12, 0) * random_vector(random, 1.0));
  const double angle = random.uniform(-1.5, 1.5);
  const Vec3 axis = random_vector(random, 1.0).normalized();
  const Quat turn(Eigen::AngleAxisd(angle, axis));
  const Vec3 shift = random_vector(random, 0.2);
  end = start;
  for (std::size_t i = is_edge_edge ? 2U : 1U; i < 4; ++i) end[i] = turn * start[i] + shift;
}

void degenerate(Random& random, bool is_edge_edge, Points& start, Points& end) {
  turning(random, is_edge_edge, start, end);
  switch (random.index(4)) {
    case 0:
      start[3] = start[2];
      end[3] = end[2];
      break;
    case 1:
      start[1] = start[0];
      end[1] = end[0];
      break;
    case 2:
      start[3] = 0.5 * (start[1] + start[2]);
      break;
    default:
      end[3] = end[2] + 1e-9 * (end[1] - end[2]);
  }
}

}  // namespace

Motion make_query(std::uint64_t seed, std::uint64_t number) {
  Random random(seed, number);
  const bool is_edge_edge = random.index(2) == 0;
  Points start = random_points(random, 1.0), end = random_points(random, 1.0);
  std::uint64_t kind = number % kQueryKinds.size();
  const bool is_far = kind == 7;
  if (is_far) kind = std::array<std::uint64_t, 5>{0, 3, 4, 5, 6}[random.index(5)];
  switch (kind) {
    case 1:
      on_lattice(random, start);
      on_lattice(random, end);
      break;
    case 2:
      in_one_plane(random, start, end);
      break;
    case 3:
      parallel_edges(random, is_edge_edge, start, end);
      break;
    case 4:
      sliding(random, is_edge_edge, start, end);
      break;
    case 5:
      passing(random, is_edge_edge, 1.0, power_of_ten(random, -9, 0), power_of_ten(random, -16, -6), start,
              end);
      break;
    case 6:  // within 1/60 s
      passing(random, is_edge_edge, 0.05, 1000.0 / 60.0, power_of_ten(random, -14, -1), start, end);
      break;
    case 8:
      turning(random, is_edge_edge, start, end);
      break;
    case 9:
      degenerate(random, is_edge_edge, start, end);
      break;
    default:
      break;
  }
  const double scale = random.index(3) == 0 ? power_of_ten(random, -7, 7) : 1.0;
  Vec3 shift = Vec3::Zero();
  if (is_far) shift = random_vector(random, scale * power_of_ten(random, 2, 9));
  Motion motion;
  motion.is_edge_edge = is_edge_edge;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      motion.start[i][k] = scale * start[i][axis] + shift[axis];
      motion.end[i][k] = scale * end[i][axis] + shift[axis];
    }
  return motion;
}

}  // namespace shatterbox::test
