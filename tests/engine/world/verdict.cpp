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
  world::WorldSettings settings;

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

  body::LoggedImpulse impulse(body::ImpulseKind kind, double speed, const Vec3& place) const {
    body::LoggedImpulse entry;
    entry.kind = kind;
    entry.body_a = kStruck;
    entry.body_b = kOther;
    entry.point_a = entry.point_world = place;
    entry.impulse_a = entry.impulse_world = -1.3 * speed * bodies[0].shape->mass * place.normalized();
    entry.closing_speed = kind == body::ImpulseKind::collision ? speed : 0.0;
    return entry;
  }

  /// One pass, from memories as they were at the step's beginning.
  std::vector<world::EvaluatedImpact> judge(double speed, const Vec3& place) {
    std::map<body::BodyId, world::ImpactMemory> memories;
    return judge({impulse(body::ImpulseKind::collision, speed, place)}, 0.0, memories);
  }
  std::vector<world::EvaluatedImpact> judge(const body::ImpulseLog& log, double time,
                                            std::map<body::BodyId, world::ImpactMemory>& memories) {
    return world::evaluate_stress(bodies, log, fragiles, settings, {}, time, memories, borne, figures);
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

TEST_CASE("an impact begins when what hits arrives, not with the step in which it does") {
  Hit hit(8.0);
  std::map<body::BodyId, world::ImpactMemory> memories;
  body::ImpulseLog log = {hit.impulse(body::ImpulseKind::collision, 0.4, Vec3(0.04, 0.0, 0.0))};
  log[0].time = 0.003;
  const auto impacts = hit.judge(log, 0.5, memories);
  REQUIRE(impacts.size() == 1);
  CHECK(impacts[0].first_time == Approx(0.503));
  CHECK(impacts[0].charged == Approx(log[0].impulse_a.norm()));
}

TEST_CASE("an event lasts for two durations after its last collision, whatever touches the body meanwhile") {
  const Vec3 side(0.04, 0.0, 0.0);
  using Kind = body::ImpulseKind;
  for (const bool is_touched : {false, true}) {
    for (const double wait : {1.5, 2.5}) {
      Hit hit(8.0);
      std::map<body::BodyId, world::ImpactMemory> memories;
      const body::ImpulseLog collision = {hit.impulse(Kind::collision, 0.4, side)};
      const auto first = hit.judge(collision, 0.0, memories);
      REQUIRE(first.size() == 1);
      const double duration = first[0].figures().verdict.duration;
      REQUIRE(duration > 0.0);
      hit.borne = {};
      if (is_touched) hit.judge({hit.impulse(Kind::contact, 1e-6, side)}, 0.7 * duration, memories);
      CHECK(memories[kStruck].event_duration == duration);
      const auto second = hit.judge(collision, wait * duration, memories);
      REQUIRE(second.size() == 1);
      const double impulse = first[0].figures().verdict.impulse;
      CHECK(second[0].figures().verdict.impulse == Approx(wait < 2.0 ? 2.0 * impulse : impulse));
      CHECK(second[0].first_time == Approx(wait < 2.0 ? 0.0 : wait * duration));
    }
  }
}

TEST_CASE("hits of a piece are not counted together for longer where they are only estimated") {
  const Vec3 side(0.04, 0.0, 0.0);
  const double speed = 0.1;
  Hit whole(8.0);
  std::map<body::BodyId, world::ImpactMemory> memories;
  const body::ImpulseLog collision = {whole.impulse(body::ImpulseKind::collision, speed, side)};
  const auto exact = whole.judge(collision, 0.0, memories);
  REQUIRE(exact.size() == 1);
  const double duration = exact[0].figures().verdict.duration;
  Hit piece(8.0);
  std::map<body::BodyId, world::ImpactMemory> of_piece;
  of_piece[kStruck].charged_event = 77;  // born of it
  for (int hit = 0; hit < 4; ++hit) {
    const auto estimated = piece.judge(collision, 6.0 * hit * duration, of_piece);
    piece.borne = {};
    REQUIRE(estimated.size() == 1);
    const fracture::Verdict& verdict = estimated[0].figures().verdict;
    CAPTURE(hit, verdict.ratio, exact[0].figures().verdict.ratio, verdict.duration, duration);
    CHECK(verdict.is_estimate);
    CHECK(verdict.most_ratio() > exact[0].figures().verdict.ratio);
    CHECK(of_piece[kStruck].event.size() == 1);
    CHECK(verdict.impulse == Approx(exact[0].figures().verdict.impulse));
  }
}

TEST_CASE("what presses for long does not make an event longer") {
  Hit hit(8.0);
  hit.settings.stress_window.reset();
  const Vec3 side(0.04, 0.0, 0.0);
  std::map<body::BodyId, world::ImpactMemory> memories;
  const auto pressed = hit.judge({hit.impulse(body::ImpulseKind::contact, 30.0, side)}, 0.0, memories);
  REQUIRE(pressed.size() == 1);
  CHECK(!pressed[0].is_struck);
  CHECK(pressed[0].figures().verdict.duration > 0.01);
  CHECK(memories[kStruck].event_duration == 0.0);
}

TEST_CASE("what a body bears at rest is solved once, not for each tap that comes on top of it") {
  using Kind = body::ImpulseKind;
  Hit hit(8.0);
  hit.settings.stress_window.reset();
  const Vec3 side(0.04, 0.0, 0.0);
  std::map<body::BodyId, world::ImpactMemory> memories;
  const double weight = 20.0;
  REQUIRE(hit.judge({hit.impulse(Kind::contact, weight, side)}, 0.0, memories).size() == 1);
  const world::ImpactMemory& memory = memories[kStruck];
  REQUIRE(memory.solved_contact > 0.0);
  REQUIRE(memory.solved_ratio > 0.0);
  REQUIRE(memory.solved_ratio < 1.0);
  double time = 0.0;
  const auto taps = [&](double pressed) {
    hit.borne = {};
    time += 1.0;
    const auto judged = hit.judge(
        {hit.impulse(Kind::contact, pressed, side), hit.impulse(Kind::collision, 1e-4, Vec3(-side))}, time,
        memories);
    REQUIRE(judged.size() == 1);
    return judged[0].figures().needed_no_solve();
  };
  CHECK(taps(weight));
  CHECK(taps(0.5 * weight));
  CHECK(!taps(1.2 * weight));
  CHECK(taps(1.2 * weight));
}

TEST_CASE("a pass that is taken again remembers what was found of a body that bore it") {
  Hit hit(8.0);
  const body::ImpulseLog log = {hit.impulse(body::ImpulseKind::collision, 0.4, Vec3(0.04, 0.0, 0.0))};
  std::map<body::BodyId, world::ImpactMemory> first, again;
  REQUIRE(hit.judge(log, 0.0, first).size() == 1);
  CHECK(hit.judge(log, 0.0, again).empty());
  CHECK(first[kStruck].event_duration > 0.0);
  CHECK(again[kStruck].event_duration == first[kStruck].event_duration);
  CHECK(again[kStruck].tested_growth == first[kStruck].tested_growth);
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
    for (world::FactorShelf* shelf : {&ample, &none}) shelf->note_use(kStruck);
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

TEST_CASE(
    "a piece that breaks gives up its factors, one that holds keeps them, and so does what is no piece") {
  for (const bool is_piece : {true, false})
    for (const double speed : {0.4, 6.0}) {
      CAPTURE(is_piece, speed);
      Hit hit(8.0);
      std::map<body::BodyId, world::ImpactMemory> memories;
      if (is_piece) memories[kStruck].charged_event = 7;
      const auto impacts =
          hit.judge({hit.impulse(body::ImpulseKind::collision, speed, Vec3(0.04, 0.0, 0.0))}, 0.0, memories);
      REQUIRE(impacts.size() == 1);
      const bool breaks = impacts[0].figures().verdict.outcome == fracture::Outcome::broke;
      REQUIRE(breaks == (speed > 1.0));
      const auto& systems = *std::get<fracture::ShellSubject>(hit.fragiles.at(kStruck)->subject).systems;
      CHECK((systems.count() == 0) == (is_piece && breaks));
    }
}
