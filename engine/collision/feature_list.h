// Pairs of features of two bodies that are near each other or that their paths bring near. [BFA02] sec. 3:
// vertex against triangle and edge against edge are all that surfaces can touch with.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/collision/collider.h"
#include "engine/collision/relative_way.h"
#include "engine/collision/tight_box.h"
#include "engine/core/vec.h"

namespace shatterbox::collision {

enum class FeatureKind : std::uint8_t { vertex_triangle, triangle_vertex, edge_edge };

struct FeaturePair {
  FeatureKind kind = FeatureKind::vertex_triangle;
  float bound = 0.0F;  // m: the gap is not less than this where, or on the way on which, it was looked for
  int a = 0, b = 0;    // numbers of the features in the colliders of bodies a and b

  std::uint64_t key() const {
    return (static_cast<std::uint64_t>(kind) << 60) | (static_cast<std::uint64_t>(a) << 30) |
           static_cast<std::uint64_t>(b);
  }
  /// The pair that has this key.
  static FeaturePair of_key(std::uint64_t key) {
    constexpr std::uint64_t kNumber = (std::uint64_t{1} << 30) - 1;
    FeaturePair pair;
    pair.kind = static_cast<FeatureKind>(key >> 60);
    pair.a = static_cast<int>((key >> 30) & kNumber);
    pair.b = static_cast<int>(key & kNumber);
    return pair;
  }
};

using FeatureList = std::vector<FeaturePair>;

/// The features of a list that triangles of two leaves own, one from each body's tree: from `begin` up to the
/// next block's.
struct FeatureBlock {
  int leaf_a = 0, leaf_b = 0, begin = 0;
};

/// How far something reaches along a direction, m.
struct Span {
  double least = 0.0, most = 0.0;
};

/// Of the triangles of a leaf, with the vertices at `positions` (|V| x 3), radius not included.
Span leaf_span(const Collider& collider, int leaf, const std::vector<Vec3>& positions, const Vec3& direction);

/// Boxes over vertices, triangles and over the nodes of the tree. Those of a leaf's triangles lie side by
/// side.
struct FeatureBoxes {
  std::vector<TightBox> vertices, triangles,
      nodes;  // |V|, |T| in the tree's order, |nodes|; empty until needed
};

/// A collider in the world: where its vertices are, and the boxes over that.
struct PlacedCollider {
  const Collider* collider = nullptr;
  std::vector<Vec3> start;  // |V| x 3, world, m
  FeatureBoxes boxes;       // over `start`, radius included

  /// Empty vectors, whose memory stays.
  void clear();
};

/// One whose vertices go straight, each by itself.
struct SweptCollider {
  const Collider* collider = nullptr;
  std::vector<Vec3> start, end;  // |V| x 3, world, m
  FeatureBoxes boxes;            // over the paths, radius included
};

/// Vertices (|V| x 3, world, m) at a pose.
void place_vertices(const Collider& collider, const Pose& pose, std::vector<Vec3>& out);

/// At a pose, with `boxes`.
PlacedCollider place_collider(const Collider& collider, const Pose& pose);

/// Fills `placed.boxes` from `placed.start`.
void refit_boxes(PlacedCollider& placed);

/// Fills the boxes over the paths.
void refit_swept_boxes(SweptCollider& swept);

/// Nearest first; a total order.
void sort_by_bound(FeatureList& features);

/// All feature pairs that may be within `margin` by their boxes and the planes of the triangles that own them
/// (a superset; each pair once), in any order.
/// Needs `boxes` of both.
void list_near_features(const PlacedCollider& a, const PlacedCollider& b, double margin, FeatureList& out);

/// All feature pairs that may come within `margin` on the ways of their bodies (a superset; each pair once).
/// `blocks`, if asked for, are of the list in its order; none is empty. Needs `boxes` of both.
void list_met_features(const PlacedCollider& a, const BodyWay& way_a, const PlacedCollider& b,
                       const BodyWay& way_b, double margin, FeatureList& out,
                       std::vector<FeatureBlock>* blocks = nullptr);

/// The same of vertices that go each by itself. Needs the boxes of both.
void list_swept_features(const SweptCollider& a, const SweptCollider& b, double margin, FeatureList& out);

/// True if a ball may come within `margin` of a triangle of the body on their ways. Needs `boxes`.
bool may_meet_ball(const PlacedCollider& body, const BodyWay& way, const BodyWay& ball, double radius,
                   double margin);

/// True if a triangle of a surely crosses one of b at `start`. Needs `boxes` of both.
bool crosses(const PlacedCollider& a, const PlacedCollider& b);

/// True if the axis of one, a capsule, surely passes through a triangle of the other at `start`. Needs
/// `boxes` of both.
bool is_run_through(const PlacedCollider& a, const PlacedCollider& b);

}  // namespace shatterbox::collision
