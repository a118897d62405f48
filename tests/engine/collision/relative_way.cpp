// Lists along straight ways against sampling: both bodies go and turn, a little, far, together, in parts.
#include "engine/collision/relative_way.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "engine/collision/feature_gap.h"
#include "engine/collision/feature_list.h"
#include "engine/core/random.h"
#include "tests/engine/collision/rough_sheet.h"
#include "tests/engine/draw.h"

namespace shatterbox::collision {
namespace {

using test::draw_vector;
using test::rough_sheet;

constexpr double kMargin = 0.05;  // m
constexpr int kLooks = 24;        // on a way

body::Shape rod() {
  body::Shape shape;
  shape.kind = body::ShapeKind::capsule;
  shape.radius = 0.2;
  shape.half_length = 0.5;
  return shape;
}

// How a body goes: from its pose where the step begins, between these shares of its straight way from one
// pose to another.
struct Going {
  Pose start, from, to;
  double begin = 0.0, end = 1.0;

  BodyWay way() const {
    BodyWay way;
    way.centre = start.translation;
    const auto turned = [&](const Pose& pose) {
      return Mat3((pose.rotation * start.rotation.conjugate()).toRotationMatrix());
    };
    const auto at_share = [&](double share, Vec3& gone, Mat3& turn) {
      gone = (1.0 - share) * from.translation + share * to.translation - start.translation;
      turn = (1.0 - share) * turned(from) + share * turned(to);
    };
    at_share(begin, way.from, way.turned_from);
    at_share(end, way.to, way.turned_to);
    way.least_length = std::abs(from.rotation.dot(to.rotation));
    return way;
  }

  // Vertices at the share `t` of that.
  std::vector<Vec3> at_time(const Collider& collider, double t) const {
    const double share = begin + t * (end - begin);
    std::vector<Vec3> out;
    for (const Vec3& v : collider.vertices)
      out.push_back((1.0 - share) * from.apply(v) + share * to.apply(v));
    return out;
  }
};

Quat turn_by(core::Random& random, double angle) {
  return Quat(Eigen::AngleAxisd(angle, draw_vector(random).normalized()));
}

// Two that meet somewhere about the middle of their ways.
std::pair<Going, Going> draw_goings(core::Random& random, int n) {
  const double angles[] = {0.0, 0.3, 1.0, 2.5};
  const double angle_a = angles[n % 4], angle_b = angles[(n / 4) % 4];
  const Vec3 place = n % 5 == 0 ? Vec3(600.0, -250.0, 400.0) : Vec3::Zero();
  const Vec3 common = n % 3 == 0 ? Vec3(3.0 * draw_vector(random)) : Vec3::Zero();
  Going a, b;
  a.start.translation = place;
  b.start.translation = place + 0.4 * draw_vector(random) + Vec3(0, 0.3, 0);
  a.start.rotation = turn_by(random, 0.2);
  b.start.rotation = turn_by(random, 0.2);
  a.from = a.start;
  b.from = b.start;
  a.to = {turn_by(random, angle_a) * a.start.rotation, a.start.translation + common};
  b.to = {turn_by(random, angle_b) * b.start.rotation,
          b.start.translation + common + 0.5 * draw_vector(random)};
  if (n % 7 < 3) return {a, b};
  // A later part, of the whole step or of one straight piece of it.
  for (Going* g : {&a, &b}) {
    g->begin = 0.25;
    g->end = 0.75;
    if (n % 7 < 5) continue;
    g->from = {turn_by(random, 0.4) * g->start.rotation, g->start.translation + 0.1 * draw_vector(random)};
  }
  return {a, b};
}

struct Found {
  long met = 0, missed = 0, above = 0, listed = 0;
};

template <class Visit>
void visit_features(const Collider& a, const Collider& b, const Visit& visit) {
  const auto all = [&](FeatureKind kind, std::size_t count_a, std::size_t count_b) {
    for (int i = 0; i < static_cast<int>(count_a); ++i)
      for (int j = 0; j < static_cast<int>(count_b); ++j) visit(FeaturePair{kind, 0.0F, i, j});
  };
  if (!b.edges.empty()) all(FeatureKind::vertex_triangle, a.vertices.size(), b.triangles.size());
  if (!a.edges.empty()) all(FeatureKind::triangle_vertex, a.triangles.size(), b.vertices.size());
  all(FeatureKind::edge_edge, a.edges.size(), b.edges.size());
}

void check_list(const Collider& a, const Going& going_a, const Collider& b, const Going& going_b,
                Found& found) {
  FeatureList list;
  list_met_features(place_collider(a, going_a.start), going_a.way(), place_collider(b, going_b.start),
                    going_b.way(), kMargin, list);
  std::map<std::uint64_t, float> bounds;
  bool is_doubled = false;
  for (const FeaturePair& f : list) is_doubled = !bounds.emplace(f.key(), f.bound).second || is_doubled;
  CHECK_FALSE(is_doubled);
  found.listed += static_cast<long>(list.size());
  std::vector<std::vector<Vec3>> at_a, at_b;
  for (int k = 0; k <= kLooks; ++k) {
    at_a.push_back(going_a.at_time(a, 1.0 * k / kLooks));
    at_b.push_back(going_b.at_time(b, 1.0 * k / kLooks));
  }
  visit_features(a, b, [&](const FeaturePair& f) {
    double least = 1e300;
    for (std::size_t k = 0; k < at_a.size(); ++k)
      least = std::min(least, measure(gather(f, a, at_a[k], b, at_b[k]), Vec3::UnitY()).gap);
    const auto bound = bounds.find(f.key());
    if (least <= kMargin) {
      ++found.met;
      found.missed += bound == bounds.end() ? 1 : 0;
    }
    // What overlaps is only said to be near.
    if (bound != bounds.end()) found.above += bound->second > std::max(1e-12, least) ? 1 : 0;
  });
}

}  // namespace

TEST_CASE("a list on the ways of two that go and turn holds every feature pair that comes near") {
  core::Random random(43);
  Found found;
  for (int n = 0; n < 48; ++n) {
    const auto a = make_collider(rough_sheet(random, 4)), b = make_collider(rough_sheet(random, 3));
    const auto [going_a, going_b] = draw_goings(random, n);
    check_list(*a, going_a, *b, going_b, found);
  }
  CHECK(found.met > 1000);
  CHECK(found.missed == 0);
  CHECK(found.above == 0);
}

TEST_CASE("of what is round a list holds what comes near, too") {
  core::Random random(47);
  const auto round = make_collider(rod());
  Found found;
  for (int n = 0; n < 48; ++n) {
    const auto sheet = make_collider(rough_sheet(random, 4));
    const auto [going_a, going_b] = draw_goings(random, n);
    if (n % 2 == 0)
      check_list(*round, going_a, *sheet, going_b, found);
    else
      check_list(*sheet, going_a, *round, going_b, found);
  }
  CHECK(found.met > 300);
  CHECK(found.missed == 0);
  CHECK(found.above == 0);
}

TEST_CASE("what two bodies do together hardly lengthens the list of what they may meet with") {
  core::Random random(53);
  std::size_t at_rest = 0, together = 0;
  for (int n = 0; n < 40; ++n) {
    const auto a = make_collider(rough_sheet(random, 8)), b = make_collider(rough_sheet(random, 8));
    Going still_a, still_b;
    still_b.start.translation = 0.2 * draw_vector(random) + Vec3(0, 0.3, 0);
    for (Going* g : {&still_a, &still_b}) g->from = g->to = g->start;
    FeatureList list;
    const PlacedCollider pa = place_collider(*a, still_a.start), pb = place_collider(*b, still_b.start);
    list_met_features(pa, still_a.way(), pb, still_b.way(), kMargin, list);
    at_rest += list.size();
    Going spun_a = still_a, spun_b = still_b;
    const Pose common{turn_by(random, 0.5), 2.0 * draw_vector(random)};
    for (Going* g : {&spun_a, &spun_b})
      g->to = {common.rotation * g->start.rotation, common.apply(g->start.translation)};
    list_met_features(pa, spun_a.way(), pb, spun_b.way(), kMargin, list);
    together += list.size();
  }
  CHECK(at_rest > 1000);
  CHECK(together >= at_rest);
  CHECK(5 * together < 6 * at_rest);
}

TEST_CASE("a ball that comes near a triangle on its way is not thought to miss it") {
  core::Random random(59);
  int met = 0, missed = 0, free = 0;
  for (int n = 0; n < 400; ++n) {
    const auto sheet = make_collider(rough_sheet(random, 4));
    auto [going, ball] = draw_goings(random, n);
    const double radius = random.uniform(0.02, 0.1);
    const Vec3 away = random.uniform(0.0, 0.5) * draw_vector(random);
    for (Pose* pose : {&ball.start, &ball.from, &ball.to}) pose->translation += away;
    const bool may_meet =
        may_meet_ball(place_collider(*sheet, going.start), going.way(), ball.way(), radius, kMargin);
    double least = 1e300;
    for (int k = 0; k <= kLooks; ++k) {
      const double t = 1.0 * k / kLooks, share = ball.begin + t * (ball.end - ball.begin);
      const Vec3 centre = (1.0 - share) * ball.from.translation + share * ball.to.translation;
      const std::vector<Vec3> vertices = going.at_time(*sheet, t);
      for (const auto& triangle : sheet->triangles) {
        FeaturePoints f;
        f.points = {centre, vertices[static_cast<std::size_t>(triangle[0])],
                    vertices[static_cast<std::size_t>(triangle[1])],
                    vertices[static_cast<std::size_t>(triangle[2])]};
        least = std::min(least, measure(f, Vec3::UnitY()).gap);
      }
    }
    const bool meets = least <= radius + kMargin;
    met += meets ? 1 : 0;
    missed += meets && !may_meet ? 1 : 0;
    free += may_meet ? 0 : 1;
  }
  CHECK(met > 50);
  CHECK(free > 50);
  CHECK(missed == 0);
}

}  // namespace shatterbox::collision
