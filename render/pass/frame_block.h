// What every pass knows of the frame: shaders/common/frame.glsl's block, filled from the camera, lights and
// ground.
#pragma once
#include <glm/glm.hpp>

#include "render/frame/frame.h"

namespace shatterbox::render::pass {

// std140: only matrices and four-vectors. The meaning of each is in frame.glsl.
struct FrameBlock {
  glm::mat4 clip_from_world, shadow_from_world;
  glm::vec4 eye_exposure, target_distance;
  glm::vec4 sun, sun_radiance, sky_radiance, ground_radiance;
  glm::vec4 box_axis[2], box_right[2], box_up[2];
  glm::vec4 backdrop_top, backdrop_bottom;
  glm::vec4 floor_sun, floor_sky;
  glm::vec4 ground_colour, ground_place, ground_way;
  glm::vec4 viewport, glow_centre;
  glm::vec4 occlusion_scale, view_ray;
  glm::vec4 view_forward, view_right, view_up;
  glm::vec4 shadow_texel, shadow_on_floor;
  glm::vec4 scalar_range;
};

// All but the shadow's members, which ShadowPass fills.
FrameBlock make_frame_block(const Frame& frame, int width, int height);

}  // namespace shatterbox::render::pass
