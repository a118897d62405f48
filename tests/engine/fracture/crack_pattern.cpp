// Nothing is cut before the hit: cracks run along and across the radius from where the ball came, wherever
// that is, more of them the faster it was; and the mesh does not decide how many.
#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "engine/fracture/split_shell.h"
#include "tests/engine/fracture/window.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

constexpr double kLeastWidth = 1e-3;  // m, as the world merges pieces of a pane of 1 m

double length_of(const fracture::CrackSegment& segment) {
  return (segment.ends[1] - segment.ends[0]).norm();
}

/// Shares of crack length by the angle to the radius from `hit`, in nine bins of ten degrees, outside the
/// core.
std::array<double, 9> angles_to_radius(const std::vector<fracture::CrackSegment>& segments, const Vec3& hit) {
  std::array<double, 9> bins{};
  double total = 0.0;
  for (const auto& segment : segments) {
    const Vec3 radius = 0.5 * (segment.ends[0] + segment.ends[1]) - hit;
    const double length = length_of(segment);
    if (radius.norm() < 0.06 || radius.norm() > 0.35 || !(length > 0.0)) continue;
    const double cosine =
        std::abs((segment.ends[1] - segment.ends[0]).dot(radius)) / (length * radius.norm());
    const double angle = std::acos(std::min(1.0, cosine)) * 180.0 / core::kPi;
    bins[std::min<std::size_t>(8, static_cast<std::size_t>(angle / 10.0))] += length;
    total += length;
  }
  for (double& bin : bins) bin /= total;
  return bins;
}

/// The point that the lines of the first cracks pass nearest to: least squares, by length, then again without
/// those that pass far from it.
Vec3 centre_of_star(const std::vector<fracture::CrackSegment>& segments) {
  Vec2 centre = Vec2::Zero();
  for (const double farthest : {10.0, 0.2, 0.05}) {
    Mat2 matrix = Mat2::Zero();
    Vec2 right = Vec2::Zero();
    for (const auto& segment : segments) {
      if (segment.generation > 0 || !(length_of(segment) > 0.0)) continue;
      const Vec2 along = ((segment.ends[1] - segment.ends[0]) / length_of(segment)).head<2>();
      const Vec2 normal(-along.y(), along.x());
      const Vec2 place = segment.ends[0].head<2>();
      if (std::abs(normal.dot(place - centre)) > farthest) continue;
      matrix += length_of(segment) * normal * normal.transpose();
      right += length_of(segment) * normal * normal.dot(place);
    }
    centre = matrix.inverse() * right;
  }
  return {centre.x(), centre.y(), 0.0};
}

struct Count {
  double pieces = 0.0, length = 0.0;  // means; m
};

Count count_pieces(double speed, double edge, int seeds) {
  Count count;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto decision = fracture::decide_shell(test::make_window(static_cast<std::uint64_t>(seed), edge),
                                                 test::steel_ball(speed));
    REQUIRE(decision.mesh);
    count.pieces +=
        static_cast<double>(fracture::split_shell(*decision.mesh, {kLeastWidth}).pieces.size()) / seeds;
    count.length += decision.new_area / 4e-3 / seeds;
  }
  return count;
}

}  // namespace

TEST_CASE("cracks run along the radius from the hit and across it, not in between") {
  std::array<double, 9> mean{};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Vec3 hit(-0.05, 0.05, 0.0);
    const auto decision = fracture::decide_shell(test::make_window(seed), test::steel_ball(10.0, hit));
    REQUIRE(decision.mesh);
    CHECK(decision.grain_area == 0.0);
    const auto bins = angles_to_radius(decision.segments, hit);
    for (std::size_t i = 0; i < 9; ++i) mean[i] += bins[i] / 3.0;
  }
  std::string shares;
  for (const double share : mean) shares += std::to_string(share) + " ";
  INFO(shares);
  const double middle = (mean[3] + mean[4] + mean[5]) / 3.0;
  CHECK(mean[0] > 3.0 * middle);
  CHECK(mean[8] > 2.0 * middle);
  for (std::size_t i = 2; i < 7; ++i) CHECK(mean[i] < std::min(mean[0], mean[8]));
}

TEST_CASE("the star of first cracks has its centre where the ball hit") {
  for (const Vec3& hit : {Vec3(-0.05, 0.05, 0.0), Vec3(0.2, -0.15, 0.0), Vec3(-0.22, -0.2, 0.0)}) {
    const auto decision = fracture::decide_shell(test::make_window(2), test::steel_ball(10.0, hit));
    REQUIRE(decision.mesh);
    const Vec3 centre = centre_of_star(decision.segments);
    INFO(hit.transpose() << " -> " << centre.transpose());
    CHECK((centre - hit).norm() < 0.06);  // the hits lie a quarter of a metre and more apart
  }
}

TEST_CASE("the first cracks run from the hit to the frame, and none breaks out along it") {
  double ends = 0.0, along = 0.0, across = 0.0;  // means; m
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const auto decision = fracture::decide_shell(test::make_window(seed), test::steel_ball(10.0));
    REQUIRE(decision.mesh);
    for (const auto& segment : decision.segments) {
      for (const Vec3& end : segment.ends)
        if (segment.generation == 0 && end.cwiseAbs().maxCoeff() > 0.5 - 1e-9) ends += 1.0 / 3.0;
      const Vec3 middle = 0.5 * (segment.ends[0] + segment.ends[1]);
      const Vec3 step = (segment.ends[1] - segment.ends[0]).cwiseAbs();
      const bool is_by_side = std::abs(middle.x()) > 0.35 && std::abs(middle.y()) < 0.3;
      const bool is_by_top = std::abs(middle.y()) > 0.35 && std::abs(middle.x()) < 0.3;
      if (segment.generation > 0 || (!is_by_side && !is_by_top)) continue;
      along += (is_by_side ? step.y() : step.x()) / 3.0;
      across += (is_by_side ? step.x() : step.y()) / 3.0;
    }
  }
  INFO(ends << " reach the frame; near it " << along << " m along, " << across << " m across");
  CHECK(ends >= 8.0);
  CHECK(across > along);
}

TEST_CASE("a ball of twice the speed makes more pieces and more crack") {
  const Count slow = count_pieces(6.0, 0.034, 3);
  const Count fast = count_pieces(12.0, 0.034, 3);
  INFO(slow.pieces << " pieces, " << slow.length << " m; " << fast.pieces << " pieces, " << fast.length
                   << " m");
  CHECK(fast.pieces > 1.5 * slow.pieces);
  CHECK(fast.length > 1.1 * slow.length);
}

TEST_CASE("half the element size gives as many pieces and as much crack") {
  if (test::kIsSanitized) {  // means over seeds are for the other builds: here one pane of the finer half
    CHECK(count_pieces(10.0, 0.017, 1).pieces > 10.0);
    return;
  }
  const Count coarse = count_pieces(10.0, 0.024, 5);
  const Count fine = count_pieces(10.0, 0.012, 5);
  INFO(coarse.pieces << " pieces, " << coarse.length << " m; " << fine.pieces << " pieces, " << fine.length
                     << " m");
  CHECK(fine.pieces == Approx(coarse.pieces).epsilon(0.15));
  CHECK(fine.length == Approx(coarse.length).epsilon(0.1));
}
