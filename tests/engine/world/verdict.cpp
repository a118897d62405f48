// Which impacts are solved, and which are known from an earlier pass of the same step.
#include "engine/world/verdict.h"

#include <catch2/catch.hpp>

#include "engine/fracture/shell_subject.h"
#include "engine/geometry/generators.h"
#include "engine/world/factor_shelf.h"
#include "engine/world/forms.h"

using namespace shatterbox;

namespace {

constexpr body::BodyId kStruck = 1, kOther = 2;

/// A glass sphere of 40 mm, with that fracture energy (J/m2), hit on its side.
struct Hit {
  std::vector<body::Body> bodies;
  world::Fragiles fragiles;
  world::BorneImpacts borne;
  world::EvaluationFigures figures;

  explicit Hit(double fracture_energy) {
    auto elements = std::make_shared<geometry::ShellElements>();
    elements->mesh = geometry::make_sphere(0.04, {0.006, 0.3, 1}).value();
    elements->topology = geometry::build_edge_topology(elements->mesh.triangles);
    auto fragile = std::make_shared<world::Fragile>();
    fragile->size = 0.08;
    fragile->density = 2500.0;
    fracture::ShellSubject subject;
    subject.mesh = std::make_shared<const geometry::ShellMesh>(geometry::make_shell_mesh(elements));
    subject.material = material::find_preset("glass").value();
    subject.material.fracture_energy = fracture_energy;
    subject.thickness = 5e-4;
    fracture::prepare_subject(subject);
    body::Body struck;
    struck.id = kStruck;
    struck.shape = world::make_shell_shape(*subject.mesh, *fragile, subject.thickness);
    struck.motion = body::Motion::dynamic;
    struck.inverse_mass = 1.0 / struck.shape->mass;
    struck.inverse_inertia = struck.shape->inertia.inverse();
    struck.restitution = 0.3;
    struck.young = subject.material.young;
    struck.poisson = subject.material.poisson;
    fragile->subject = std::move(subject);
    bodies = {struck};
    fragiles[kStruck] = fragile;
  }

  /// One pass, from memories as they were at the step's beginning.
  std::vector<world::EvaluatedImpact> judge(double speed, const Vec3& place) {
    body::LoggedImpulse entry;
    entry.kind = body::ImpulseKind::collision;
    entry.body_a = kStruck;
    entry.body_b = kOther;
    entry.point_a = entry.point_world = place;
    entry.impulse_a = entry.impulse_world = -1.3 * speed * bodies[0].shape->mass * place.normalized();
    entry.closing_speed = speed;
    std::map<body::BodyId, world::ImpactMemory> memories;
    return world::evaluate_stress(bodies, {entry}, fragiles, {}, {}, 0.0, memories, borne, figures);
  }
};

}  // namespace

TEST_CASE("an impact that was borne is not solved again, however near it came, but a harder one is") {
  const Vec3 side(0.04, 0.0, 0.0);
  // A soft hit that holds; and one above the strength of glass that no energy is left to crack.
  for (const double fracture_energy : {8.0, 1e12}) {
    Hit hit(fracture_energy);
    const double speed = fracture_energy > 100.0 ? 4.0 : 0.4;
    const auto first = hit.judge(speed, side);
    REQUIRE(first.size() == 1);
    const fracture::Verdict verdict = first[0].figures().verdict;
    REQUIRE(verdict.outcome == fracture::Outcome::held);
    REQUIRE(first[0].figures().generations > 0);
    CAPTURE(verdict.ratio, verdict.reason);
    REQUIRE((verdict.ratio > 1.0) == (fracture_energy > 100.0));
    CHECK(hit.judge(speed, side).empty());
    CHECK(hit.judge(1.01 * speed, side).empty());
    CHECK(hit.judge(0.5 * speed, side).empty());
    CHECK(hit.figures.skipped == 3);
    CHECK(hit.judge(1.1 / std::min(1.0, verdict.ratio) * speed, side).size() == 1);
    CHECK(hit.judge(speed, Vec3(-side)).size() == 1);
  }
}

TEST_CASE("a piece that gives up its factors is judged as before, and a whole body keeps its own") {
  for (const body::BodyId parent : {body::BodyId{0}, body::BodyId{7}}) {
    Hit hit(1e9);
    const auto count = [&] {
      return std::get<fracture::ShellSubject>(hit.fragiles.at(kStruck)->subject).systems->count();
    };
    const Vec3 side(0.04, 0.0, 0.0);
    const auto before = hit.judge(1.0, side);
    REQUIRE(before.size() == 1);
    REQUIRE(count() > 0);
    world::FactorShelf ample, none(0.0);
    for (world::FactorShelf* shelf : {&ample, &none}) shelf->note_use(kStruck, 3);
    const std::map<body::BodyId, world::Ancestry> ancestry = {{kStruck, {parent, kStruck, 0.0}}};
    ample.clear_out(hit.fragiles, ancestry);
    CHECK(count() > 0);
    none.clear_out(hit.fragiles, ancestry);
    CHECK((count() == 0) == (parent != 0));
    hit.borne = {};
    const auto after = hit.judge(1.0, side);
    REQUIRE(after.size() == 1);
    CHECK(after[0].figures().verdict.stress == before[0].figures().verdict.stress);
    CHECK(after[0].figures().verdict.duration == before[0].figures().verdict.duration);
  }
}
