// Ambient occlusion at a full-size pixel from the smaller one: the four nearest, less where the depth differs.
#include "common/frame.glsl"
layout(binding = 3) uniform sampler2D occlusion_map;  // x: share of sky seen, y: view depth, m

float sky_seen(vec2 pixel, float view_depth) {
  if (ground_radiance.w == 0.0) return 1.0;
  ivec2 last = textureSize(occlusion_map, 0) - 1;
  vec2 h = pixel * (1.0 / float(OCCLUSION_SCALE)) - 0.5;
  ivec2 base = ivec2(floor(h));
  vec2 f = h - vec2(base);
  vec2 sum = vec2(1e-4, 1e-4);
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    vec2 near_by = texelFetch(occlusion_map, clamp(base + corner, ivec2(0), last), 0).xy;
    vec2 w = mix(1.0 - f, f, vec2(corner));
    float weight = w.x * w.y / (0.02 + abs(near_by.y - view_depth) / view_depth * 20.0);
    sum += weight * vec2(near_by.x, 1.0);
  }
  return sum.x / sum.y;
}
