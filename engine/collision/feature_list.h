// Pairs of features of two bodies that are near each other or that their paths bring near. [BFA02] sec. 3:
// vertex against triangle and edge against edge are all that surfaces can touch with.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/collision/collider.h"
#include "engine/core/vec.h"
#include "engine/geometry/bvh.h"

namespace shatterbox::collision {

enum class FeatureKind : std::uint8_t { vertex_triangle, triangle_vertex, edge_edge };

struct FeaturePair {
  FeatureKind kind = FeatureKind::vertex_triangle;
  int a = 0, b = 0;    // numbers of the features in the colliders of bodies a and b
  double bound = 0.0;  // m: the gap was not less than this when the list was made

  std::uint64_t key() const {
    return (static_cast<std::uint64_t>(kind) << 60) | (static_cast<std::uint64_t>(a) << 30) |
           static_cast<std::uint64_t>(b);
  }
};

using FeatureList = std::vector<FeaturePair>;

/// A collider in the world: where its vertices are, where they go, and the boxes over that.
struct PlacedCollider {
  const Collider* collider = nullptr;
  std::vector<Vec3> start;                        // |V| x 3, world, m
  std::vector<geometry::Box> vertex_boxes;        // |V|, over `start`, radius included
  std::vector<geometry::Box> swept_vertex_boxes;  // |V|, over start and end less the centre's own way
  std::vector<geometry::Box> boxes;               // of the tree's nodes over `start`; empty until needed
  std::vector<geometry::Box> swept_boxes;  // over start and end less the centre's own way; empty until needed
};

/// Fills `placed.boxes` (grown by the sphere's radius) from `placed.start`.
void refit_boxes(PlacedCollider& placed);

/// Fills `placed.swept_boxes` for straight paths from `start` to `turned` (|V| x 3: end positions less the
/// way of the body's centre).
void refit_swept_boxes(PlacedCollider& placed, const std::vector<Vec3>& turned);

/// All feature pairs that may be within `margin` (a superset; each pair once). Needs `boxes` of both.
void list_near_features(const PlacedCollider& a, const PlacedCollider& b, double margin, FeatureList& out);

/// All feature pairs whose straight paths may come within `margin`, when b moves by `relative_way` more than
/// a. Needs `swept_boxes` of both.
void list_swept_features(const PlacedCollider& a, const PlacedCollider& b, const Vec3& relative_way,
                         double margin, FeatureList& out);

}  // namespace shatterbox::collision
