#include "tests/support/exact_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shatterbox::test {
namespace {

using Path = std::array<Polynomial, 3>;  // coordinates over time

Path operator-(const Path& a, const Path& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Path cross(const Path& a, const Path& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Polynomial dot(const Path& a, const Path& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The paths in whole numbers of a common unit.
std::array<Path, 4> whole_paths(const Motion& motion) {
  unsigned power = 0;
  const auto dyadic = [](double x) {
    Dyadic d = dyadic_of(std::abs(x));
    if (x < 0.0) d.numerator = -d.numerator;
    return d;
  };
  for (const auto* points : {&motion.start, &motion.end})
    for (const auto& point : *points)
      for (const double x : point)
        if (x != 0.0) power = std::max(power, dyadic(x).power);
  const auto whole = [&](double x) -> mpz_class {
    if (x == 0.0) return 0;
    const Dyadic d = dyadic(x);
    return d.numerator << (power - d.power);
  };
  std::array<Path, 4> paths;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const mpz_class start = whole(motion.start[i][k]), end = whole(motion.end[i][k]);
      paths[i][k] = Polynomial({start, mpz_class(end - start)});
    }
  return paths;
}

class Oracle {
 public:
  explicit Oracle(const Motion& motion) : is_edge_edge_(motion.is_edge_edge), x_(whole_paths(motion)) {}

  std::vector<Root> contact_times() {
    const Polynomial volume = dot(x_[1] - x_[0], cross(x_[2] - x_[0], x_[3] - x_[0]));
    std::vector<Root> times;
    if (!volume.is_zero()) {
      for (Root& root : roots_in_unit_interval(volume))
        if (touches(root)) times.push_back(std::move(root));
      return times;
    }
    // In one plane at all times: they touch from the start, or an end first comes onto a segment.
    Root start{Polynomial({0, 1}), {0, 0}, {0, 0}, true};
    if (touches(start)) return {start};
    for (const auto& [p, a, b] : ends_and_segments()) append_meetings(p, a, b, times);
    return times;
  }

 private:
  using Triple = std::array<std::size_t, 3>;

  std::vector<Triple> ends_and_segments() const {
    if (is_edge_edge_) return {{0, 2, 3}, {1, 2, 3}, {2, 0, 1}, {3, 0, 1}};
    return {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  }

  /// Where the four points lie in one plane: do the features share a point?
  bool touches(Root& time) {
    const Path normal =
        is_edge_edge_ ? cross(x_[1] - x_[0], x_[3] - x_[2]) : cross(x_[2] - x_[1], x_[3] - x_[1]);
    const bool has_normal = std::any_of(normal.begin(), normal.end(),
                                        [&](const Polynomial& c) { return sign_at_root(c, time) != 0; });
    if (has_normal) return is_edge_edge_ ? edges_cross(normal, time) : is_inside(normal, time);
    for (const auto& [p, a, b] : ends_and_segments()) {
      const Path across = cross(x_[p] - x_[a], x_[b] - x_[a]);
      const bool is_on_line = std::all_of(across.begin(), across.end(),
                                          [&](const Polynomial& c) { return sign_at_root(c, time) == 0; });
      if (is_on_line && is_between(p, a, b, time)) return true;
    }
    return false;
  }

  /// Of a point on the line through a and b (or on a, where b is the same point).
  bool is_between(std::size_t p, std::size_t a, std::size_t b, Root& time) {
    return sign_at_root(dot(x_[p] - x_[a], x_[p] - x_[b]), time) <= 0;
  }

  int turn(std::size_t a, std::size_t b, std::size_t p, const Path& normal, Root& time) {
    return sign_at_root(dot(cross(x_[b] - x_[a], x_[p] - x_[a]), normal), time);
  }

  bool is_inside(const Path& normal, Root& time) {
    return turn(1, 2, 0, normal, time) >= 0 && turn(2, 3, 0, normal, time) >= 0 &&
           turn(3, 1, 0, normal, time) >= 0;
  }

  bool edges_cross(const Path& normal, Root& time) {
    return turn(0, 1, 2, normal, time) * turn(0, 1, 3, normal, time) <= 0 &&
           turn(2, 3, 0, normal, time) * turn(2, 3, 1, normal, time) <= 0;
  }

  void append_meetings(std::size_t p, std::size_t a, std::size_t b, std::vector<Root>& times) {
    const Path across = cross(x_[p] - x_[a], x_[b] - x_[a]);
    Polynomial common;
    for (const Polynomial& c : across) common = greatest_common_divisor(common, c);
    // On one line at all times: the meeting begins where the point passes an end of the segment.
    if (common.is_zero()) common = dot(x_[p] - x_[a], x_[p] - x_[b]);
    if (common.is_zero()) return;  // on an end at all times: found at the start
    for (Root& root : roots_in_unit_interval(common))
      if (is_between(p, a, b, root)) times.push_back(std::move(root));
  }

  bool is_edge_edge_;
  std::array<Path, 4> x_;
};

using Point = std::array<mpq_class, 3>;

Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
mpq_class dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

mpq_class point_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point along = b - a, from = p - a;
  const mpq_class length = dot(along, along), share = dot(from, along);
  if (share <= 0 || length == 0) return dot(from, from);
  if (share >= length) return dot(p - b, p - b);
  return dot(from, from) - share * share / length;
}

mpq_class squared_distance(bool is_edge_edge, const std::array<Point, 4>& x) {
  const Point normal = is_edge_edge ? cross(x[1] - x[0], x[3] - x[2]) : cross(x[2] - x[1], x[3] - x[1]);
  const mpq_class size = dot(normal, normal);
  if (size > 0) {
    const Point across = x[2] - x[0];
    const auto turn = [&](const Point& a, const Point& b, const Point& p) {
      return sgn(dot(cross(b - a, p - a), normal));
    };
    const bool is_over = is_edge_edge ? turn(x[0], x[1], x[2]) * turn(x[0], x[1], x[3]) <= 0 &&
                                            turn(x[2], x[3], x[0]) * turn(x[2], x[3], x[1]) <= 0
                                      : turn(x[1], x[2], x[0]) >= 0 && turn(x[2], x[3], x[0]) >= 0 &&
                                            turn(x[3], x[1], x[0]) >= 0;
    const mpq_class height = dot(across, normal);
    if (is_over) return height * height / size;
  }
  if (is_edge_edge)
    return std::min(std::min(point_to_segment(x[0], x[2], x[3]), point_to_segment(x[1], x[2], x[3])),
                    std::min(point_to_segment(x[2], x[0], x[1]), point_to_segment(x[3], x[0], x[1])));
  return std::min(point_to_segment(x[0], x[1], x[2]),
                  std::min(point_to_segment(x[0], x[2], x[3]), point_to_segment(x[0], x[3], x[1])));
}

}  // namespace

std::vector<Root> contact_times(const Motion& motion) {
  return Oracle(motion).contact_times();
}

bool is_within(const Motion& motion, double time, double least) {
  std::array<Point, 4> points;
  const mpq_class t(time), distance(least);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const mpq_class start(motion.start[i][k]), end(motion.end[i][k]);
      points[i][k] = start + t * (end - start);
    }
  return squared_distance(motion.is_edge_edge, points) <= distance * distance;
}

}  // namespace shatterbox::test
