#include "engine/body/polyhedron.h"

#include "engine/geometry/generators.h"

namespace shatterbox::body {

geometry::TriangleMesh find_polyhedron(const Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::box:
      return geometry::make_box_surface(shape.half_extent);
    case ShapeKind::capsule:
      return geometry::make_capsule_surface(shape.radius, shape.half_length);
    case ShapeKind::shell:
    case ShapeKind::solid:
      return shape.surface;
    case ShapeKind::plane:
    case ShapeKind::sphere:
      break;
  }
  return {};
}

}  // namespace shatterbox::body
