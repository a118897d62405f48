// How much of the sky each pixel of the smaller picture sees: samples on a spiral, each hiding what lies above the surface's
// plane and near [McG12]. View space, m. Turned by a 4 x 4 pattern of angles that the blur takes out again.
#include "common/frame.glsl"
layout(binding = 0) uniform sampler2D depth_map;  // view depth, m
layout(location = 0) out uint seen_depth;         // half floats: share seen; 1 / view depth times the target's

vec3 place_at(ivec2 pixel, float z) {
  vec2 s = (vec2(pixel) + 0.5) * (2.0 * float(OCCLUSION_SCALE) * viewport.zw) - 1.0;
  return vec3(s * view_ray.xy * z, z);
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(depth_map, 0) - 1;
  vec2 size = vec2(last + 1);
  vec4 from = textureGather(depth_map, vec2(here) / size), to = textureGather(depth_map, vec2(here + 1) / size);
  vec3 p = place_at(here, to.w);
  float z = p.z;
  vec3 right = place_at(here + ivec2(1, 0), to.z) - p;
  vec3 left = p - place_at(here - ivec2(1, 0), from.x);
  vec3 above = place_at(here + ivec2(0, 1), to.x) - p;
  vec3 below = p - place_at(here - ivec2(0, 1), from.z);
  vec3 dx = here.x == 0 || (here.x < last.x && abs(right.z) < abs(left.z)) ? right : left;
  vec3 dy = here.y == 0 || (here.y < last.y && abs(above.z) < abs(below.z)) ? above : below;
  vec3 n = normalize(cross(dy, dx));
  n = dot(n, p) > 0.0 ? -n : n;

  float reach = occlusion_scale.w;                                               // m
  float height = float(last.y + 1);
  float reach_pixels = min(reach / (z * view_ray.y) * 0.5, 0.25) * height;
  int turn = (here.x & 3) + 4 * (here.y & 3);
  float angle = float((turn * 7) & 15) * (2.0 * kPi / 16.0);
  vec2 way = vec2(cos(angle), sin(angle));
  const mat2 kGolden = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
  float sum = 0.0;
  float fall = 1.0 / (reach * reach);
  for (int i = 0; i < OCCLUSION_TAPS; ++i) {
    float r = (float(i) + 0.5) / float(OCCLUSION_TAPS);
    ivec2 at = here + ivec2(round(way * max(r * r * reach_pixels, 1.0 + float(i) * 0.5)));
    way = kGolden * way;
    at = clamp(at, ivec2(0), last);
    vec3 way_there = place_at(at, texelFetch(depth_map, at, 0).x) - p;
    float d2 = dot(way_there, way_there);
    float near_by = max(1.0 - d2 * fall, 0.0);
    sum += near_by * max(dot(way_there, n) - 0.004 * z, 0.0) * inversesqrt(d2 + 1e-12);
  }
  seen_depth = packHalf2x16(vec2(clamp(1.0 - 2.8 / float(OCCLUSION_TAPS) * sum, 0.0, 1.0), target_distance.w / z));
}
