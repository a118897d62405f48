// A body's shape as triangles, for those who see no other difference between kinds.
#pragma once

#include "engine/body/shape.h"

namespace shatterbox::body {

/// Body space, wound outwards: a box, a capsule (a polyhedron of 32 sides), the surface of a shell or solid.
/// Nothing of planes, which have no end, and of spheres, which all meet by their radius.
geometry::TriangleMesh find_polyhedron(const Shape& shape);

}  // namespace shatterbox::body
