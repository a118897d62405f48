// Feature lists against brute force, and paths against sampling.
#include "engine/collision/feature_gap.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <utility>

#include "engine/core/index.h"
#include "engine/core/random.h"
#include "tests/engine/collision/rough_sheet.h"
#include "tests/engine/draw.h"

namespace shatterbox::collision {
namespace {

using core::at;
using test::draw_vector;
using test::rough_sheet;

// Two rough sheets that stay where they are, one away from the other.
struct StillSheets {
  std::shared_ptr<const Collider> a, b;
  PlacedCollider pa, pb;

  StillSheets(core::Random& random, int n, const Vec3& away)
      : a(make_collider(rough_sheet(random, n))), b(make_collider(rough_sheet(random, n))) {
    pa.collider = a.get();
    pb.collider = b.get();
    pa.start = pb.start = a->vertices;
    for (std::size_t v = 0; v < pb.start.size(); ++v) pb.start[v] = b->vertices[v] + away;
    for (PlacedCollider* placed : {&pa, &pb}) refit_boxes(*placed);
  }
};

// Lists of a body and its copy, `share` of the margin away along `direction`: where they are, and on the way
// there from twice the margin away.
std::pair<FeatureList, FeatureList> list_copies(const Collider& collider, const Vec3& direction, double share,
                                                double margin) {
  PlacedCollider a, b;
  a.collider = b.collider = &collider;
  a.start = b.start = collider.vertices;
  for (Vec3& v : b.start) v += share * margin * direction;
  refit_boxes(a);
  refit_boxes(b);
  std::pair<FeatureList, FeatureList> lists;
  list_near_features(a, b, margin, lists.first);
  b.start = a.start;
  for (Vec3& v : b.start) v += 2.0 * margin * direction;
  refit_boxes(b);
  BodyWay way;
  way.to = (share - 2.0) * margin * direction;
  list_met_features(a, {}, b, way, margin, lists.second);
  return lists;
}

}  // namespace

TEST_CASE("a list holds every feature pair within the margin, each once") {
  core::Random random(11);
  for (int n = 0; n < 20; ++n) {
    const auto a = make_collider(rough_sheet(random, 5)), b = make_collider(rough_sheet(random, 4));
    PlacedCollider pa, pb;
    pa.collider = a.get();
    pb.collider = b.get();
    pa.start = a->vertices;
    const Vec3 shift = 0.3 * draw_vector(random) + Vec3(0, 0.3, 0);
    for (const Vec3& v : b->vertices) pb.start.push_back(v + shift);
    refit_boxes(pa);
    refit_boxes(pb);
    const double margin = 0.1;
    FeatureList list;
    list_near_features(pa, pb, margin, list);
    std::set<std::uint64_t> keys;
    for (const auto& f : list) CHECK(keys.insert(f.key()).second);
    const auto must_have = [&](FeatureKind kind, std::size_t count_a, std::size_t count_b) {
      for (int i = 0; i < static_cast<int>(count_a); ++i) {
        for (int j = 0; j < static_cast<int>(count_b); ++j) {
          const FeaturePair pair{kind, 0.0F, i, j};
          const double gap = measure(gather(pair, *a, pa.start, *b, pb.start), Vec3::UnitY()).gap;
          if (gap <= margin) CHECK(keys.count(pair.key()) == 1);
        }
      }
    };
    must_have(FeatureKind::vertex_triangle, a->vertices.size(), b->triangles.size());
    must_have(FeatureKind::triangle_vertex, a->triangles.size(), b->vertices.size());
    must_have(FeatureKind::edge_edge, a->edges.size(), b->edges.size());
  }
}

TEST_CASE("of great bodies, looked through in parts, a list holds every near vertex and triangle") {
  core::Random random(31);
  const StillSheets sheets(random, 33, Vec3(0.01, 0.2, 0.02));
  const auto& [a, b, pa, pb] = sheets;
  const double margin = 0.05;
  FeatureList list;
  list_met_features(pa, {}, pb, {}, margin, list);
  std::set<std::uint64_t> keys;
  bool is_doubled = false;
  for (const auto& f : list) is_doubled = !keys.insert(f.key()).second || is_doubled;
  CHECK_FALSE(is_doubled);
  int near = 0, missed = 0;
  for (int v = 0; v < static_cast<int>(a->vertices.size()); ++v) {
    for (int t = 0; t < static_cast<int>(b->triangles.size()); ++t) {
      const FeaturePair pair{FeatureKind::vertex_triangle, 0.0F, v, t};
      if (measure(gather(pair, *a, pa.start, *b, pb.start), Vec3::UnitY()).gap > margin) continue;
      ++near;
      missed += keys.count(pair.key()) == 0 ? 1 : 0;
    }
  }
  CHECK(near > 100);
  CHECK(missed == 0);
}

TEST_CASE("the blocks of a list follow each other, and their leaves hold what they list") {
  core::Random random(37);
  for (const int n : {4, 33}) {  // looked through at once and in parts
    const StillSheets sheets(random, n, Vec3(0.1, 0.1, 0));
    const auto& [a, b, pa, pb] = sheets;
    FeatureList list, alone;
    std::vector<FeatureBlock> blocks;
    list_met_features(pa, {}, pb, {}, 0.05, list, &blocks);
    list_met_features(pa, {}, pb, {}, 0.05, alone);
    REQUIRE(list.size() == alone.size());
    REQUIRE(!blocks.empty());
    CHECK(blocks.front().begin == 0);
    int strangers = 0, beyond = 0;
    const auto is_of = [](const Collider& c, int leaf, int vertex) {
      const auto first = c.leaf_vertices.begin();
      const auto begin = first + c.leaf_vertex_begin[at(leaf)],
                 end = first + c.leaf_vertex_begin[at(leaf) + 1];
      return std::find(begin, end, vertex) != end;
    };
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const std::size_t begin = at(blocks[k].begin),
                        end = k + 1 < blocks.size() ? at(blocks[k + 1].begin) : list.size();
      CHECK(begin < end);
      const Vec3 direction = draw_vector(random).normalized();
      const double apart = leaf_span(*a, blocks[k].leaf_a, pa.start, direction).least -
                           leaf_span(*b, blocks[k].leaf_b, pb.start, direction).most;
      for (std::size_t i = begin; i < end; ++i) {
        const FeaturePair& f = list[i];
        CHECK(f.key() == alone[i].key());
        if (f.kind == FeatureKind::vertex_triangle) strangers += is_of(*a, blocks[k].leaf_a, f.a) ? 0 : 1;
        if (f.kind == FeatureKind::triangle_vertex) strangers += is_of(*b, blocks[k].leaf_b, f.b) ? 0 : 1;
        const FeaturePoints points = gather(f, *a, pa.start, *b, pb.start);
        const double own = separation_along(f, *a, pa.start, *b, pb.start, direction);
        CHECK(own == separation_along(points, direction));
        beyond += own < apart ? 1 : 0;
      }
    }
    CHECK(strangers == 0);
    CHECK(beyond == 0);
  }
}

TEST_CASE("a list reaches to its margin along every axis, and no further") {
  core::Random random(29);
  body::Shape flat = rough_sheet(random, 3);
  for (Vec3& v : flat.surface.positions) v.y() = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    body::Shape turned = flat;  // across this axis: boxes are as far apart as what is in them
    for (Vec3& v : turned.surface.positions) std::swap(v[1], v[axis]);
    const auto collider = make_collider(turned);
    const double margin = 0.07;
    for (const double side : {1.0, -1.0}) {
      for (const double share : {0.9999, 1.0001}) {
        const auto [list, swept] = list_copies(*collider, side * Vec3::Unit(axis), share, margin);
        int above = 0;
        for (const FeaturePair& f : list) above += f.kind != FeatureKind::edge_edge ? 1 : 0;
        const auto vertices = static_cast<int>(collider->vertices.size());
        CHECK((share < 1.0 ? above >= 2 * vertices : list.empty()));
        CHECK(swept.size() == list.size());
      }
    }
  }
}

TEST_CASE("a list reaches to its margin along diagonals, and hardly further") {
  core::Random random(31);
  body::Shape flat = rough_sheet(random, 1);
  for (Vec3& v : flat.surface.positions) v = Vec3(0.01 * v.x(), 0.0, 0.01 * v.z());
  for (const Vec3& along : {Vec3(1, 1, 1), Vec3(1, 1, -1), Vec3(-1, 1, 1), Vec3(1, -1, 1)}) {
    const Vec3 normal = along.normalized();
    body::Shape turned = flat;
    for (Vec3& v : turned.surface.positions) v = Quat::FromTwoVectors(Vec3::UnitY(), normal) * v;
    const auto collider = make_collider(turned);
    for (const double side : {1.0, -1.0}) {
      for (const double share : {0.9999, 1.1}) {
        const auto [list, swept] = list_copies(*collider, side * normal, share, 0.7);
        CHECK((share < 1.0 ? list.size() >= 2 * collider->vertices.size() : list.empty()));
        CHECK(swept.size() == list.size());
      }
    }
  }
}

TEST_CASE("a list along paths holds every feature pair that comes within the margin") {
  core::Random random(23);
  std::size_t listed = 0, met = 0;
  for (int n = 0; n < 12; ++n) {
    const auto a = make_collider(rough_sheet(random, 4)), b = make_collider(rough_sheet(random, 3));
    SweptCollider pa, pb;
    pa.collider = a.get();
    pb.collider = b.get();
    pa.start = a->vertices;
    const Vec3 shift = 0.3 * draw_vector(random) + Vec3(0, 0.4, 0),
               way_b = 0.6 * draw_vector(random) - Vec3(0, 0.3, 0);
    for (const Vec3& v : b->vertices) pb.start.push_back(v + shift);
    // Both turn and bend a little, so that their planes do not stay what they were.
    pa.end = pa.start;
    pb.end = pb.start;
    for (Vec3& v : pa.end) v += 0.05 * draw_vector(random);
    for (Vec3& v : pb.end)
      v += 0.1 * (v - shift).cross(Vec3(0.4, 1.0, -0.7)) + 0.05 * draw_vector(random) + way_b;
    refit_swept_boxes(pa);
    refit_swept_boxes(pb);
    const double margin = 0.05;
    FeatureList list;
    list_swept_features(pa, pb, margin, list);
    std::set<std::uint64_t> keys;
    for (const auto& f : list) CHECK(keys.insert(f.key()).second);
    listed += keys.size();
    const auto must_have = [&](FeatureKind kind, std::size_t count_a, std::size_t count_b) {
      for (int i = 0; i < static_cast<int>(count_a); ++i) {
        for (int j = 0; j < static_cast<int>(count_b); ++j) {
          const FeaturePair pair{kind, 0.0F, i, j};
          const auto start = gather(pair, *a, pa.start, *b, pb.start),
                     end = gather(pair, *a, pa.end, *b, pb.end);
          double least = 1e300;
          for (int k = 0; k <= 12; ++k) {
            FeaturePoints now = start;
            for (std::size_t v = 0; v < 4; ++v) now.points[v] += k / 12.0 * (end.points[v] - start.points[v]);
            least = std::min(least, measure(now, Vec3::UnitY()).gap);
          }
          if (least > margin) continue;
          ++met;
          CHECK(keys.count(pair.key()) == 1);
        }
      }
    };
    must_have(FeatureKind::vertex_triangle, a->vertices.size(), b->triangles.size());
    must_have(FeatureKind::triangle_vertex, a->triangles.size(), b->vertices.size());
    must_have(FeatureKind::edge_edge, a->edges.size(), b->edges.size());
  }
  CHECK(met > 500);
  CHECK(listed < 4 * met);  // and not much more
}

TEST_CASE("features are no further apart along any direction than they are") {
  core::Random random(31);
  for (const FeatureKind kind :
       {FeatureKind::edge_edge, FeatureKind::vertex_triangle, FeatureKind::triangle_vertex}) {
    for (int n = 0; n < 500; ++n) {
      FeaturePoints f;
      f.is_edge_edge = kind == FeatureKind::edge_edge;
      f.is_flipped = kind == FeatureKind::triangle_vertex;
      f.radius_a = random.uniform(0.0, 0.1);
      f.radius_b = random.uniform(0.0, 0.1);
      for (Vec3& p : f.points) p = draw_vector(random);
      const FeatureGap gap = measure(f, Vec3::UnitY());
      CHECK(separation_along(f, draw_vector(random).normalized()) <= gap.gap + 1e-14);
      // Along the direction of the closest points, it is the gap.
      CHECK(separation_along(f, gap.normal) == Approx(gap.gap).margin(1e-13));
    }
  }
}

TEST_CASE("a path that is called free keeps its least separation") {
  core::Random random(5);
  int hits = 0, free = 0;
  for (int n = 0; n < 3000; ++n) {
    FeaturePoints start, end;
    start.is_edge_edge = end.is_edge_edge = n % 2 == 0;
    for (std::size_t i = 0; i < 4; ++i) start.points[i] = draw_vector(random);
    for (std::size_t i = 0; i < 4; ++i) end.points[i] = start.points[i] + 0.7 * draw_vector(random);
    const double least = 1e-3;
    if (measure(start, Vec3::UnitY()).gap < 2e-3) continue;
    const PathResult path = follow_paths(start, end, least, Vec3::UnitY());
    (path.has_hit ? hits : free) += 1;
    const double last = path.has_hit ? path.time : 1.0;
    for (int k = 0; k <= 200; ++k) {
      FeaturePoints now = start;
      const double t = last * k / 200.0;
      for (std::size_t i = 0; i < 4; ++i) now.points[i] += t * (end.points[i] - start.points[i]);
      CHECK(measure(now, Vec3::UnitY()).gap >= least * (1.0 - 1e-9));
    }
    if (path.has_hit) CHECK(path.gap.gap <= 1.1 * least);
  }
  CHECK(hits > 100);
  CHECK(free > 100);
}

TEST_CASE("what turns together is free, however near it is to what it turns with") {
  core::Random random(41);
  const double gap = 1e-8, least = 1e-9;
  for (int n = 0; n < 100; ++n) {
    FeaturePoints start;
    start.is_edge_edge = n % 2 == 0;
    if (start.is_edge_edge)
      start.points = {Vec3(-1, gap, 0), Vec3(1, gap, 0), Vec3(0, 0, -1), Vec3(0, 0, 1)};
    else
      start.points = {Vec3(0, gap, 0), Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, 0, 2)};
    const Quat turn(Eigen::AngleAxisd(random.uniform(0.05, 0.5), draw_vector(random).normalized()));
    const Vec3 way = draw_vector(random);
    FeaturePoints end = start, closing = start;
    for (std::size_t i = 0; i < 4; ++i) end.points[i] = closing.points[i] = turn * start.points[i] + way;
    const PathResult path = follow_paths(start, end, least, Vec3::UnitY());
    CHECK_FALSE(path.has_hit);
    CHECK(path.spare <= gap - least);
    // The same, but for as much as brings them together.
    closing.points[0] -= 1.5 * gap * (turn * Vec3::UnitY());
    if (start.is_edge_edge) closing.points[1] -= 1.5 * gap * (turn * Vec3::UnitY());
    CHECK(follow_paths(start, closing, least, Vec3::UnitY()).has_hit);
  }
}

}  // namespace shatterbox::collision
