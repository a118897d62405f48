// Moving vertices of a lattice onto a surface. For tetrahedralise.cpp.
#pragma once

#include <optional>
#include <string>

#include "engine/geometry/solid_mesh.h"
#include "engine/geometry/surface_crossings.h"

namespace shatterbox::geometry {

/// Moves vertices of `elements` that lie near the surface to just outside of it (`crossings` as they are
/// before), where that keeps the tetrahedra well-shaped, so that fewer of them hold slivers of material. The
/// crossings are brought up to date. An error sentence if the surface turns out to cross itself.
std::optional<std::string> warp_lattice(SolidElements& elements, SurfaceCrossings& crossings,
                                        const TriangleMesh& surface, const EdgeTopology& surface_edges,
                                        double cell_size);

}  // namespace shatterbox::geometry
