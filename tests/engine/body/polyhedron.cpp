// A shape as triangles: closed, wound outwards, and as large as the shape.
#include "engine/body/polyhedron.h"

#include <catch2/catch.hpp>

#include "engine/core/elementary.h"
#include "engine/geometry/generators.h"
#include "engine/geometry/mass_properties.h"

using namespace shatterbox;

TEST_CASE("a shape as triangles has the volume of the shape") {
  body::Shape shape;
  shape.kind = body::ShapeKind::box;
  shape.half_extent = Vec3(0.5, 1.0, 1.5);
  CHECK(geometry::enclosed_volume(body::find_polyhedron(shape)) == Approx(6.0));
  shape.kind = body::ShapeKind::capsule;
  shape.radius = 0.1;
  shape.half_length = 0.3;
  const double round = core::kPi * 0.01 * (0.6 + 4.0 / 3.0 * 0.1);
  const double inside = geometry::enclosed_volume(body::find_polyhedron(shape));
  CHECK(inside < round);
  CHECK(inside > 0.97 * round);
  shape.kind = body::ShapeKind::solid;
  shape.surface = geometry::make_box_surface(Vec3(1.0, 1.0, 1.0));
  CHECK(body::find_polyhedron(shape).triangles == shape.surface.triangles);
  for (const body::ShapeKind round_or_endless : {body::ShapeKind::sphere, body::ShapeKind::plane}) {
    shape.kind = round_or_endless;
    CHECK(body::find_polyhedron(shape).triangles.empty());
  }
}
