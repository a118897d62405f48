// How much of the sky each half-size pixel sees: samples on a spiral, each hiding what lies above the surface's
// plane and near [McG12]. View space, m. Turned by a 4 x 4 pattern of angles that the blur takes out again.
#include "common/frame.glsl"
layout(binding = 0) uniform sampler2D depth_map;  // 0..1
layout(location = 0) out vec2 seen_depth;         // share seen, view depth

float view_depth(float depth) { return occlusion_scale.y / (occlusion_scale.z - depth); }

vec3 place(ivec2 pixel, float z) {
  vec2 s = (vec2(pixel) + 0.5) / vec2(textureSize(depth_map, 0)) * 2.0 - 1.0;
  return vec3(s * view_ray.xy * z, z);
}

vec3 place_at(ivec2 pixel) {
  return place(pixel, view_depth(texelFetch(depth_map, pixel, 0).x));
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 size = textureSize(depth_map, 0);
  float depth = texelFetch(depth_map, here, 0).x;
  float z = view_depth(depth);
  vec3 p = place(here, z);
  vec3 right = place_at(min(here + ivec2(1, 0), size - 1)) - p;
  vec3 left = p - place_at(max(here - ivec2(1, 0), ivec2(0)));
  vec3 above = place_at(min(here + ivec2(0, 1), size - 1)) - p;
  vec3 below = p - place_at(max(here - ivec2(0, 1), ivec2(0)));
  vec3 dx = here.x == 0 || (here.x < size.x - 1 && abs(right.z) < abs(left.z)) ? right : left;
  vec3 dy = here.y == 0 || (here.y < size.y - 1 && abs(above.z) < abs(below.z)) ? above : below;
  vec3 n = normalize(cross(dy, dx));
  n = dot(n, p) > 0.0 ? -n : n;

  float reach = occlusion_scale.w;                              // m
  float reach_pixels = min(reach / (z * view_ray.y) * 0.5 * float(size.y), 0.25 * float(size.y));
  int turn = (here.x & 3) + 4 * (here.y & 3);
  float angle = float((turn * 7) & 15) * (2.0 * kPi / 16.0);
  float sum = 0.0;
  int taps = depth < 1.0 ? OCCLUSION_TAPS : 0;
  for (int i = 0; i < taps; ++i) {
    float r = (float(i) + 0.5) / float(OCCLUSION_TAPS);
    float a = angle + float(i) * 2.39996323;
    ivec2 at = here + ivec2(round(vec2(cos(a), sin(a)) * max(r * r * reach_pixels, 1.0 + float(i) * 0.5)));
    at = clamp(at, ivec2(0), size - 1);
    vec3 to = place_at(at) - p;
    float d2 = dot(to, to);
    float near_by = max(1.0 - d2 / (reach * reach), 0.0);
    sum += near_by * near_by * max(dot(to, n) - 0.004 * z, 0.0) * inversesqrt(d2 + 1e-12);
  }
  float hidden = sum / float(OCCLUSION_TAPS);
  seen_depth = vec2(clamp(1.0 - 2.1 * hidden, 0.0, 1.0), z);
}
