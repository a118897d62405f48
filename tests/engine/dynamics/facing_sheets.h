// Two rough sheets that face each other, as the sides of a crack do.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "engine/core/random.h"
#include "engine/dynamics/feature_paths.h"
#include "engine/dynamics/motion_work.h"

namespace shatterbox::test {

inline constexpr double kGap = 1e-3;  // m, between the sheets, which are a metre wide

class FacingSheets {
 public:
  FacingSheets(core::Random& random, int n) {
    const body::Shape under = sheet(random, n);
    body::Shape over = under;
    for (Vec3& v : over.surface.positions) v.y() += random.uniform(kGap, 1.5 * kGap);
    shapes_[0] = over;
    shapes_[1] = under;
    dynamics::WorkBody* bodies[2] = {&a, &b};
    for (int k = 0; k < 2; ++k) {
      colliders_[k] = collision::make_collider(shapes_[k]);
      bodies[k]->shape = &shapes_[k];
      bodies[k]->collider = colliders_[k].get();
      bodies[k]->reach = colliders_[k]->bounding_radius;
      place(*bodies[k]);
    }
    pair.kept_gap = kGap;
    pair.size = 1.0;
  }

  static body::Shape sheet(core::Random& random, int n) {
    body::Shape shape;
    shape.kind = body::ShapeKind::shell;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        shape.surface.positions.push_back(
            Vec3(1.0 * i / n - 0.5, random.uniform(-0.2, 0.2) / n, 1.0 * j / n - 0.5));
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const int p = i * (n + 1) + j, q = p + n + 1;
        shape.surface.triangles.push_back({p, p + 1, q + 1});
        shape.surface.triangles.push_back({p, q + 1, q});
      }
    }
    return shape;
  }

  void search(double margin) {
    for (dynamics::WorkBody* w : {&a, &b}) place_in_boxes(*w);
    pair.search = search_paths(a, a.end, b, b.end, margin);
    pair.known = dynamics::PathMemory();
  }

  std::vector<dynamics::PathHit> follow(double& spare) {
    place_at(a, a.end, ends_a);
    place_at(b, b.end, ends_b);
    const double safe = dynamics::kSafe * pair.kept_gap;
    const double reach = motion_bound(a, a.end, b, b.end) + safe;
    const double strays = strays_from(*pair.search, a, a.end, b, b.end, 1e300);
    const double most = std::min(pair.search->margin - strays - safe, pair.kept_gap);
    REQUIRE(most > 0.0);
    return follow_features(a, b, {ends_a, ends_b, reach, most, most + safe + strays, 1e300}, pair, spare);
  }

  dynamics::WorkBody a, b;
  dynamics::WorkPair pair;
  std::vector<Vec3> ends_a, ends_b;

 private:
  body::Shape shapes_[2];
  std::shared_ptr<const collision::Collider> colliders_[2];
};

}  // namespace shatterbox::test
