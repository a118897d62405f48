// One OBJ file a frame: every body of the world as a group, in world space, so that others can check or
// render a run.
#pragma once

#include <span>
#include <string>

#include "engine/body/body.h"
#include "engine/geometry/triangle_mesh.h"

namespace shatterbox::sandbox::report {

/// The text of one frame, of `bodies` at `time` (s): an `o` group a body (its name and number), 17
/// significant digits, metres; of what can move a comment with mass, centre and velocities. Planes have no
/// end and are left out.
std::string make_obj(std::span<const body::Body> bodies, double time);

/// Writes frame `number` as DIR/frame_000000.obj. A sentence if that fails, else empty.
std::string write_obj_frame(const std::string& folder, int number, std::span<const body::Body> bodies,
                            double time);

}  // namespace shatterbox::sandbox::report
