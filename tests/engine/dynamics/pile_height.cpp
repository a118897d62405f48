// How high a pile lies does not depend on the step: means of three seeds, for single piles are chaotic.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/engine/dynamics/piles.h"

namespace shatterbox {
namespace {

struct Pile {
  double height = 0.0;  // m, mean of the boats' centres at the end
  double drop = 0.0;    // m, by which it fell from the start
  int cut = 0;          // bodies cut short
};

Pile let_fall(int count, int seeds, int rate, double seconds) {
  Pile pile;
  for (int seed = 1; seed <= seeds; ++seed) {
    auto scene = test::boats_scene(count, static_cast<std::uint64_t>(seed), 1.0 / rate);
    const auto mean = [&] {
      double sum = 0.0;
      for (const auto& b : scene.bodies) sum += b.is_dynamic() ? b.pose.translation.y() / count : 0.0;
      return sum;
    };
    const double before = mean();
    for (int i = 0; i < seconds * rate; ++i) {
      scene.step();
      pile.cut += scene.report.failsafe_steps;
    }
    pile.height += mean() / seeds;
    pile.drop += (before - mean()) / seeds;
  }
  return pile;
}

void check_heights(int count, int seeds, double seconds, const std::vector<int>& rates, double tolerance) {
  const Pile fine = let_fall(count, seeds, rates.back(), seconds);
  for (const int rate : rates) {
    const Pile pile = let_fall(count, seeds, rate, seconds);
    UNSCOPED_INFO(count << " boats, " << rate << " steps a second: height " << pile.height << " m, drop "
                        << pile.drop << " m, cut " << pile.cut);
    CHECK(pile.height == Approx(fine.height).epsilon(tolerance));
    CHECK(pile.drop == Approx(fine.drop).epsilon(tolerance));
  }
}

}  // namespace

TEST_CASE("15 boats fall as deep at 60 steps a second as at 240") {
  // Their heights, a tenth of the way, are two layers of chance: those of higher piles are the long test's.
  const Pile coarse = let_fall(15, 3, 60, 3.0), fine = let_fall(15, 3, 240, 3.0);
  CHECK(coarse.drop == Approx(fine.drop).epsilon(0.05));
  CHECK(coarse.cut + fine.cut == 0);
}

TEST_CASE("a pile of 60 boats lies as high at 60 and 240 steps a second as at 960", "[.][long]") {
  check_heights(60, 3, 4.0, {60, 240, 960}, 0.1);
}

}  // namespace shatterbox
