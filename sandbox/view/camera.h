// Where the camera is at a time: fixed, on a smooth path through keyframes, or chosen so that all is seen.
#pragma once

#include "sandbox/scene/scene_description.h"
#include "sandbox/view/framing.h"
#include "sandbox/view/subject.h"

namespace shatterbox::sandbox::view {

/// The scene's own camera at `time` (s of the world), without what it follows. Keyframes are passed with
/// continuous velocity (cubic Hermite, tangents from neighbours).
Viewpoint viewpoint_at(const scene::CameraEntry& camera, const Subject& subject, double time);

}  // namespace shatterbox::sandbox::view
