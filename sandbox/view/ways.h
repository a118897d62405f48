// Where bodies get on ways that a scene tells before it is run: paths, turns about axles, throws.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/bvh.h"
#include "sandbox/scene/build_world.h"
#include "sandbox/scene/scene_description.h"

namespace shatterbox::sandbox::view {

using Corners = std::array<Vec3, 8>;  // m, of a box

void append(std::span<const Vec3> corners, std::vector<Vec3>& all);

Corners corners_of(const geometry::Box& box, const Pose& pose);

geometry::Box box_about(std::span<const Vec3> points);

/// The same, wider on each side by a share of its longest one.
geometry::Box room_about(const geometry::Box& box, double share);

/// Corners of the body in all the attitudes and places of its path, of the copy that stands at `pose`, up to
/// the end of the scene (s).
std::vector<Vec3> corners_on_path(const scene::BodyEntry& body, const scene::BodyPlan& plan, const Pose& pose,
                                  double seconds);

/// The same of one that only turns, about locked axes of its centre of mass: in all its attitudes.
std::vector<Vec3> corners_on_axle(const scene::BodyEntry& body, const scene::BodyPlan& plan,
                                  const Pose& pose);
bool is_on_axle(const scene::BodyEntry& body);

/// Where something that flies like that comes upon one of `others`, which stay where they are and which it
/// does not reach into at the start: by how far it has gone then, m. Nothing if it meets none within
/// `seconds`.
std::optional<Vec3> find_meeting(const geometry::Box& flying, const Vec3& velocity, const Vec3& gravity,
                                 const std::vector<geometry::Box>& others, double seconds);

}  // namespace shatterbox::sandbox::view
