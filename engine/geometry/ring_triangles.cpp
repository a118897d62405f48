#include "engine/geometry/ring_triangles.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/core/index.h"
#include "engine/geometry/plane_lines.h"

namespace shatterbox::geometry {
namespace {

using Size = std::size_t;
using core::at;

constexpr double kFlatEar = 1e-12;  // of the squared lengths: an ear below that has no area

/// An ear, and how good it is: those that hold no other corner first, then by shape.
struct Ear {
  int rank = -1;
  double shape = 0.0;
};

Ear judge_ear(const std::vector<Vec2>& points, const std::vector<int>& ring, Size i) {
  const Size n = ring.size();
  const Vec2& a = points[at(ring[(i + n - 1) % n])];
  const Vec2& b = points[at(ring[i])];
  const Vec2& c = points[at(ring[(i + 1) % n])];
  const double area = turn(a, b, c);
  const double lengths = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  Ear ear{1, lengths > 0.0 ? area / lengths : 0.0};
  if (!(ear.shape > kFlatEar)) {
    ear.rank = 0;
    return ear;
  }
  ear.rank = 2;
  for (Size k = (i + 2) % n; k != (i + n - 1) % n; k = (k + 1) % n) {
    const Vec2& p = points[at(ring[k])];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) {
      ear.rank = 1;
      break;
    }
  }
  return ear;
}

double shape_of(const std::vector<Vec2>& points, int i, int j, int k) {
  const Vec2& a = points[at(i)];
  const Vec2& b = points[at(j)];
  const Vec2& c = points[at(k)];
  const double lengths = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return lengths > 0.0 ? turn(a, b, c) / lengths : 0.0;
}

/// Replaces the diagonal of two triangles by the other one where that makes the worse of them better, until
/// none does.
void flip_diagonals(const std::vector<Vec2>& points, std::vector<Triangle>& triangles) {
  bool has_changed = true;
  for (Size round = 0; has_changed && round < 2 * points.size(); ++round) {
    has_changed = false;
    for (Size s = 0; s < triangles.size(); ++s)
      for (Size t = s + 1; t < triangles.size(); ++t)
        for (Size i = 0; i < 3; ++i)
          for (Size j = 0; j < 3; ++j) {
            // Triangle s is a, b, c; triangle t is b, a, d.
            const int a = triangles[s][i], b = triangles[s][(i + 1) % 3], c = triangles[s][(i + 2) % 3];
            if (triangles[t][j] != b || triangles[t][(j + 1) % 3] != a) continue;
            const int d = triangles[t][(j + 2) % 3];
            const double before = std::min(shape_of(points, a, b, c), shape_of(points, b, a, d));
            const double after = std::min(shape_of(points, a, d, c), shape_of(points, d, b, c));
            if (!(after > before * (1.0 + 1e-9) + kFlatEar)) continue;
            triangles[s] = {a, d, c};
            triangles[t] = {d, b, c};
            has_changed = true;
          }
  }
}

}  // namespace

double twice_area(const std::vector<Vec2>& loop) {
  double sum = 0.0;
  for (Size i = 1; i + 1 < loop.size(); ++i) sum += turn(loop[0], loop[i], loop[i + 1]);
  return sum;
}

bool is_inside(const std::vector<Vec2>& loop, const Vec2& p) {
  bool is_odd = false;
  for (Size i = 0; i < loop.size(); ++i) {
    const Vec2& a = loop[i];
    const Vec2& b = loop[(i + 1) % loop.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if ((turn(a, b, p) > 0.0) == (b.y() > a.y())) is_odd = !is_odd;
  }
  return is_odd;
}

std::vector<Triangle> triangulate_ring(const std::vector<Vec2>& points) {
  std::vector<Triangle> triangles;
  std::vector<int> ring(points.size());
  std::iota(ring.begin(), ring.end(), 0);
  std::vector<Ear> ears(ring.size());
  for (Size i = 0; i < ring.size(); ++i) ears[i] = judge_ear(points, ring, i);
  double left = twice_area(points);
  const double least_left = kFlatEar * left;
  while (ring.size() >= 3) {
    const Size n = ring.size();
    const auto area = [&](Size i) {
      return turn(points[at(ring[(i + n - 1) % n])], points[at(ring[i])], points[at(ring[(i + 1) % n])]);
    };
    // Not one that leaves only a line behind.
    const auto rank = [&](Size i) {
      return n > 3 && ears[i].rank > 0 && left - area(i) <= least_left ? 0 : ears[i].rank;
    };
    Size best = 0;
    for (Size i = 1; i < n; ++i)
      if (rank(i) != rank(best) ? rank(i) > rank(best) : ears[i].shape > ears[best].shape) best = i;
    left -= area(best);
    triangles.push_back({ring[(best + n - 1) % n], ring[best], ring[(best + 1) % n]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
    ears.erase(ears.begin() + static_cast<std::ptrdiff_t>(best));
    if (ring.size() < 3) break;
    for (const Size i : {best % ring.size(), (best + ring.size() - 1) % ring.size()})
      ears[i] = judge_ear(points, ring, i);
    // A clipped corner may have been what was in another ear's way.
    for (Size i = 0; i < ring.size(); ++i)
      if (ears[i].rank == 1) ears[i] = judge_ear(points, ring, i);
  }
  flip_diagonals(points, triangles);
  return triangles;
}

std::vector<std::array<int, 2>> join_holes(const std::vector<std::vector<Vec2>>& loops) {
  std::vector<std::array<int, 2>> ring;
  for (Size i = 0; i < loops[0].size(); ++i) ring.push_back({0, static_cast<int>(i)});
  const auto point = [&loops](const std::array<int, 2>& p) -> const Vec2& {
    return loops[at(p[0])][at(p[1])];
  };
  std::vector<char> is_joined(loops.size(), 0);
  const auto is_free = [&](const Vec2& a, const Vec2& b) {
    for (Size i = 0; i < ring.size(); ++i)
      if (do_cross(a, b, point(ring[i]), point(ring[(i + 1) % ring.size()]))) return false;
    for (Size l = 1; l < loops.size(); ++l)
      for (Size i = 0; i < loops[l].size() && !is_joined[l]; ++i)
        if (do_cross(a, b, loops[l][i], loops[l][(i + 1) % loops[l].size()])) return false;
    return true;
  };
  for (Size joined = 1; joined < loops.size(); ++joined) {
    // The shortest bridge that crosses nothing; if there is none, the shortest.
    Size best_loop = 0, best_place = 0, best_ring = 0;
    bool is_best_free = false;
    double least = std::numeric_limits<double>::max();
    for (Size l = 1; l < loops.size(); ++l)
      for (Size i = 0; i < loops[l].size() && !is_joined[l]; ++i)
        for (Size r = 0; r < ring.size(); ++r) {
          const double distance = (loops[l][i] - point(ring[r])).squaredNorm();
          if (is_best_free && distance >= least) continue;
          const bool is_bridge_free = is_free(loops[l][i], point(ring[r]));
          if (best_loop != 0 && (is_best_free != is_bridge_free ? is_best_free : distance >= least)) continue;
          best_loop = l, best_place = i, best_ring = r;
          is_best_free = is_bridge_free;
          least = distance;
        }
    is_joined[best_loop] = 1;
    const std::array<int, 2> from = ring[best_ring];
    std::vector<std::array<int, 2>> detour;
    for (Size i = 0; i <= loops[best_loop].size(); ++i)
      detour.push_back(
          {static_cast<int>(best_loop), static_cast<int>((best_place + i) % loops[best_loop].size())});
    detour.push_back(from);
    ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(best_ring) + 1, detour.begin(), detour.end());
  }
  return ring;
}

}  // namespace shatterbox::geometry
