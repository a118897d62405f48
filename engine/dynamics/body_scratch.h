// Memory that a part of a step writes a body's vertices and boxes into, and the next part writes over: large
// blocks that are taken from the heap and given back again and again cost more than what is written.
#pragma once

#include <vector>

#include "engine/body/body.h"
#include "engine/collision/feature_list.h"
#include "engine/core/vec.h"

namespace shatterbox::dynamics {

struct BodyScratch {
  body::BodyId id = 0;
  collision::PlacedCollider placed;
  std::vector<Vec3> predicted_vertices, end_vertices;  // |V| x 3

  /// As PlacedCollider::clear().
  void clear() {
    placed.clear();
    predicted_vertices.clear();
    end_vertices.clear();
  }
};

}  // namespace shatterbox::dynamics
