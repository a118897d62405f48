#include "engine/geometry/flat_regions.h"

#include <catch2/catch.hpp>
#include <map>

#include "engine/core/elementary.h"
#include "engine/core/random.h"

using namespace shatterbox;
using namespace shatterbox::geometry;

namespace {

using Loops = std::vector<std::vector<int>>;

double area(const std::vector<Vec3>& p, const std::vector<int>& polygon) {
  double sum = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const auto at = [&](std::size_t k) { return p[static_cast<std::size_t>(polygon[k])]; };
    sum += 0.5 * (at(i - 1) - at(0)).cross(at(i) - at(0)).z();
  }
  return sum;
}

/// Sides of the polygons less those of the loops; zero for all if what was closed stays closed.
bool are_sides_kept(const Loops& loops, const Loops& polygons) {
  std::map<std::pair<int, int>, int> count;
  const auto add = [&](const Loops& all, int sign) {
    for (const auto& polygon : all)
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const int a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        count[{std::min(a, b), std::max(a, b)}] += a < b ? sign : -sign;
      }
  };
  add(polygons, 1);
  add(loops, -1);
  for (const auto& [side, sum] : count)
    if (sum != 0) return false;
  return true;
}

/// A ring of points about a place, of radii drawn at random; appended to `positions`.
std::vector<int> add_ring(std::vector<Vec3>& positions, double x, double y, double least, double most, int n,
                          bool is_hole, core::Random& random) {
  std::vector<int> ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * core::kPi * (is_hole ? n - i : i) / n;
    const double radius = least + (most - least) * random.uniform();
    ring.push_back(static_cast<int>(positions.size()));
    positions.emplace_back(x + radius * core::cos(angle), y + radius * core::sin(angle), 0.0);
  }
  return ring;
}

}  // namespace

TEST_CASE("flat regions: a convex one stays whole, others become convex polygons of the same area") {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.7, 0.3, 0}};
  CHECK(divide_flat_region(square, {{0, 1, 2, 3}}, Vec3::UnitZ()).size() == 1);
  const Loops notched = divide_flat_region(square, {{0, 1, 2, 4}}, Vec3::UnitZ());
  CHECK(notched.size() == 2);
  CHECK(are_sides_kept({{0, 1, 2, 4}}, notched));
}

TEST_CASE("flat regions: stars with holes, islands in the holes, in any place") {
  core::Random random(7, 8);
  for (int run = 0; run < 200; ++run) {
    std::vector<Vec3> positions;
    Loops loops{add_ring(positions, 0, 0, 2, 4, 40, false, random)};
    loops.push_back(add_ring(positions, 0.9, 0.9, 0.2, 0.4, 7, true, random));
    loops.push_back(add_ring(positions, -0.9, 0.9, 0.5, 0.6, 12, true, random));
    loops.push_back(add_ring(positions, -0.9, -0.9, 0.1, 0.6, 9, true, random));
    loops.push_back(add_ring(positions, -0.9, 0.9, 0.1, 0.4, 5, false, random));
    loops.push_back(add_ring(positions, 9.0, 1.0, 0.1, 0.4, 5, false, random));
    double wanted = 0.0;
    for (const auto& loop : loops) wanted += area(positions, loop);
    const Loops polygons = divide_flat_region(positions, loops, Vec3::UnitZ());
    double sum = 0.0;
    for (const auto& polygon : polygons) {
      CHECK(area(positions, polygon) > 0.0);
      sum += area(positions, polygon);
    }
    CHECK(sum == Approx(wanted).epsilon(1e-12));
    CHECK(are_sides_kept(loops, polygons));
  }
}

TEST_CASE("flat regions: what is closed stays closed whatever the positions") {
  core::Random random(9, 10);
  for (int run = 0; run < 200; ++run) {
    std::vector<Vec3> positions;
    for (int i = 0; i < 14; ++i) {  // few places, all mixed up
      const double x = static_cast<int>(random.uniform() * 3.0);
      const double y = static_cast<int>(random.uniform() * 3.0);
      positions.emplace_back(x, y, 0.0);
    }
    const Loops loops{{0, 1, 2, 3, 4, 5}, {6, 7, 8, 9}, {10, 11, 12, 13}};
    CHECK(are_sides_kept(loops, divide_flat_region(positions, loops, Vec3::UnitZ())));
  }
}
