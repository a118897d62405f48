// A shell with fewer triangles that looks the same from where it is seen: edges are collapsed while the
// surface stays within a tolerance (Garland, Heckbert 1997).
#pragma once
#include "render/frame/mesh.h"

namespace shatterbox::render {

// The same positions (so that scalars still fit), fewer triangles; normals (3|T|) are those of the mesh
// given, computed there if it has none. Outline, creases, borders between parts and of cracks stay where they
// are within `tolerance` (m). The same mesh gives the same triangles. A mesh with edges of more than two
// triangles keeps what lies about them.
Mesh simplify(const Mesh& mesh, float tolerance);

}  // namespace shatterbox::render
