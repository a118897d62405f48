// Edges of which contact need not know: flat ones and notches.
#include "engine/collision/exposed_edges.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <utility>

#include "engine/collision/feature_gap.h"
#include "engine/core/index.h"
#include "engine/core/random.h"

namespace shatterbox::collision {
namespace {

using core::at;
using Polygon = std::vector<std::pair<double, double>>;

// A polygon, counter-clockwise, from z = 0 to 1; its ends are a fan about the first corner, which sees all.
body::Shape make_prism(const Polygon& polygon) {
  body::Shape shape;
  shape.kind = body::ShapeKind::solid;
  const int n = static_cast<int>(polygon.size());
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : polygon) shape.surface.positions.push_back({x, y, z});
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    shape.surface.triangles.push_back({i, j, n + j});
    shape.surface.triangles.push_back({i, n + j, n + i});
    if (i == 0 || j == 0) continue;
    shape.surface.triangles.push_back({0, j, i});
    shape.surface.triangles.push_back({n, n + i, n + j});
  }
  return shape;
}

// Round about its middle, but rough.
body::Shape make_stone(core::Random& random) {
  body::Shape shape;
  shape.kind = body::ShapeKind::solid;
  constexpr int kRings = 7, kSides = 9;
  const auto add = [&](double polar, double turn) {
    const Vec3 out(std::sin(polar) * std::cos(turn), std::cos(polar), std::sin(polar) * std::sin(turn));
    shape.surface.positions.push_back(random.uniform(0.7, 1.0) * out);
  };
  add(0.0, 0.0);
  add(M_PI, 0.0);
  for (int ring = 1; ring < kRings; ++ring)
    for (int side = 0; side < kSides; ++side) add(ring * M_PI / kRings, side * 2.0 * M_PI / kSides);
  for (int side = 0; side < kSides; ++side) {
    const auto number = [&](int ring, int k) { return 2 + (ring - 1) * kSides + (side + k) % kSides; };
    shape.surface.triangles.push_back({0, number(1, 1), number(1, 0)});
    shape.surface.triangles.push_back({1, number(kRings - 1, 0), number(kRings - 1, 1)});
    for (int ring = 1; ring + 1 < kRings; ++ring) {
      shape.surface.triangles.push_back({number(ring, 0), number(ring, 1), number(ring + 1, 1)});
      shape.surface.triangles.push_back({number(ring, 0), number(ring + 1, 1), number(ring + 1, 0)});
    }
  }
  return shape;
}

body::Shape make_flat_sheet() {
  body::Shape shape;
  shape.kind = body::ShapeKind::shell;
  for (const double x : {-1.0, 0.3, 1.0})
    for (const double z : {-1.0, 0.1, 1.0}) shape.surface.positions.push_back({x, 0.0, z});
  for (const int k : {0, 1, 3, 4}) {
    shape.surface.triangles.push_back({k, k + 1, k + 4});
    shape.surface.triangles.push_back({k, k + 4, k + 3});
  }
  return shape;
}

std::set<std::pair<int, int>> owned_edges(const Collider& collider) {
  std::set<std::pair<int, int>> owned;
  for (const int e : collider.owned_edges) owned.insert({collider.edges[at(e)][0], collider.edges[at(e)][1]});
  return owned;
}

// Of a prism with so many corners: the edge along z at one of them.
std::pair<int, int> upright(const Polygon& polygon, int corner) {
  return {corner, corner + static_cast<int>(polygon.size())};
}

double least_gap(const PlacedCollider& a, const PlacedCollider& b) {
  FeatureList all;
  list_near_features(a, b, 100.0, all);
  double least = 1e300;
  for (const FeaturePair& pair : all)
    least =
        std::min(least, measure(gather(pair, *a.collider, a.start, *b.collider, b.start), Vec3::UnitY()).gap);
  return least;
}

Pose draw_pose(core::Random& random, double away) {
  const auto draw = [&] {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    return Vec3(x, y, random.uniform(-1, 1));
  };
  Pose pose;
  pose.rotation = Quat(random.uniform(-1, 1), draw().x(), draw().y(), draw().z()).normalized();
  pose.translation = away * draw().normalized();
  return pose;
}

}  // namespace

TEST_CASE("of a box and a flat sheet the diagonals can touch nothing alone") {
  body::Shape box;
  box.kind = body::ShapeKind::box;
  box.half_extent = Vec3(1, 2, 3);
  CHECK(make_collider(box)->owned_edges.size() == 12);
  CHECK(make_collider(make_flat_sheet())->owned_edges.size() == 8);
  CHECK(make_collider(make_flat_sheet(), SurfaceMotion::free)->owned_edges.size() == 16);
}

TEST_CASE("a notch of a solid can touch nothing alone, a fold of a sheet can") {
  const Polygon polygon = {{1.5, 0.7}, {1, 1}, {0, 1}, {0, 0}, {2, 0}, {2, 1}};
  body::Shape shape = make_prism(polygon);
  auto owned = owned_edges(*make_collider(shape));
  CHECK(owned.count(upright(polygon, 0)) == 0);
  for (const int convex : {1, 2, 3, 4, 5}) CHECK(owned.count(upright(polygon, convex)) == 1);
  shape.kind = body::ShapeKind::shell;
  owned = owned_edges(*make_collider(shape));
  for (const int fold : {0, 1, 2, 3, 4, 5}) CHECK(owned.count(upright(polygon, fold)) == 1);
  shape.kind = body::ShapeKind::solid;
  shape.surface.triangles.pop_back();  // what is open has no inside
  CHECK(owned_edges(*make_collider(shape)).count(upright(polygon, 0)) == 1);
}

TEST_CASE("where the faces of a splinter have changed sides its notches stand out") {
  // They cross at x = 1; beyond it the round end runs the wrong way round.
  const Polygon polygon = {{0, 1},     {0, -1},     {2, 1},      {2.4, 0.8},
                           {2.7, 0.3}, {2.7, -0.3}, {2.4, -0.8}, {2, -1}};
  const auto owned = owned_edges(*make_collider(make_prism(polygon)));
  for (const int corner : {2, 3, 4, 5, 6, 7}) CHECK(owned.count(upright(polygon, corner)) == 1);
}

TEST_CASE("surfaces that do not cross are nearest to each other at exposed edges too, or at no edge") {
  core::Random random(7);
  int stones = 0, fewer = 0;
  for (int i = 0; i < 300; ++i) {
    const body::Shape a = make_stone(random);
    const body::Shape b = i % 3 == 0   ? make_prism({{1.5, 0.7}, {1, 1}, {0, 1}, {0, 0}, {2, 0}, {2, 1}})
                          : i % 3 == 1 ? make_flat_sheet()
                                       : make_stone(random);
    const Pose pose_a = draw_pose(random, 0.0), pose_b = draw_pose(random, random.uniform(1.2, 2.2));
    const auto all_a = make_collider(a, SurfaceMotion::free), all_b = make_collider(b, SurfaceMotion::free);
    const auto few_a = make_collider(a), few_b = make_collider(b);
    const PlacedCollider all[] = {place_collider(*all_a, pose_a), place_collider(*all_b, pose_b)};
    if (crosses(all[0], all[1])) continue;
    ++stones;
    fewer += 5 * few_a->owned_edges.size() < 4 * all_a->owned_edges.size() ? 1 : 0;
    const double expected = least_gap(all[0], all[1]);
    const double found = least_gap(place_collider(*few_a, pose_a), place_collider(*few_b, pose_b));
    INFO("pair " << i << ", " << expected << " m");
    CHECK(std::abs(found - expected) <= 1e-12);
  }
  CHECK(stones > 100);
  CHECK(fewer > 100);
}

}  // namespace shatterbox::collision
