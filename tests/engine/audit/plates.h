// Bodies of a few triangles for tests of the audit.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "engine/body/body.h"

namespace shatterbox::test {

inline body::Body make_dynamic(body::BodyId id, std::shared_ptr<const body::Shape> shape) {
  body::Body body;
  body.id = id;
  body.shape = std::move(shape);
  body.inverse_mass = 1.0;
  body.inverse_inertia = Mat3::Identity();
  return body;
}

/// A dynamic shell: a triangle, or for four corners two triangles on both sides of the edge 0-1.
inline body::Body make_plate(body::BodyId id, const std::vector<Vec3>& corners) {
  auto shape = std::make_shared<body::Shape>();
  shape->kind = body::ShapeKind::shell;
  shape->surface.positions = corners;
  shape->surface.triangles = {{0, 1, 2}};
  if (corners.size() == 4) shape->surface.triangles.push_back({1, 0, 3});
  return make_dynamic(id, shape);
}

}  // namespace shatterbox::test
