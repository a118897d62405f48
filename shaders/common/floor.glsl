// What is behind the bodies: a matt floor that fades into the backdrop.
#include "common/frame.glsl"
#include "common/tone.glsl"

// Metres of view depth to the floor along a ray of one metre depth; huge where it is not hit.
float floor_depth(vec3 ray) {
  float drop = ground_place.x - eye_exposure.y;
  return ground_place.w * ray.y * drop > 0.0 ? drop / ray.y : 1e9;
}

// At a pixel where the floor, or nothing, is seen: the backdrop's part of the light, and the floor's share.
vec4 floor_parts(vec2 pixel, vec3 ray) {
  vec3 backdrop = backdrop_at(pixel);
  float z = floor_depth(ray);
  vec3 p = eye_exposure.xyz + ray * min(z, 1e6);
  float away = length(p.xz - target_distance.xz);
  float fade = ground_place.w > 0.0 && z < 1e8 ? smoothstep(ground_place.y, ground_place.z, away) : 1.0;
  float square = 1.0;
  if (ground_colour.w > 0.0) {
    vec2 q = p.xz / ground_colour.w;
    float width = z * view_ray.y * 2.0 * viewport.w / ground_colour.w * z * length(ray) / max(abs(eye_exposure.y - ground_place.x), 1e-6);
    vec2 s = (abs(fract(q * 0.5) - 0.5) - 0.25) * 2.0;
    vec2 side = clamp(s / max(width, 1e-5) + 0.5, 0.0, 1.0) * 2.0 - 1.0;
    square = 0.86 + 0.14 * side.x * side.y * clamp(1.5 - width, 0.0, 1.0);
  }
  return vec4(backdrop * fade, square * (1.0 - fade));
}
