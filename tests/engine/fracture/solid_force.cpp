// Resting contact beside an impact: next to nothing is one load, and what counts is a load of its own.
#include "engine/fracture/solid_force.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/index.h"
#include "engine/geometry/box_tets.h"

using namespace shatterbox;
using namespace shatterbox::fracture;
using std::size_t;

namespace {

SolidSubject pressed_block() {
  auto mesh = geometry::make_box_tets(Vec3(0.2, 0.1, 0.05), 0.03);
  REQUIRE(mesh.ok());
  auto elements = std::make_shared<geometry::SolidElements>();
  elements->mesh = std::move(mesh.value());
  elements->topology = geometry::build_tet_topology(elements->mesh.tetrahedra);
  auto complex = geometry::make_solid_complex(elements);
  settle(complex);
  SolidSubject subject;
  subject.complex = std::make_shared<const geometry::SolidComplex>(std::move(complex));
  subject.material = *material::find_preset("glass");
  prepare_subject(subject);
  return subject;
}

/// A ball on the top in the middle, and contact of these forces (N) along the top's middle line.
Impact hit_among(const std::vector<double>& resting) {
  Impact impact;
  impact.contact_average = 1.0 / 60.0;
  ImpactLoad ball;
  ball.point_material = Vec3(0.0, 0.0, 0.05);
  ball.direction = -Vec3::UnitZ();
  ball.effective_mass = 0.1;
  ball.closing_speed = 10.0;
  ball.impulse = 1.3;
  ball.other_inverse_mass = 10.0;
  ball.hertz_compliance = 1e-9;
  impact.loads.push_back(ball);
  for (size_t i = 0; i < resting.size(); ++i) {
    ImpactLoad load;
    load.point_material =
        Vec3(-0.18 + 0.36 * static_cast<double>(i) / static_cast<double>(resting.size()), 0.04, 0.05);
    load.direction = -Vec3::UnitZ();
    load.impulse = resting[i] * impact.contact_average;
    load.is_resting = true;
    impact.loads.push_back(load);
  }
  return impact;
}

struct Settled {
  VecX displacement, struck;
  std::vector<bool> is_minor;  // when the body breaks
  double hardest = 0.0;
  int iterations = 0;
};
Settled settled(const SolidSubject& subject, const Impact& impact) {
  FractureSettings settings;
  settings.solve_residual = 1e-8;
  SolidForce force(subject, impact, settings);
  std::string problem;
  SolidDecision decision;
  REQUIRE(force.prepare(problem));
  REQUIRE(force.settle(decision, problem));
  Settled out{force.displacement(), {}, {}, force.presses().front().force, decision.iterations};
  out.struck = force.struck_displacement();
  REQUIRE(force.complete(decision, problem));
  for (const SolidPress& press : force.presses()) out.is_minor.push_back(press.is_minor);
  return out;
}

}  // namespace

TEST_CASE(
    "resting contact of a thousandth of the impact is solved for together, with the answer of each alone") {
  const SolidSubject subject = pressed_block();
  const double hardest = settled(subject, hit_among({})).hardest;
  REQUIRE(hardest > 0.0);
  // Ten that are 0.9 % together, and one that is 5 %: it has the last place.
  std::vector<double> resting;
  for (int i = 0; i < 10; ++i) resting.push_back((0.5 + 0.1 * i) * 9e-4 * hardest);
  resting.push_back(0.05 * hardest);
  const Settled all = settled(subject, hit_among(resting));
  for (size_t i = 1; i <= 10; ++i) CHECK(all.is_minor[i]);
  CHECK_FALSE(all.is_minor[0]);
  CHECK_FALSE(all.is_minor[11]);
  CHECK(all.hardest == hardest);

  // Each by itself, as a load that is too much to be minor, scaled: the answer is linear.
  VecX sum = settled(subject, hit_among({})).displacement;
  int iterations = 0;
  for (size_t i = 0; i < resting.size(); ++i) {
    std::vector<double> one(resting.size(), 0.0);
    one[i] = 0.05 * hardest;
    const Settled own = settled(subject, hit_among(one));
    iterations += own.iterations;
    sum += (resting[i] / one[i]) * (own.displacement - settled(subject, hit_among({})).displacement);
  }
  CHECK((all.displacement - sum).norm() < 1e-5 * sum.norm());
  CHECK(2 * all.iterations < iterations);
}

TEST_CASE("resting contact counts where it is not next to nothing, and all of it without an impact") {
  const SolidSubject subject = pressed_block();
  const double hardest = settled(subject, hit_among({})).hardest;
  const Settled heavy = settled(subject, hit_among({0.006 * hardest, 0.007 * hardest}));
  CHECK(heavy.is_minor[1]);  // the lighter one still fits into a hundredth
  CHECK_FALSE(heavy.is_minor[2]);
  Impact rest = hit_among({100.0, 100.0, 100.0});
  rest.loads.erase(rest.loads.begin());
  for (const bool is_minor : settled(subject, rest).is_minor) CHECK_FALSE(is_minor);
}

TEST_CASE("a hit that is no collision is solved for however light it is") {
  // A held body is hit by one that broke in the same moment: nobody knows how heavy that was.
  const SolidSubject subject = pressed_block();
  const Settled one = settled(subject, hit_among({}));
  Impact impact = hit_among({1e-4 * one.hardest});
  impact.loads.back().is_resting = false;
  REQUIRE_FALSE(is_collision(impact.loads.back()));
  const Settled both = settled(subject, impact);
  CHECK_FALSE(both.is_minor[1]);
  const VecX added = both.struck - one.struck;
  CHECK(added.norm() > 1e-6 * one.struck.norm());
  CHECK((added - (both.displacement - one.displacement)).norm() < 1e-6 * added.norm());
}
