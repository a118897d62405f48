// The names that scenes use for looks, grounds, lights and backdrops, in render's terms.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/core/vec.h"
#include "render/frame/frame.h"

namespace shatterbox::sandbox::view {

/// Linear light of an sRGB colour, 0..1 each.
glm::vec3 linear_colour(const Vec3& srgb);

/// The looks of a body by geometry::Part (body, neck, cap, loop). `name` is one of scene::kLookNames;
/// `colour` (sRGB) replaces the name's own. `size` (m, from the middle to the surface) and `centre` (m, in
/// pattern space) place paint; wood has its fibres along `axis` (0, 1, 2).
std::vector<render::Look> make_looks(const std::string& name, const std::optional<Vec3>& colour, double size,
                                     const Vec3& centre, int axis);

/// Of what is clear, for a body with two faces where a sheet has one: `colour` is what is seen through a
/// wall, so each face takes its root.
void share_tint_of_two_faces(std::vector<render::Look>& looks);

/// The look that a material has of itself: of its preset, or plain.
std::string usual_look(const std::string& preset);

/// Ground by a name of scene::kGroundNames at a height (m); nothing for "none".
std::optional<render::Ground> make_ground(const std::string& name, double height);

/// Sun, sky and soft boxes by a name of scene::kLightNames; empty is the studio's.
render::Lights make_light(const std::string& name);

/// The backdrop that goes with a light.
std::string usual_backdrop(const std::string& light);

/// Backdrop by a name of scene::kBackdropNames.
render::Backdrop make_backdrop(const std::string& name);

}  // namespace shatterbox::sandbox::view
