// What is behind the bodies: a matt floor that fades into the backdrop, level and evenly over the picture's height: along
// one over the distance.
#include "common/frame.glsl"
#include "common/tone.glsl"

// Metres of view depth to the floor along a ray of one metre depth; huge where it is not hit.
float floor_depth(vec3 ray) {
  float drop = ground_place.x - eye_exposure.y;
  return ground_place.w * ray.y * drop > 0.0 ? drop / ray.y : 1e9;
}

// At a pixel where the floor, or nothing, is seen: the backdrop's part of the light (rgb), and the floor's share (a).
// FLOOR: how much of it a rectangle's corners tell (floor_corner) and how much each pixel works out (floor_at).
#define SMOOTH 1    // all: the whole floor, or none of it
#define FADING 2    // the backdrop
#define PATTERNED 3 // the backdrop; the share of its colour is a picture

#if FLOOR == PATTERNED
layout(binding = 13) uniform sampler2D floor_shares;  // half of them
#endif

float floor_faded(vec3 ray) {
  float drop = ground_place.x - eye_exposure.y;
  float into = dot(ray.xz, ground_way.xy);
  bool is_hit = ground_place.w * ray.y * drop > 0.0;
  float nearness = into > 0.0 ? ray.y / (drop * into) : ground_way.z;  // one over the metres from the eye
  float t = is_hit ? clamp((ground_way.z - nearness) * ground_way.w, 0.0, 1.0) : 1.0;
  return t * t * (3.0 - 2.0 * t);
}

vec4 floor_corner(vec2 pixel, vec3 ray) {
  vec3 backdrop = backdrop_at(pixel);
#if FLOOR == SMOOTH
  float fade = floor_faded(ray);
  return vec4(backdrop * fade, 1.0 - fade);
#else
  return vec4(backdrop, 1.0);
#endif
}

vec4 floor_at(vec4 corner, vec3 ray, vec2 pixel) {
#if FLOOR == SMOOTH
  return corner;
#else
  float fade = floor_faded(ray);
  float share = 1.0;
#if FLOOR == PATTERNED
  share = 2.0 * texelFetch(floor_shares, ivec2(pixel), 0).r;
#endif
  return vec4(corner.rgb * fade, share * (1.0 - fade));
#endif
}
