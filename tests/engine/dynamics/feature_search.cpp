// For which motions a list of features is good, against sampled points of both bodies.
#include "engine/dynamics/feature_search.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "engine/dynamics/motion_work.h"
#include "tests/engine/draw.h"

namespace shatterbox::dynamics {
namespace {

Pose moved_a_little(core::Random& random, const Pose& pose, double shift, double turn) {
  const Quat change = test::draw_turn(random, turn);
  return {(change * pose.rotation).normalized(), pose.translation + shift * test::draw_vector(random)};
}

// Two boxes that pass into each other, full of points.
struct Pair {
  collision::Collider colliders[2];
  WorkBody a, b;
  std::vector<Vec3> points_a, points_b;  // in body space

  explicit Pair(core::Random& random) {
    a = fill(random, colliders[0], points_a);
    b = fill(random, colliders[1], points_b);
    a.start = moved_a_little(random, Pose(), 0.1, 1.0);
    b.start = moved_a_little(random, Pose(), 0.8, 1.0);
  }

  static WorkBody fill(core::Random& random, collision::Collider& collider, std::vector<Vec3>& points) {
    const Vec3 half = 0.5 * (test::draw_vector(random).cwiseAbs() + Vec3::Constant(0.05));
    collider.box.include(half);
    collider.box.include(Vec3(-half));
    WorkBody w;
    w.collider = &collider;
    w.is_active = true;
    w.reach = half.norm();
    for (const double x : {-1.0, -0.4, 0.4, 1.0})
      for (const double y : {-1.0, -0.4, 0.4, 1.0})
        for (const double z : {-1.0, -0.4, 0.4, 1.0}) points.push_back(half.cwiseProduct(Vec3(x, y, z)));
    return w;
  }

  template <class Visit>
  void for_each_pair(const Visit& visit) const {
    for (const Vec3& p : points_a)
      for (const Vec3& q : points_b) visit(p, q);
  }
};

/// Where a point is at so many equal times on its way, both ends among them.
std::vector<Vec3> way_of(const Pose& from, const Pose& to, const Vec3& point, int parts) {
  const Vec3 start = from.apply(point), end = to.apply(point);
  std::vector<Vec3> way;
  for (int k = 0; k <= parts; ++k) {
    const double time = parts == 0 ? 0.0 : static_cast<double>(k) / parts;
    way.push_back((1.0 - time) * start + time * end);
  }
  return way;
}

std::vector<std::vector<Vec3>> ways_of(const Pose& from, const Pose& to, const std::vector<Vec3>& points,
                                       int parts) {
  std::vector<std::vector<Vec3>> ways;
  for (const Vec3& point : points) ways.push_back(way_of(from, to, point, parts));
  return ways;
}

/// How near two points come to each other.
double least_distance(const std::vector<Vec3>& way_a, const std::vector<Vec3>& way_b) {
  double least = 1e300;
  for (std::size_t k = 0; k < way_a.size(); ++k) least = std::min(least, (way_a[k] - way_b[k]).squaredNorm());
  return std::sqrt(least);
}

double sum_of_ways(const Pose& from_a, const Pose& to_a, const WorkBody& a, const Pose& from_b,
                   const Pose& to_b, const WorkBody& b) {
  const Vec3 way = (to_a.translation - from_a.translation) - (to_b.translation - from_b.translation);
  return way.norm() + turn_bound(from_a.rotation, to_a.rotation, a.reach) +
         turn_bound(from_b.rotation, to_b.rotation, b.reach);
}

constexpr double kNear = 0.1;

}  // namespace

TEST_CASE("what is near now was no farther than is said when the search began") {
  core::Random random(5);
  long looked_at = 0;
  double said_less = 0.0;
  for (int n = 0; n < 500; ++n) {
    Pair pair(random);
    FeatureSearch search;
    search.start_a = pair.a.start;
    search.start_b = pair.b.start;
    const Pose then_a = pair.a.start, then_b = pair.b.start;
    pair.a.start = moved_a_little(random, then_a, 0.03, 0.1);
    pair.b.start = moved_a_little(random, then_b, 0.03, 0.1);
    const double said = moved_since(search, pair.a, pair.b, kNear);
    const double all = sum_of_ways(then_a, pair.a.start, pair.a, then_b, pair.b.start, pair.b);
    said_less += said / all / 500.0;
    pair.for_each_pair([&](const Vec3& p, const Vec3& q) {
      const double now = (pair.a.start.apply(p) - pair.b.start.apply(q)).norm();
      if (now > kNear) return;
      ++looked_at;
      const double then = (then_a.apply(p) - then_b.apply(q)).norm();
      if (then > now + said + 1e-12) FAIL("pair " << n << ": " << then << " m then, " << now << " m now");
    });
  }
  CHECK(looked_at > 1000);
  CHECK(said_less < 0.9);
}

TEST_CASE("what is near comes no closer on straight ways than is said") {
  core::Random random(8);
  long looked_at = 0;
  double said_less = 0.0;
  for (int n = 0; n < 400; ++n) {
    const Pair pair(random);
    const Pose end_a = moved_a_little(random, pair.a.start, 0.03, 0.1),
               end_b = moved_a_little(random, pair.b.start, 0.03, 0.1);
    const double said = approach_bound(pair.a, end_a, pair.b, end_b, kNear);
    said_less += said / motion_bound(pair.a, end_a, pair.b, end_b) / 400.0;
    const auto ways_a = ways_of(pair.a.start, end_a, pair.points_a, 8),
               ways_b = ways_of(pair.b.start, end_b, pair.points_b, 8);
    for (const auto& way_a : ways_a) {
      for (const auto& way_b : ways_b) {
        const double begin = (way_a[0] - way_b[0]).norm();
        if (begin > kNear) continue;
        ++looked_at;
        if (least_distance(way_a, way_b) < begin - said - 1e-12) FAIL("pair " << n << ", from " << begin);
      }
    }
  }
  CHECK(looked_at > 1000);
  CHECK(said_less < 0.9);
}

TEST_CASE("gaps that are carried from step to step are never more than they are") {
  core::Random random(9);
  long known = 0, gone = 0;
  for (int n = 0; n < 60; ++n) {
    Pair pair(random);
    // Points stand for features; `bound` is their distance where the list was made.
    auto search = std::make_shared<FeatureSearch>();
    search->margin = kNear;
    search->start_a = pair.a.start;
    search->start_b = pair.b.start;
    std::vector<std::pair<Vec3, Vec3>> listed;
    pair.for_each_pair([&](const Vec3& p, const Vec3& q) {
      const double gap = (pair.a.start.apply(p) - pair.b.start.apply(q)).norm();
      if (gap > kNear) return;
      search->features.emplace_back();
      search->features.back().bound = collision::round_down(gap);
      listed.emplace_back(p, q);
    });
    StartGaps gaps;
    for (int step = 0; step < 6; ++step) {
      if (step == 0)
        gaps = gaps_of(search);
      else
        carry_gaps(gaps, pair.a, pair.b);
      for (std::size_t i = 0; i < listed.size(); ++i) {
        const double gap =
            (pair.a.start.apply(listed[i].first) - pair.b.start.apply(listed[i].second)).norm();
        if (gaps.gaps[i] > gap)
          FAIL("pair " << n << ", step " << step << ": " << gaps.gaps[i] << " of " << gap);
        (gaps.gaps[i] > 0.5 * gap ? known : gone) += 1;
        if (step == 3) gaps.gaps[i] = collision::round_down(gap);  // as if it were measured
      }
      // Both are carried along by what moves them, and turn against each other a little.
      const Vec3 common = 0.3 * test::draw_vector(random);
      for (WorkBody* w : {&pair.a, &pair.b}) {
        w->start = moved_a_little(random, w->start, 0.002, 0.004);
        w->start.translation += common;
      }
    }
  }
  CHECK(known > 1000);
  CHECK(known > 3 * gone);
}

TEST_CASE("what comes near on the way was as near on the way that was looked at but for what is said") {
  core::Random random(6);
  long looked_at = 0;
  for (int n = 0; n < 200; ++n) {
    const Pair pair(random);
    FeatureSearch search;
    search.is_swept = n % 3 != 0;
    search.start_a = pair.a.start;
    search.start_b = pair.b.start;
    search.end_a = moved_a_little(random, pair.a.start, 0.2, 0.1);
    search.end_b = moved_a_little(random, pair.b.start, 0.2, 0.1);
    const Pose end_a = moved_a_little(random, search.end_a, 0.05, 0.05);
    const Pose end_b = moved_a_little(random, search.end_b, 0.05, 0.05);
    const double said = strays_from(search, pair.a, end_a, pair.b, end_b, kNear);
    const int looks = search.is_swept ? 64 : 0;
    const auto looked_a = ways_of(pair.a.start, search.end_a, pair.points_a, looks);
    const auto looked_b = ways_of(pair.b.start, search.end_b, pair.points_b, looks);
    const auto gone_a = ways_of(pair.a.start, end_a, pair.points_a, 4);
    const auto gone_b = ways_of(pair.b.start, end_b, pair.points_b, 4);
    for (std::size_t p = 0; p < gone_a.size(); ++p) {
      for (std::size_t q = 0; q < gone_b.size(); ++q) {
        const double nearest = least_distance(gone_a[p], gone_b[q]);
        if (nearest > kNear) continue;
        ++looked_at;
        // The way that was looked at is sampled at 1/64 of some .4 m.
        const double sampled = search.is_swept ? 0.005 : 1e-12;
        const double looked = least_distance(looked_a[p], looked_b[q]);
        if (looked > nearest + said + sampled)
          FAIL("pair " << n << ": " << looked << " m, " << nearest << " m now");
      }
    }
  }
  CHECK(looked_at > 1000);
}

TEST_CASE("what two bodies do together does not count") {
  core::Random random(7);
  Pair pair(random);
  FeatureSearch search;
  search.start_a = pair.a.start;
  search.start_b = pair.b.start;
  const Pose common = moved_a_little(random, Pose(), 5.0, 0.3);
  const auto together = [&](const Pose& pose) {
    return Pose{(common.rotation * pose.rotation).normalized(), common.apply(pose.translation)};
  };
  pair.a.start = together(search.start_a);
  pair.b.start = together(search.start_b);
  const double sum = sum_of_ways(search.start_a, pair.a.start, pair.a, search.start_b, pair.b.start, pair.b);
  CHECK(sum > 0.1);
  // What is apart by `near` goes on different ways by the turn times that.
  const double turned = 2.0 * common.rotation.vec().norm();
  CHECK(moved_since(search, pair.a, pair.b, 0.0) < 2.0 * turned * sum);
}

}  // namespace shatterbox::dynamics
