// Boxes on their ways against sampled points of both.
#include "engine/dynamics/turned_box.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/engine/draw.h"

namespace shatterbox::dynamics {
namespace {

using test::draw_turn;
using test::draw_vector;

// Points all over the box, at this time of a straight way.
std::vector<Vec3> points_at(const geometry::Box& box, const Pose& start, const Pose& end, double time) {
  std::vector<Vec3> points;
  constexpr int kSide = 4;
  for (int i = 0; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j) {
      for (int k = 0; k <= kSide; ++k) {
        const Vec3 share(static_cast<double>(i) / kSide, static_cast<double>(j) / kSide,
                         static_cast<double>(k) / kSide);
        const Vec3 p = box.low + share.cwiseProduct(box.high - box.low);
        points.push_back((1.0 - time) * start.apply(p) + time * end.apply(p));
      }
    }
  }
  return points;
}

}  // namespace

TEST_CASE("boxes on their ways stay as far apart as is said") {
  core::Random random(3);
  int told_apart = 0;
  double tightest = 1e300;
  for (int n = 0; n < 200; ++n) {
    geometry::Box box_a, box_b;
    for (geometry::Box* box : {&box_a, &box_b}) {
      box->low = -0.5 * (draw_vector(random).cwiseAbs() + Vec3::Constant(0.05));
      box->high = 0.5 * (draw_vector(random).cwiseAbs() + Vec3::Constant(0.05));
    }
    Pose start_a{draw_turn(random, 1.0), Vec3::Zero()},
        start_b{draw_turn(random, 1.0), 2.5 * draw_vector(random)};
    Pose end_a = start_a, end_b = start_b;
    end_a.rotation = draw_turn(random, 0.15) * end_a.rotation;
    end_b.rotation = draw_turn(random, 0.15) * end_b.rotation;
    end_b.translation += 0.8 * draw_vector(random);
    const double said = clearance(turn_box(box_a, start_a, end_a), turn_box(box_b, start_b, end_b), 1e300);
    double least = 1e300;
    for (int k = 0; k <= 8; ++k) {
      const auto a = points_at(box_a, start_a, end_a, k / 8.0), b = points_at(box_b, start_b, end_b, k / 8.0);
      for (const Vec3& p : a)
        for (const Vec3& q : b) least = std::min(least, (p - q).norm());
    }
    CHECK(said <= least + 1e-12);
    if (said <= 0.0) continue;
    ++told_apart;
    tightest = std::min(tightest, least - said);
  }
  CHECK(told_apart > 60);
  CHECK(tightest < 0.02);  // a bound, not a guess far below
}

}  // namespace shatterbox::dynamics
