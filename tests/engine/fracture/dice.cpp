// Sheets with stress stored in them: what they bear, and the dice they break into.
#include "engine/fracture/dice.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/fracture/split_shell.h"
#include "engine/material/tempering.h"
#include "tests/engine/fracture/window.h"
#include "tests/support/sanitized.h"

using namespace shatterbox;

namespace {

/// A free pane of 20 cm, 6 mm thick.
fracture::ShellSubject make_sheet(double compression, double edge = 0.012) {
  fracture::ShellSubject subject;
  subject.mesh =
      std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(test::make_pane(0.2, edge)));
  subject.thickness = 6e-3;
  subject.material = *material::find_preset("tempered_glass");
  subject.material.surface_compression = compression;
  fracture::prepare_subject(subject);
  return subject;
}

fracture::Decision strike(double compression, double speed, double edge = 0.012) {
  return fracture::decide_shell(make_sheet(compression, edge),
                                test::steel_ball(speed, Vec3(0.05, 0.03, 0.0)));
}

}  // namespace

TEST_CASE("a tempered sheet breaks into dice all over that pay for their cracks") {
  for (const double edge : {0.012, 0.006}) {
    const fracture::Decision decision = strike(100e6, 30.0, edge);
    REQUIRE(decision.verdict.outcome == fracture::Outcome::broke);
    CHECK(std::abs(total_area(*decision.mesh) / 0.04 - 1.0) < 1e-12);
    CHECK(decision.tips.empty());
    const fracture::ShellSubject subject = make_sheet(100e6, edge);
    const double die = material::die_area(subject.material, subject.thickness);
    CHECK(decision.dice == Approx(0.04 / die).epsilon(0.05));
    double length = 0.0, outside = 0.0;
    for (const auto& segment : decision.segments) {
      const double own = (segment.ends[1] - segment.ends[0]).norm();
      length += own;
      outside = std::max(outside, segment.ends[0].cwiseAbs().maxCoeff());
    }
    CHECK(outside > 0.0999);  // up to the border
    // The cracks of the hit itself are a few more.
    const double expected = material::kCrackToDie * 0.04 / std::sqrt(die);
    CHECK(length > 0.95 * expected);
    CHECK(length < 1.25 * expected);
    CHECK(decision.fracture_energy < decision.elastic_energy);
    const auto split = fracture::split_shell(*decision.mesh, decision.contacts, {2e-4});
    CHECK(static_cast<double>(split.pieces.size()) > 0.95 * decision.dice);
    double area = 0.0, largest = 0.0;
    for (const auto& piece : split.pieces) {
      area += total_area(piece);
      largest = std::max(largest, total_area(piece));
    }
    CHECK(std::abs(area / 0.04 - 1.0) < 1e-10);
    CHECK(largest < 3.0 * die);
  }
}

TEST_CASE("compression at the faces is borne before the glass's own strength is") {
  double annealed = 0.0, tempered = 0.0;  // m/s, the least that break
  for (double speed = 0.5; speed < 60.0 && !(tempered > 0.0); speed *= 1.1) {
    const auto breaks = [&](double compression) {
      return strike(compression, speed).verdict.outcome == fracture::Outcome::broke;
    };
    if (!(annealed > 0.0) && breaks(0.0)) annealed = speed;
    if (breaks(100e6)) tempered = speed;
  }
  INFO(annealed << " " << tempered);
  REQUIRE(annealed > 0.0);
  REQUIRE(tempered > 0.0);
  CHECK(tempered > 1.6 * annealed);
  const auto held = strike(100e6, annealed).verdict, broke = strike(0.0, annealed).verdict;
  CHECK(held.strength > 100e6);
  CHECK(held.ratio < broke.ratio);
  const auto without = strike(40e6, 30.0);  // heat-strengthened
  CHECK(without.verdict.outcome == fracture::Outcome::broke);
  CHECK(without.dice == 0);
}

TEST_CASE("a sheet with more stress than any glass holds has no more dice than can be borne") {
  if (test::kIsSanitized) return;  // more of what the tests above and below break
  const fracture::Decision decision = strike(2e9, 1000.0, 0.02);
  REQUIRE(decision.verdict.outcome == fracture::Outcome::broke);
  CHECK(decision.dice > 15000);
  CHECK(decision.dice < 25000);
}

TEST_CASE("dice of one sheet do not depend on its elements") {
  const fracture::Decision coarse = strike(100e6, 30.0, 0.012), fine = strike(100e6, 30.0, 0.006);
  REQUIRE(coarse.dice > 0);
  CHECK(coarse.dice == fine.dice);
}
