// How thick the walls of a closed mesh are.
#pragma once

#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::sandbox::scene {

/// m: how far it is, on half of its area, from the surface of a closed mesh straight in to the surface
/// behind, by some hundred triangles; on the other half it is further. 0 of a mesh without triangles.
double wall_thickness(const geometry::TriangleMesh& mesh);

}  // namespace shatterbox::sandbox::scene
