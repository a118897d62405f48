// One OBJ file a frame: every body of the world as a group, in world space, so that others can check or
// render a run.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/triangle_mesh.h"
#include "engine/world/world.h"

namespace shatterbox::sandbox::report {

/// The text of one frame: an `o` group a body (its name and number), 17 significant digits, metres. Planes
/// have no end and are left out.
std::string make_obj(const world::World& world);

/// Writes frame `number` as DIR/frame_000000.obj. A sentence if that fails, else empty.
std::string write_obj_frame(const std::string& folder, int number, const world::World& world);

/// The surface of a box or a sphere (latitudes and longitudes), for export.
geometry::TriangleMesh sphere_surface(double radius);

}  // namespace shatterbox::sandbox::report
