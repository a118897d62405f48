// Vertices of a piece's surface that cannot stand back from all crack faces about them become several.
#pragma once

#include "engine/geometry/solid_surface.h"

namespace shatterbox::geometry {

/// A vertex at which faces look against each other, as where the material goes on from one side of a crack to
/// the other, cannot stand back from all of them: it becomes two or three,
/// with triangles without area between them until they stand back (by about `kerf` m).
void part_vertices(SolidSurface& surface, double kerf);

}  // namespace shatterbox::geometry
