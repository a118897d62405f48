#include "render/pass/frame_block.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace shatterbox::render::pass {
namespace {

// The floor begins to fade a little beyond the target, as a multiple of its distance, and is gone so many
// times as far.
constexpr float kFadeFrom = 1.1F, kFarthest = 100.0F;
// A sweep's light, as a share of the floor's: at its foot and at the picture's top.
constexpr float kSweepFoot = 0.75F, kSweepTop = 0.3F;

glm::vec3 unit_or(glm::vec3 v, glm::vec3 otherwise) {
  const float length = glm::length(v);
  return length > 0.0F && std::isfinite(length) ? v / length : otherwise;
}

// The rig of a product shot, turned with the sun: a large box high up on the sun's side, so that what lies on
// the floor mirrors it only where it is tilted, and a tall one on the other side.
void place_soft_boxes(glm::vec3 sun, FrameBlock& block) {
  const glm::vec3 flat = unit_or({sun.x, 0.0F, sun.z}, {1.0F, 0.0F, 0.0F});
  const glm::vec3 side = glm::cross(glm::vec3(0.0F, 1.0F, 0.0F), flat);
  const glm::vec3 axes[2] = {unit_or(0.45F * flat + 0.6F * side + glm::vec3(0.0F, 1.25F, 0.0F), sun),
                             unit_or(-0.9F * flat - 0.75F * side + glm::vec3(0.0F, 0.3F, 0.0F), sun)};
  const glm::vec2 halves[2] = {{0.34F, 0.40F}, {0.13F, 0.7F}};
  const float strengths[2] = {3.0F, 1.8F};
  for (int i = 0; i < 2; ++i) {
    const glm::vec3 right = unit_or(glm::cross(glm::vec3(0.0F, 1.0F, 0.0F), axes[i]), {1.0F, 0.0F, 0.0F});
    block.box_axis[i] = glm::vec4(axes[i], strengths[i]);
    block.box_right[i] = glm::vec4(right, halves[i].x);
    block.box_up[i] = glm::vec4(glm::cross(axes[i], right), halves[i].y);
  }
}

// What a plane that faces up sends back: light.glsl's ambient() of a normal straight up, and the sun.
void light_floor(FrameBlock& block) {
  const glm::vec3 colour(block.ground_colour);
  float boxes = 0.0F;
  for (int i = 0; i < 2; ++i) {
    boxes += (i == 0 ? 0.035F : 0.05F) * (0.5F * block.box_axis[i].y + 0.5F) * block.box_axis[i].w;
  }
  const glm::vec3 around = glm::vec3(block.sky_radiance) + block.sky_radiance.w * boxes;
  block.floor_sun = glm::vec4(colour * glm::vec3(block.sun_radiance) * std::max(block.sun.y, 0.0F), 0.0F);
  block.floor_sky = glm::vec4(colour * around, 0.0F);
}

// Where the floor fades, and what into. level_way: the way into the picture, of any length above 0.
void fade_floor(const Frame& frame, glm::vec2 level_way, FrameBlock& block) {
  const Ground& ground = *frame.ground;
  const glm::vec3 eye = frame.camera.position, target = frame.camera.target;
  const glm::vec2 way = glm::normalize(level_way);
  const bool is_chosen = ground.fade_to <= 0.0F;
  const float to_target = std::max(glm::dot(glm::vec2(target.x - eye.x, target.z - eye.z), way),
                                   0.3F * std::abs(eye.y - ground.height));
  const float from = std::max(is_chosen ? kFadeFrom * to_target : ground.fade_from, 1e-6F);
  const float to = is_chosen ? kFarthest * from : std::max(ground.fade_to, 1.001F * from);
  block.ground_place = glm::vec4(ground.height, from, to, 1.0F);
  block.ground_way = glm::vec4(way, 1.0F / from, 1.0F / (1.0F / from - 1.0F / to));
  const glm::vec3 lit(block.floor_sun + block.floor_sky);
  const float sweep = frame.backdrop.sweep;
  block.backdrop_bottom =
      glm::vec4(glm::mix(frame.backdrop.bottom, kSweepFoot * lit, sweep), block.backdrop_bottom.w);
  block.backdrop_top = glm::vec4(glm::mix(frame.backdrop.top, kSweepTop * lit, sweep), block.backdrop_top.w);
}

}  // namespace

FrameBlock make_frame_block(const Frame& frame, int width, int height) {
  FrameBlock block{};
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  const Camera& camera = frame.camera;
  const float distance = std::max(glm::distance(camera.position, camera.target), 1e-6F);
  const glm::vec3 forward = unit_or(camera.target - camera.position, {0.0F, 0.0F, -1.0F});
  glm::vec3 up = unit_or(camera.up, {0.0F, 1.0F, 0.0F});
  if (std::abs(glm::dot(up, forward)) > 0.999F) up = {0.0F, 0.0F, -1.0F};
  const float slope = camera.slope(w / h);

  const float near = 0.02F * distance;
  const float far = 20.0F * distance + 2.0F * (frame.ground ? frame.ground->fade_to : 0.0F);
  const glm::mat4 view_from_world = glm::lookAt(camera.position, camera.position + forward, up);
  block.clip_from_world = glm::perspective(2.0F * std::atan(slope), w / h, near, far) * view_from_world;

  const glm::vec3 sun = unit_or(frame.lights.sun_direction, {0.0F, 1.0F, 0.0F});
  block.eye_exposure = glm::vec4(camera.position, frame.exposure);
  block.target_distance = glm::vec4(camera.target, distance);
  block.sun = glm::vec4(sun, std::tan(0.5F * glm::radians(std::clamp(frame.lights.sun_size, 0.0F, 60.0F))));
  block.sun_radiance = glm::vec4(frame.lights.sun_colour * frame.lights.sun_strength, 0.0F);
  block.sky_radiance =
      glm::vec4(frame.lights.sky_colour * frame.lights.sky_strength, frame.lights.softbox_strength);
  // From below comes what the floor sends back, where there is one.
  const glm::vec3 below =
      frame.ground ? frame.ground->colour * (0.75F * std::max(sun.y, 0.0F) * glm::vec3(block.sun_radiance) +
                                             glm::vec3(block.sky_radiance))
                   : frame.lights.ground_colour * frame.lights.sky_strength;
  block.ground_radiance = glm::vec4(below, 1.0F);
  place_soft_boxes(sun, block);

  block.backdrop_top = glm::vec4(frame.backdrop.top, frame.backdrop.glow);
  block.backdrop_bottom = glm::vec4(frame.backdrop.bottom, frame.backdrop.vignette);
  if (frame.ground) {
    const bool is_plain = frame.ground->pattern == GroundPattern::plain;
    block.ground_colour = glm::vec4(frame.ground->colour, is_plain ? 0.0F : frame.ground->pattern_size);
    light_floor(block);
    // Forward, or up where the camera looks down, freed of what is not level.
    const glm::vec3 level =
        forward + glm::cross(glm::normalize(glm::cross(forward, up)), forward) * -forward.y;
    fade_floor(frame, {level.x, level.z}, block);
  }
  block.viewport = glm::vec4(w, h, 1.0F / w, 1.0F / h);
  block.glow_centre = glm::vec4(0.5F * w, 0.58F * h, 1.0F / (0.62F * h),
                                frame.ground ? static_cast<float>(frame.ground->pattern) : 0.0F);
  // A neighbourhood of about an eighth of what the camera sees at its target.
  const float reach = 0.25F * slope * distance;
  block.occlusion_scale = glm::vec4(near, far * near / (far - near), far / (far - near), reach);
  block.view_ray = glm::vec4(slope * w / h, slope, 0.0F, 0.0F);
  const glm::vec3 right = glm::normalize(glm::cross(forward, up));
  block.view_forward = glm::vec4(forward, 0.0F);
  block.view_right = glm::vec4(right * slope * w / h, 0.0F);
  block.view_up = glm::vec4(glm::cross(right, forward) * slope, 0.0F);
  const bool is_groups = frame.overlay.kind == OverlayKind::groups;  // their numbers are 0..1
  const float least = is_groups ? 0.0F : frame.overlay.least;
  const float range = is_groups ? 1.0F : frame.overlay.most - least;
  block.scalar_range = glm::vec4(least, range != 0.0F ? 1.0F / range : 0.0F, 0.0F, 0.0F);
  return block;
}

}  // namespace shatterbox::render::pass
