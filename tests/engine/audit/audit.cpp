// The audit of solids, births, exempt pairs and bodies at rest.
#include "engine/audit/audit.h"

#include <catch2/catch.hpp>

#include "tests/engine/audit/plates.h"

using namespace shatterbox;
using namespace shatterbox::audit;
using body::Body;

namespace {

Body make_solid(body::BodyId id, body::ShapeKind kind, double size) {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = kind;
  shape->radius = size;
  shape->half_extent = Vec3::Constant(size);
  Body body = test::make_dynamic(id, shape);
  if (kind == body::ShapeKind::plane) body.inverse_mass = 0.0;
  return body;
}

const std::vector<Vec3> kPlate{Vec3(-4, 0, -4), Vec3(4, 0, -4), Vec3(0, 0, 4)};

/// One step in which body 1 goes from `from` to `to`, after one at rest.
AuditReport move(Body moving, const Body& other, const Vec3& from, const Vec3& to) {
  Audit audit;
  moving.pose.translation = from;
  std::vector<Body> bodies{moving, other};
  audit.begin_step(bodies);
  audit.end_step(bodies, {}, {}, 0.1);
  audit.begin_step(bodies);
  bodies[0].pose.translation = to;
  audit.end_step(bodies, {}, {}, 0.2);
  return audit.report();
}

}  // namespace

TEST_CASE("audit: what sinks into a plane is counted, what lies on it is not") {
  const Body plane = make_solid(2, body::ShapeKind::plane, 0.0);
  const Body plate = test::make_plate(1, kPlate);
  CHECK(move(plate, plane, Vec3(0, 1, 0), Vec3(0, 0, 0)).crossings == 0);
  const AuditReport sunk = move(plate, plane, Vec3(0, 1, 0), Vec3(0, -1e-9, 0));
  CHECK(sunk.crossings == 3);
  CHECK(sunk.first_time == 0.2);
  CHECK(move(plate, plane, Vec3(0, -1, 0), Vec3(0, -2, 0)).exempt_crossings == 6);
  const Body ball = make_solid(1, body::ShapeKind::sphere, 0.5),
             crate = make_solid(1, body::ShapeKind::box, 0.5);
  for (const Body& solid : {ball, crate}) {
    CHECK(move(solid, plane, Vec3(0, 1, 0), Vec3(3, 0.5, 0)).crossings == 0);
    CHECK(move(solid, plane, Vec3(0, 1, 0), Vec3(3, 0.5 - 1e-9, 0)).crossings > 0);
  }
}

TEST_CASE("audit: two balls may touch but neither overlap nor pass each other within the step") {
  const Body ball = make_solid(1, body::ShapeKind::sphere, 0.5);
  const Body other = make_solid(2, body::ShapeKind::sphere, 0.25);
  const AuditReport touch = move(ball, other, Vec3(0, 2, 0), Vec3(0, 0.75, 0));
  CHECK(touch.crossings + touch.passages == 0);
  const AuditReport sunk = move(ball, other, Vec3(0, 2, 0), Vec3(0, 0.75 - 1e-6, 0));
  CHECK(sunk.crossings == 1);
  CHECK(sunk.passages == 0);
  const AuditReport passed = move(ball, other, Vec3(0.7, 2, 0), Vec3(0.7, -2, 0));
  CHECK(passed.crossings == 0);
  CHECK(passed.passages == 1);
  const AuditReport beside = move(ball, other, Vec3(0.76, 2, 0), Vec3(0.76, -2, 0));
  CHECK(beside.crossings + beside.passages == 0);
  const AuditReport from_start = move(ball, other, Vec3(0.7, 0, 0), Vec3(0.6, 0, 0));
  CHECK(from_start.exempt_pairs == 1);
  CHECK(from_start.crossings + from_start.passages == 0);
}

TEST_CASE("audit: two boxes may come close but neither overlap nor pass each other within the step") {
  const Body box = make_solid(1, body::ShapeKind::box, 0.5),
             other = make_solid(2, body::ShapeKind::box, 0.25);
  const Vec3 above(0.1, 2, 0.05);
  const AuditReport close = move(box, other, above, Vec3(0.1, 0.75 + 1e-9, 0.05));
  CHECK(close.crossings + close.passages == 0);
  CHECK(move(box, other, above, Vec3(0.1, 0.75 - 1e-6, 0.05)).crossings > 0);
  const AuditReport passed = move(box, other, above, Vec3(0.1, -2, 0.05));
  CHECK(passed.crossings == 0);
  CHECK(passed.passages > 0);
  const AuditReport beside = move(box, other, Vec3(0.76, 2, 0), Vec3(0.76, -2, 0));
  CHECK(beside.crossings + beside.passages == 0);
}

TEST_CASE("audit: a ball may lie on a box but not reach into it") {
  const Body ball = make_solid(1, body::ShapeKind::sphere, 0.5),
             box = make_solid(2, body::ShapeKind::box, 0.25);
  const AuditReport touch = move(ball, box, Vec3(0, 2, 0), Vec3(0.1, 0.75, 0));
  CHECK(touch.crossings + touch.passages == 0);
  CHECK(move(ball, box, Vec3(0, 2, 0), Vec3(0.1, 0.75 - 1e-6, 0)).crossings > 0);
}

TEST_CASE("audit: a sphere may touch a triangle, not reach through it, nor pass within the step") {
  const Body ball = make_solid(1, body::ShapeKind::sphere, 0.5), plate = test::make_plate(2, kPlate);
  const AuditReport touch = move(ball, plate, Vec3(0, 1, 0), Vec3(1, 0.5, 0));
  CHECK(touch.crossings + touch.passages == 0);
  const AuditReport reach = move(ball, plate, Vec3(0, 1, 0), Vec3(1, 0.49, 0));
  CHECK(reach.crossings == 1);
  CHECK(reach.passages == 0);
  CHECK(move(ball, plate, Vec3(0, 1, 0), Vec3(0, -1, 0)).passages == 1);        // through the inside
  CHECK(move(ball, plate, Vec3(0, 1, -4.4), Vec3(0, -1, -4.4)).passages == 1);  // past the rim, but too near
  CHECK(move(ball, plate, Vec3(0, 1, -4.6), Vec3(0, -1, -4.6)).passages == 0);
  CHECK(move(test::make_plate(1, kPlate), make_solid(2, body::ShapeKind::sphere, 0.5), Vec3(0, -1, 0),
             Vec3(0, 1, 0))
            .passages == 1);
}

TEST_CASE("audit: a plate through a box, a box through a plate") {
  const Body crate = make_solid(1, body::ShapeKind::box, 0.5), plate = test::make_plate(2, kPlate);
  CHECK(move(crate, plate, Vec3(0, 1, 0), Vec3(0, 0.5, 0.25)).crossings == 2);  // its base lies in the plate
  CHECK(move(crate, plate, Vec3(0, 1, 0), Vec3(0, 0.25, 0)).crossings == 8);
  CHECK(move(crate, plate, Vec3(0, 1, 0), Vec3(0, -1, 0)).passages >= 8);
  CHECK(move(crate, plate, Vec3(0, 1, 0), Vec3(0, 0.500001, 0)).crossings == 0);
}

TEST_CASE("audit: bodies of one group are counted apart, fixed pairs are not looked at") {
  Body a = test::make_plate(1, kPlate), b = test::make_plate(2, kPlate);
  a.group = b.group = 3;
  const AuditReport one_group = move(a, b, Vec3(0, 1, 0), Vec3(0.1, -1, 0));
  CHECK(one_group.passages == 0);
  CHECK(one_group.group_pairs == 0);
  CHECK(move(a, test::make_plate(2, {Vec3(0, -1, 0), Vec3(1, -1, 0), Vec3(0, -3, 0)}), Vec3(0, 1, 0),
             Vec3(0, -2, 0))
            .group_pairs == 0);
  Body c = test::make_plate(2, {Vec3(0, -1, 0), Vec3(1, -1, 0), Vec3(0, -3, 0)});
  c.group = 3;
  const AuditReport crossing = move(a, c, Vec3(0, 1, 0), Vec3(0, -2, 0));
  CHECK(crossing.group_pairs == 1);
  CHECK(crossing.crossings + crossing.passages == 0);
  a.family = b.family = 7;  // pieces of one body collide all the same
  CHECK(move(a, b, Vec3(0, 1, 0), Vec3(0.1, -1, 0)).passages > 0);
  a.family = 6;
  CHECK(move(a, b, Vec3(0, 1, 0), Vec3(0.1, -1, 0)).passages == 0);
  b.group = 4;
  CHECK(move(a, b, Vec3(0, 1, 0), Vec3(0.1, -1, 0)).passages > 0);
  a.inverse_mass = b.inverse_mass = 0.0;
  CHECK(move(a, b, Vec3(0, 1, 0), Vec3(0.1, -1, 0)).passages == 0);
}

TEST_CASE("audit: a piece starts where its parent did, and what crosses at the birth is exempt") {
  const Body parent = test::make_plate(1, kPlate),
             other = test::make_plate(2, {Vec3(0, -2, -1), Vec3(0, -2, 1), Vec3(0, -1, 0)});
  for (const bool crosses_at_birth : {false, true}) {
    Audit audit;
    std::vector<Body> bodies{parent, other};
    if (crosses_at_birth) bodies[1].pose.translation.y() = 1.5;
    audit.begin_step(bodies);
    Body piece = test::make_plate(4, kPlate);
    piece.pose.translation = Vec3(0, -3, 0);  // wholly beyond
    bodies = {bodies[1], piece};
    const std::vector<Birth> births{{3, 1}, {4, 3}};
    audit.end_step(bodies, births, {}, 0.1);
    CHECK(audit.report().passages == (crosses_at_birth ? 0 : 3));
    CHECK(audit.report().exempt_pairs == (crosses_at_birth ? 1 : 0));
    CHECK(audit.report().exempt_passages == (crosses_at_birth ? 2 : 0));
    // What has come apart is no longer exempt.
    audit.begin_step(bodies);
    bodies[1].pose.translation = Vec3(0, 3, 0);
    audit.end_step(bodies, births, {}, 0.2);
    CHECK(audit.report().passages >= 3);
  }
}

TEST_CASE("audit: a body is followed along its way, not only from where it was to where it is") {
  const Body plate = test::make_plate(2, kPlate), ball = make_solid(1, body::ShapeKind::sphere, 0.5),
             shard = test::make_plate(1, {Vec3(0, 0, 0), Vec3(0.5, 1, 0), Vec3(0, 1, 1)});
  const auto go = [&](const Body& moving, const std::vector<Vec3>& stations) {
    Audit audit;
    std::vector<Body> bodies{moving, plate};
    bodies[0].pose.translation = stations.front();
    audit.begin_step(bodies);
    audit.end_step(bodies, {}, {}, 0.1);
    audit.begin_step(bodies);
    bodies[0].pose.translation = stations.back();
    std::vector<body::Way> ways{{1, {}}};
    for (std::size_t k = 1; k + 1 < stations.size(); ++k) {
      const double time = static_cast<double>(k) / static_cast<double>(stations.size() - 1);
      ways[0].points.push_back({time, {Quat::Identity(), stations[k]}});
    }
    audit.end_step(bodies, {}, ways, 0.2);
    return audit.report();
  };
  const Vec3 above(0, 2, 0), below(0, -2, 0), beside(9, 2, 0), beneath(9, -2, 0);
  for (const Body& moving : {shard, ball}) {
    CHECK(go(moving, {above, below}).passages > 0);
    CHECK(go(moving, {above, beside, beneath, below}).passages == 0);
    CHECK(go(moving, {above, above}).passages == 0);
    CHECK(go(moving, {above, below, above}).passages > 0);
    CHECK(go(moving, {above, below, above}).crossings == 0);
  }
  // A ball that is in the plate where its way bends.
  CHECK(go(ball, {above, Vec3(0, 0.2, 0), above}).passages > 0);
}

TEST_CASE("audit: who breaks in the midst of a step has until then the surface that it had") {
  // A shard goes down, turns aside and on. It meets the plate's middle before the middle of the step, and
  // what the plate leaves of itself, far off, after it.
  const Vec3 off(5, 0, 0);
  const Body whole = test::make_plate(1, kPlate);
  Body piece = test::make_plate(3, {kPlate[0] + off, kPlate[1] + off, kPlate[2] + off});
  const Body shard = test::make_plate(2, {Vec3(0, 0, 0), Vec3(0.5, 1, 0), Vec3(0, 1, 1)});
  const auto go = [&](const std::vector<Vec3>& stations, bool is_told) {
    Audit audit;
    std::vector<Body> bodies{whole, shard};
    bodies[1].pose.translation = stations.front();
    audit.begin_step(bodies);
    audit.end_step(bodies, {}, {}, 0.1);
    audit.begin_step(bodies);
    bodies = {shard, piece};
    bodies[0].pose.translation = stations.back();
    std::vector<body::Way> ways{{2, {}}};
    for (std::size_t k = 1; k + 1 < stations.size(); ++k) {
      const double time = static_cast<double>(k) / static_cast<double>(stations.size() - 1);
      ways[0].points.push_back({time, {Quat::Identity(), stations[k]}});
    }
    if (is_told) {
      ways.push_back({3, {{0.5, piece.pose}}, 0.5, 1.0, nullptr});
      ways.push_back({1, {{0.5, whole.pose}}, 0.0, 0.5, std::make_shared<Body>(whole)});
    }
    audit.end_step(bodies, std::vector<Birth>{{3, 1}}, ways, 0.2);
    return audit.report();
  };
  const Vec3 above(0, 2, 0), below(0, -2, 0), over_piece = above + off, under_piece = below + off;
  const auto through_whole = go({above, below, below, below, below}, true);
  CHECK(through_whole.passages > 0);
  CHECK(go({above, above, above, below, below}, true).passages == 0);
  const auto through_piece = go({over_piece, over_piece, over_piece, under_piece, under_piece}, true);
  CHECK(through_piece.passages > 0);
  CHECK(through_piece.exempt_pairs == 0);
  // Where the piece is now, there was nothing before.
  CHECK(go({over_piece, under_piece, under_piece, under_piece, under_piece}, true).passages == 0);
  CHECK(go({over_piece, under_piece, under_piece, under_piece, under_piece}, false).passages > 0);
}

TEST_CASE("audit: a crossing that does not move is counted in every step") {
  Audit audit;
  std::vector<Body> bodies{test::make_plate(1, kPlate),
                           test::make_plate(2, {Vec3(0, 1, 0), Vec3(0.5, 2, 0), Vec3(0, 2, 1)})};
  for (int step = 0; step < 5; ++step) {
    audit.begin_step(bodies);
    if (step == 1) bodies[1].pose.translation.y() = -1.5;
    audit.end_step(bodies, {}, {}, step);
  }
  CHECK(audit.report().steps == 5);
  CHECK(audit.report().crossings == 4);
  CHECK(audit.report().passages == 1);
  CHECK(audit.report().first_time == 1.0);
}
