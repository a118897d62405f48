// What lists of features are tried on.
#pragma once

#include "engine/body/shape.h"
#include "engine/core/random.h"
#include "engine/core/vec.h"

namespace shatterbox::test {

/// Two metres wide, n x n squares of two triangles.
inline body::Shape rough_sheet(core::Random& random, int n) {
  body::Shape shape;
  shape.kind = body::ShapeKind::shell;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double y = random.uniform(-0.1, 0.1);
      shape.surface.positions.push_back(Vec3(2.0 * i / n - 1.0, y, 2.0 * j / n - 1.0));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
      shape.surface.triangles.push_back({a, b, d});
      shape.surface.triangles.push_back({a, d, c});
    }
  }
  return shape;
}

}  // namespace shatterbox::test
