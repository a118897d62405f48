#include "sandbox/study/shard_corners.h"

#include <algorithm>
#include <map>
#include <vector>

#include "engine/core/index.h"

namespace shatterbox::sandbox::study {
namespace {

using core::at;
using Line = std::vector<Vec3>;

/// Edges with one triangle, each from its begin to its end as the triangle goes round.
std::map<int, int> border_of(const geometry::TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> sides;
  for (const geometry::Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++sides[std::minmax(t[i], t[(i + 1) % 3])];
  std::map<int, int> next;
  for (const geometry::Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (sides[std::minmax(t[i], t[(i + 1) % 3])] == 1) next[t[i]] = t[(i + 1) % 3];
  return next;
}

double length_of(const Line& loop) {
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i) length += (loop[(i + 1) % loop.size()] - loop[i]).norm();
  return length;
}

Line longest_loop(const geometry::TriangleMesh& mesh) {
  std::map<int, int> next = border_of(mesh);
  Line longest;
  while (!next.empty()) {
    Line loop;
    for (auto here = next.begin(); here != next.end();) {
      loop.push_back(mesh.positions[at(here->first)]);
      const int to = here->second;
      next.erase(here);
      here = next.find(to);
    }
    if (length_of(loop) > length_of(longest)) longest = std::move(loop);
  }
  return longest;
}

double distance_to_line(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double squared = along.squaredNorm();
  const double share = squared > 0.0 ? std::clamp((point - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (point - a - share * along).norm();
}

/// Adds the corners strictly between two points of a line, by halving it at what is farthest from the
/// straight way.
void add_corners_between(const Line& line, std::size_t from, std::size_t to, double tolerance,
                         Line& corners) {
  std::size_t farthest = from;
  double most = tolerance;
  for (std::size_t i = from + 1; i < to; ++i) {
    const double distance = distance_to_line(line[i], line[from], line[to]);
    if (distance > most) {
      most = distance;
      farthest = i;
    }
  }
  if (farthest == from) return;
  add_corners_between(line, from, farthest, tolerance, corners);
  corners.push_back(line[farthest]);
  add_corners_between(line, farthest, to, tolerance, corners);
}

/// Drops what is no corner: where the halving had to begin, that was not known.
void drop_straight(Line& corners, double tolerance) {
  for (std::size_t i = 0; corners.size() > 3 && i < corners.size();) {
    const std::size_t count = corners.size();
    const Vec3 &before = corners[(i + count - 1) % count], &after = corners[(i + 1) % count];
    if (distance_to_line(corners[i], before, after) > tolerance) {
      ++i;
    } else {
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
  }
}

}  // namespace

int count_corners(const geometry::TriangleMesh& shard, double tolerance) {
  Line loop = longest_loop(shard);
  if (loop.size() < 3) return 0;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : loop) middle += p / static_cast<double>(loop.size());
  const auto farthest_from = [&](const Vec3& place) {
    return std::max_element(loop.begin(), loop.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - place).squaredNorm() < (b - place).squaredNorm();
    });
  };
  std::rotate(loop.begin(), farthest_from(middle), loop.end());
  const auto other = static_cast<std::size_t>(farthest_from(loop.front()) - loop.begin());
  loop.push_back(loop.front());
  Line corners{loop.front()};
  add_corners_between(loop, 0, other, tolerance, corners);
  corners.push_back(loop[other]);
  add_corners_between(loop, other, loop.size() - 1, tolerance, corners);
  drop_straight(corners, tolerance);
  return static_cast<int>(corners.size());
}

}  // namespace shatterbox::sandbox::study
