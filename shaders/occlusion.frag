// How much of the sky each pixel of a smaller picture sees: samples on a spiral, each hiding what lies above the surface's plane and near
// [McG12]. The floor's plane is known exactly, so even what rises a millimetre from it darkens its foot; bodies have their
// own normals. World axes, m from the eye. Turned by a 4 x 4 pattern of angles that the blur takes out again.
#include "common/paint.glsl"
layout(location = 0) out uint seen_share;  // half floats: share seen; 1 / view depth times the target's

// What is seen at a pixel, from the eye: bodies or floor. x: one over the body's view depth, y: the floor's.
vec3 place_at(ivec2 pixel, out vec2 nearness) {
  vec3 ray = ray_at(vec2(pixel) + 0.5);
  float depth = texelFetch(seen_depth, pixel * SIDE, 0).x;
  float drop = ground_place.x - eye_exposure.y;
  nearness = vec2((occlusion_scale.z - depth) / occlusion_scale.y, ray.y * (drop == 0.0 ? 0.0 : ground_place.w / drop));
  return ray / max(max(nearness.x, nearness.y), 1e-6);
}

void main() {
  ivec2 last = ivec2(viewport.xy) - 1;
  ivec2 here = min(ivec2(gl_FragCoord.xy) * OCCLUSION_SCALE, last);
  vec2 nearness, ignored;
  vec3 p = place_at(here, nearness);
  bool is_body = nearness.x > nearness.y;
  float z = dot(p, view_forward.xyz);
  vec3 n = is_body ? unpack_normal(texelFetch(seen_map, here * SIDE, 0).x) : vec3(0.0, 1.0, 0.0);
  n = dot(n, p) > 0.0 ? -n : n;
  float margin = is_body ? 0.003 * z : 2e-5 * z;  // bodies are flat triangles under smooth normals

  float reach = occlusion_scale.w;  // m
  float reach_pixels = min(reach / (z * view_ray.y) * 0.5, 0.25) * viewport.y;
  ivec2 turns = ivec2(gl_FragCoord.xy) & 3;
  float angle = float(((turns.x + 4 * turns.y) * 7) & 15) * (2.0 * kPi / 16.0);
  vec2 way = vec2(cos(angle), sin(angle));
  const mat2 kGolden = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888);
  float sum = 0.0;
  float fall = 1.0 / (reach * reach);
  for (int i = 0; i < OCCLUSION_TAPS; ++i) {
    float r = (float(i) + 0.5) / float(OCCLUSION_TAPS);
    ivec2 at = here + ivec2(round(way * max(r * r * reach_pixels, 1.5 + 1.2 * float(i))));
    way = kGolden * way;
    vec3 way_there = place_at(clamp(at, ivec2(0), last), ignored) - p;
    float d2 = dot(way_there, way_there);
    float near_by = max(1.0 - d2 * fall, 0.0);
    sum += near_by * max(dot(way_there, n) - margin, 0.0) * inversesqrt(d2 + 1e-12);
  }
  seen_share = packHalf2x16(vec2(clamp(1.0 - 3.8 / float(OCCLUSION_TAPS) * sum, 0.0, 1.0), target_distance.w / z));
}
