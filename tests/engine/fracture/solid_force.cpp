// Resting contact beside an impact is one load; what is left of it on a cracked body, part by part.
#include "engine/fracture/solid_force.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/fracture/solid_model.h"
#include "engine/geometry/box_tets.h"
#include "engine/geometry/solid_cutter.h"
#include "tests/engine/geometry/solids.h"

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

FractureSettings exact() {
  FractureSettings settings;
  settings.solve_residual = 1e-8;
  return settings;
}

void find_forces(SolidForce& force, SolidDecision& decision) {
  std::string problem;
  REQUIRE(force.prepare(problem));
  REQUIRE(force.settle(decision, problem));
}

struct Settled {
  VecX displacement, struck;
  double hardest = 0.0, elastic_energy = 0.0;
  int iterations = 0;
};
Settled settled(const SolidSubject& subject, const Impact& impact) {
  const FractureSettings settings = exact();
  SolidForce force(subject, impact, settings);
  SolidDecision decision;
  find_forces(force, decision);
  Settled out{force.displacement(), force.struck_displacement(), force.presses().front().force, 0.0,
              decision.iterations};
  force.book_energy(decision);
  out.elastic_energy = decision.elastic_energy;
  return out;
}

ImpactLoad resting(const Vec3& point, const Vec3& direction, double force) {
  ImpactLoad load;
  load.point_material = point;
  load.direction = direction;
  load.impulse = force / 60.0;
  load.is_resting = true;
  return load;
}

Impact rest_of(std::vector<ImpactLoad> loads) {
  Impact impact;
  impact.contact_average = 1.0 / 60.0;
  impact.loads = std::move(loads);
  return impact;
}

/// The forces, N, that are left of an impact once the block is cut across at x, of so much fracture energy
/// (J).
std::vector<double> left_after_cut(const SolidSubject& subject, const Impact& impact, double x,
                                   double fracture_energy = 0.0) {
  const FractureSettings settings = exact();
  SolidForce force(subject, impact, settings);
  SolidDecision decision;
  find_forces(force, decision);
  force.book_energy(decision);
  geometry::SolidComplex complex = *subject.complex;
  geometry::SolidCutter cutter(complex, 1e-9);
  cutter.cut(test::plane_cut(complex, Vec3::UnitX(), x));
  settle(complex);
  std::vector<int> origins;
  for (const geometry::SolidPart& cell : complex.cells)
    for (size_t c = 0; c < subject.complex->cells.size(); ++c)
      if (subject.complex->cells[c].element == cell.element) origins.push_back(static_cast<int>(c));
  REQUIRE(origins.size() == complex.cells.size());
  decision.fracture_energy = fracture_energy;
  std::string problem;
  REQUIRE(force.settle_again(find_form(complex), origins, decision, problem));
  std::vector<double> forces;
  for (const SolidPress& press : force.presses()) forces.push_back(press.force);
  return forces;
}

}  // namespace

TEST_CASE("all resting contact beside an impact is one solve, with the answer of each alone") {
  const SolidSubject subject = pressed_block();
  const double hardest = settled(subject, hit_among({})).hardest;
  REQUIRE(hardest > 0.0);
  std::vector<double> resting;
  for (int i = 0; i < 10; ++i) resting.push_back((0.5 + 0.1 * i) * 9e-4 * hardest);
  resting.push_back(0.5 * hardest);
  const Settled all = settled(subject, hit_among(resting));
  CHECK(all.hardest == hardest);
  VecX sum = settled(subject, hit_among({})).displacement;
  int iterations = 0;
  for (size_t i = 0; i < resting.size(); ++i) {
    std::vector<double> one(resting.size(), 0.0);
    one[i] = resting[i];
    const Settled own = settled(subject, hit_among(one));
    iterations += own.iterations;
    sum += own.displacement - settled(subject, hit_among({})).displacement;
  }
  CHECK((all.displacement - sum).norm() < 1e-5 * sum.norm());
  CHECK(2 * all.iterations < iterations);
}

TEST_CASE("resting contact has the energy of all its forces together") {
  const SolidSubject subject = pressed_block();
  const ImpactLoad down = resting(Vec3(0, 0, 0.05), -Vec3::UnitZ(), 1000.0);
  const ImpactLoad up = resting(Vec3(0, 0, -0.05), Vec3::UnitZ(), 1000.0);
  const Settled both = settled(subject, rest_of({down, up}));
  const VecX stiff = apply_stiffness(*subject.model->stiffness, subject.model->mesh, both.displacement);
  CHECK(both.elastic_energy == Approx(0.5 * both.displacement.dot(stiff)).epsilon(1e-6));
  // Twice the forces, four times the energy; and what pulls where it pressed presses on nothing.
  const Settled twice = settled(subject, rest_of({resting(down.point_material, down.direction, 2000.0),
                                                  resting(up.point_material, up.direction, 2000.0)}));
  CHECK(twice.elastic_energy == Approx(4.0 * both.elastic_energy).epsilon(1e-5));
  const Settled none =
      settled(subject, rest_of({down, resting(down.point_material, -down.direction, 1000.0)}));
  CHECK(none.elastic_energy < 1e-9 * both.elastic_energy);
}

TEST_CASE("a crack takes its share of resting contact from the part that hung by it, and from no other") {
  const SolidSubject subject = pressed_block();
  const Vec3 down = -Vec3::UnitZ(), up = Vec3::UnitZ();
  // Squeezed on the left, where the cut is far off: nothing changes.
  const std::vector<ImpactLoad> squeeze{resting(Vec3(-0.12, 0, 0.05), down, 1000.0),
                                        resting(Vec3(-0.12, 0, -0.05), up, 1000.0)};
  const std::vector<double> far = left_after_cut(subject, rest_of(squeeze), 0.11);
  CHECK(far[0] > 950.0);
  CHECK(far[0] == far[1]);
  // Bent over two edges, and cut through under the load: nothing is bent any more, and a half gives way
  // alone.
  std::vector<ImpactLoad> bent{resting(Vec3(0.03, 0, 0.05), down, 1000.0),
                               resting(Vec3(-0.18, 0, -0.05), up, 430.0),
                               resting(Vec3(0.18, 0, -0.05), up, 570.0)};
  const std::vector<double> through = left_after_cut(subject, rest_of(bent), 0.0);
  CHECK(through[0] < 250.0);
  CHECK(through[2] < 140.0);
  CHECK(through[0] / through[2] == Approx(1000.0 / 570.0));
  CHECK(through[1] < 400.0);
  // Both sides squeezed, and cut between: what cracks took leaves nothing of the weak one, and most of the
  // other.
  std::vector<ImpactLoad> both = squeeze;
  both.push_back(resting(Vec3(0.14, 0, 0.05), down, 100.0));
  both.push_back(resting(Vec3(0.14, 0, -0.05), up, 100.0));
  const double weak = settled(subject, rest_of({both[2], both[3]})).elastic_energy;
  const std::vector<double> shares = left_after_cut(subject, rest_of(both), 0.03, 1.1 * weak);
  CHECK(shares[0] == shares[1]);
  CHECK(shares[0] > 950.0);
  CHECK(shares[2] == 0.0);
  CHECK(shares[3] == 0.0);
}

TEST_CASE("a hit that is no collision is solved for however light it is") {
  // A held body is hit by one that broke in the same moment: nobody knows how heavy that was.
  const SolidSubject subject = pressed_block();
  const Settled one = settled(subject, hit_among({}));
  Impact impact = hit_among({1e-4 * one.hardest});
  impact.loads.back().is_resting = false;
  REQUIRE_FALSE(is_collision(impact.loads.back()));
  const Settled both = settled(subject, impact);
  const VecX added = both.struck - one.struck;
  CHECK(added.norm() > 1e-6 * one.struck.norm());
  CHECK((added - (both.displacement - one.displacement)).norm() < 1e-6 * added.norm());
}
